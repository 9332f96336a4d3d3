#include "api/block_cutter.h"

#include <algorithm>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include "api/vertex_ranks.h"
#include "chartify/block.h"
#include "chartify/parallel.h"

namespace ramcdb::detail {
namespace {

constexpr const char* kStage = "chartify";
constexpr std::uint32_t kNone = chartify::kNone;

/// A block with what waited for it.
struct LoadedBlock {
  std::vector<SortedFace> faces;           ///< vertices without a face among them
  std::vector<std::uint32_t> of_mesh;      ///< per face of `mesh` its place in `faces`
  std::vector<std::uint32_t> of_isolated;  ///< per isolated vertex of `mesh`, likewise
  std::vector<std::uint32_t> vertices;     ///< in the whole mesh, ascending
  chartify::CanonicalMesh mesh;            ///< whose sources are `of_mesh` and `vertices`
};

/// A block and how it was cut.
struct CutBlock {
  LoadedBlock block;
  chartify::BlockCharts charts;
};

class Cutter {
 public:
  Cutter(const FaceBlocks& blocks, const MeshSpool& mesh, const Lattice& lattice, PartSizes sizes,
         const chartify::Options& options, const LargeWork& work)
      : blocks_(blocks),
        mesh_(mesh),
        lattice_(lattice),
        sizes_(sizes),
        options_(options),
        work_(work),
        waiting_(work.folder),
        spool_(work.folder),
        is_open_(blocks.count(), true),
        adjacent_(blocks.count()) {
    for (std::size_t b = 0; b < blocks.count(); ++b) load_.push_back(blocks.size(b));
    for (std::size_t shared = 0; shared < blocks.shared.vertices.size(); ++shared)
      for (const std::uint32_t a : blocks.shared.groups_of(shared))
        for (const std::uint32_t b : blocks.shared.groups_of(shared)) connect(a, b);
  }

  ChartSpool run() {
    for (std::vector<std::uint32_t> wave = next_wave(); !wave.empty(); wave = next_wave()) cut(wave);
    spool_.finish();
    return std::move(spool_);
  }

 private:
  void connect(std::uint32_t a, std::uint32_t b) {
    if (a == b) return;
    adjacent_[a].insert(b);
    adjacent_[b].insert(a);
  }

  /// The first open blocks that have no vertex in common.
  [[nodiscard]] std::vector<std::uint32_t> next_wave() {
    std::vector<std::uint32_t> wave;
    for (std::uint32_t b = 0; b < is_open_.size() && wave.size() < sizes_.at_a_time; ++b)
      if (is_open_[b] && std::ranges::none_of(wave, [&](std::uint32_t w) { return adjacent_[b].contains(w); }))
        wave.push_back(b);
    for (const std::uint32_t b : wave) is_open_[b] = false;
    return wave;
  }

  void cut(const std::vector<std::uint32_t>& wave) {
    const auto calling = std::this_thread::get_id();
    const auto report = [&](double done) {
      if (std::this_thread::get_id() == calling)
        work_.report(kStage, (cut_ + done) / static_cast<double>(load_.size()));
    };
    report(0);
    chartify::Options options = options_;
    options.threads = std::max(1U, work_.threads / static_cast<unsigned>(wave.size()));
    options.progress = report;
    waiting_.flush();
    std::vector<CutBlock> cuts(wave.size());
    parallel_for(wave.size(), work_.threads, [&](std::size_t i) {
      cuts[i].block = load(wave[i]);
      cuts[i].charts = cut_block(cuts[i].block.mesh.mesh, open_blocks(cuts[i].block), options);
    });
    for (std::size_t i = 0; i < wave.size(); ++i) {
      distribute(cuts[i]);
      segments_.erase(wave[i]);
      cuts[i] = {};
    }
    cut_ += static_cast<double>(wave.size());
  }

  [[nodiscard]] LoadedBlock load(std::uint32_t b) const {
    LoadedBlock block;
    block.faces = blocks_.faces.read(blocks_.begin(b), static_cast<std::size_t>(blocks_.size(b)));
    if (const auto waiting = segments_.find(b); waiting != segments_.end())
      for (const Segment& segment : waiting->second) {
        const auto more = waiting_.read(segment.begin, segment.size);
        block.faces.insert(block.faces.end(), more.begin(), more.end());
      }
    make_mesh(block);
    return block;
  }

  void make_mesh(LoadedBlock& block) const {
    std::vector<std::uint32_t> corners;
    for (const SortedFace& face : block.faces)
      for (const std::uint32_t v : face.corners)
        if (v != SortedFace::kNoVertex) corners.push_back(v);
    VertexRanks ranks(corners);
    block.vertices = std::move(ranks.vertices);
    chartify::IndexedMesh mesh;
    for (const std::uint32_t v : block.vertices) mesh.positions.push_back(lattice_.snap(mesh_.points.at(v)));
    std::vector<std::uint32_t> place_of_vertex;
    auto rank = ranks.rank.begin();
    for (std::uint32_t f = 0; f < block.faces.size(); ++f) {
      const SortedFace& face = block.faces[f];
      if (face.is_isolated_vertex()) {
        place_of_vertex.resize(block.vertices.size(), kNone);
        place_of_vertex[*rank++] = f;
      } else {
        mesh.faces.push_back({rank[0], rank[1], rank[2]});
        rank += 3;
        block.of_mesh.push_back(f);
      }
    }
    block.mesh = chartify::canonical_order(mesh);
    std::vector<std::uint32_t> triangles;
    for (const std::uint32_t f : block.mesh.source_face) triangles.push_back(block.faces[block.of_mesh[f]].face);
    block.mesh.mesh.polygon_of_face = mesh_.polygons_of(triangles);
    if (place_of_vertex.empty()) return;
    for (const std::uint32_t v : block.mesh.source_vertex)  // isolated ones come last, in their order
      if (place_of_vertex[v] != kNone) block.of_isolated.push_back(place_of_vertex[v]);
  }

  /// Calls take(block) for the open blocks that have faces at a shared vertex, there from the start or waiting.
  template <class Take>
  void for_each_open(std::size_t shared, Take&& take) const {
    for (const std::uint32_t b : blocks_.shared.groups_of(shared))
      if (is_open_[b]) take(b);
    for (auto at = moved_.lower_bound({shared, 0}); at != moved_.end() && at->first == shared; ++at)
      if (is_open_[at->second]) take(at->second);
  }

  /// Per vertex of the mesh the first open block that has faces at it.
  [[nodiscard]] std::vector<std::uint32_t> open_blocks(const LoadedBlock& block) const {
    std::vector<std::uint32_t> of_source(block.vertices.size(), kNone);
    for_each_shared(block.vertices, blocks_.shared, [&](std::size_t v, std::size_t shared) {
      for_each_open(shared, [&](std::uint32_t b) { of_source[v] = std::min(of_source[v], b); });
    });
    std::vector<std::uint32_t> open;
    for (const std::uint32_t v : block.mesh.source_vertex) open.push_back(of_source[v]);
    return open;
  }

  void distribute(const CutBlock& cut) {
    const chartify::Charts& charts = cut.charts.charts;
    std::vector<std::vector<std::uint32_t>> faces(charts.chart_count), isolated(charts.chart_count);
    for (std::uint32_t f = 0; f < charts.chart_of_face.size(); ++f) faces[charts.chart_of_face[f]].push_back(f);
    for (std::size_t v = 0; v < cut.block.of_isolated.size(); ++v)
      isolated[charts.chart_of_isolated_vertex[v]].push_back(cut.block.of_isolated[v]);
    std::vector<std::uint32_t> number(cut.block.vertices.size(), kNone);
    for (std::uint32_t c = 0; c < charts.chart_count; ++c) {
      const std::uint32_t waits_for = cut.charts.waits_for[c];
      const std::uint64_t size = faces[c].size() + isolated[c].size();
      if (waits_for != kNone && load_[waits_for] + size <= sizes_.most_faces)
        pass_on(cut.block, faces[c], isolated[c], waits_for);
      else
        finish(cut.block, faces[c], isolated[c], number);
    }
  }

  void pass_on(const LoadedBlock& block, const std::vector<std::uint32_t>& faces,
               const std::vector<std::uint32_t>& isolated, std::uint32_t to) {
    const std::uint64_t begin = waiting_.size();
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t f : faces) {
      const SortedFace& face = block.faces[block.of_mesh[block.mesh.source_face[f]]];
      waiting_.add(face);
      vertices.insert(vertices.end(), face.corners.begin(), face.corners.end());
    }
    for (const std::uint32_t place : isolated) waiting_.add(block.faces[place]);
    const auto size = static_cast<std::size_t>(waiting_.size() - begin);
    segments_[to].push_back({begin, size});
    load_[to] += size;
    sort_vertices(vertices);
    for_each_shared(vertices, blocks_.shared, [&](std::size_t, std::size_t shared) {
      for_each_open(shared, [&](std::uint32_t b) { connect(to, b); });
      moved_.insert({shared, to});
    });
  }

  /// \param number per vertex of the block kNone, before and after
  void finish(const LoadedBlock& block, const std::vector<std::uint32_t>& faces,
              const std::vector<std::uint32_t>& isolated, std::vector<std::uint32_t>& number) {
    SpooledChart chart;
    std::uint64_t key = ~std::uint64_t{0};
    const auto number_in_chart = [&](std::uint32_t v) {
      if (number[v] == kNone) {
        number[v] = static_cast<std::uint32_t>(chart.vertices.size());
        chart.vertices.push_back(block.vertices[block.mesh.source_vertex[v]]);
      }
      return number[v];
    };
    for (const std::uint32_t f : faces) {
      const SortedFace& face = block.faces[block.of_mesh[block.mesh.source_face[f]]];
      key = std::min(key, face.key);
      const Triangle& t = block.mesh.mesh.faces[f];
      const std::uint32_t a = number_in_chart(t[0]), b = number_in_chart(t[1]), c = number_in_chart(t[2]);
      chart.faces.push_back({{a, b, c}, face.face});
    }
    for (const std::uint32_t f : faces)
      for (const std::uint32_t v : block.mesh.mesh.faces[f]) number[v] = kNone;
    for (const std::uint32_t place : isolated) {
      key = std::min(key, block.faces[place].key);
      chart.vertices.push_back(block.faces[place].corners[0]);
    }
    chart.isolated = static_cast<std::uint32_t>(isolated.size());
    spool_.add(key, chart);
  }

  struct Segment {
    std::uint64_t begin;
    std::size_t size;
  };

  const FaceBlocks& blocks_;
  const MeshSpool& mesh_;
  const Lattice& lattice_;
  PartSizes sizes_;
  chartify::Options options_;
  const LargeWork& work_;
  ScratchRecords<SortedFace> waiting_;
  std::map<std::uint32_t, std::vector<Segment>> segments_;  ///< of `waiting_`, by the block that they wait for
  ChartSpool spool_;
  std::vector<std::uint64_t> load_;                        ///< per block its faces, and those that wait for it
  std::vector<bool> is_open_;                              ///< per block whether it is still to be cut
  std::vector<std::set<std::uint32_t>> adjacent_;          ///< per block those with a vertex in common
  std::set<std::pair<std::size_t, std::uint32_t>> moved_;  ///< shared vertices, and blocks that faces there wait for
  double cut_ = 0;                                         ///< blocks
};

}  // namespace

ChartSpool cut_blocks(const FaceBlocks& blocks, const MeshSpool& mesh, const Lattice& lattice, PartSizes sizes,
                      const chartify::Options& options, const LargeWork& work) {
  return Cutter(blocks, mesh, lattice, sizes, options, work).run();
}

}  // namespace ramcdb::detail
