#include "api/block_cutter.h"

#include <algorithm>
#include <map>

#include "chartify/block.h"

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

class Cutter {
 public:
  Cutter(const FaceBlocks& blocks, const PointFile& points, const Lattice& lattice, std::uint64_t most_faces,
         const chartify::Options& options, const LargeWork& work)
      : blocks_(blocks),
        points_(points),
        lattice_(lattice),
        most_faces_(most_faces),
        options_(options),
        work_(work),
        waiting_(work.folder),
        spool_(work.folder),
        moved_to_(blocks.shared.vertices.size(), 0) {
    for (std::size_t b = 0; b < blocks.count(); ++b) load_.push_back(blocks.size(b));
  }

  ChartSpool run() {
    for (std::uint32_t b = 0; b < blocks_.count(); ++b) {
      options_.progress = [&](double done) { work_.report(kStage, (b + done) / static_cast<double>(blocks_.count())); };
      options_.progress(0);
      cut(b, load(b));
    }
    spool_.finish();
    return std::move(spool_);
  }

 private:
  [[nodiscard]] LoadedBlock load(std::uint32_t b) {
    LoadedBlock block;
    block.faces = blocks_.faces.read(blocks_.begin(b), static_cast<std::size_t>(blocks_.size(b)));
    waiting_.flush();
    for (const Segment& segment : segments_[b]) {
      const auto more = waiting_.read(segment.begin, segment.size);
      block.faces.insert(block.faces.end(), more.begin(), more.end());
    }
    segments_.erase(b);
    for (const SortedFace& face : block.faces)
      for (const std::uint32_t v : face.corners)
        if (v != SortedFace::kNoVertex) block.vertices.push_back(v);
    sort_vertices(block.vertices);
    make_mesh(block);
    return block;
  }

  void make_mesh(LoadedBlock& block) const {
    chartify::IndexedMesh mesh;
    for (const std::uint32_t v : block.vertices) mesh.positions.push_back(lattice_.snap(points_.at(v)));
    const auto local = [&](std::uint32_t v) {
      return static_cast<std::uint32_t>(std::lower_bound(block.vertices.begin(), block.vertices.end(), v) -
                                        block.vertices.begin());
    };
    std::vector<std::uint32_t> place_of_vertex;
    for (std::uint32_t f = 0; f < block.faces.size(); ++f) {
      const SortedFace& face = block.faces[f];
      if (face.is_isolated_vertex()) {
        place_of_vertex.resize(block.vertices.size(), kNone);
        place_of_vertex[local(face.corners[0])] = f;
      } else {
        mesh.faces.push_back({local(face.corners[0]), local(face.corners[1]), local(face.corners[2])});
        block.of_mesh.push_back(f);
      }
    }
    block.mesh = chartify::canonical_order(mesh);
    if (place_of_vertex.empty()) return;
    for (const std::uint32_t v : block.mesh.source_vertex)  // isolated ones come last, in their order
      if (place_of_vertex[v] != kNone) block.of_isolated.push_back(place_of_vertex[v]);
  }

  /// Per vertex of the mesh the first block after `b` that has faces at it, there from the start or waiting.
  [[nodiscard]] std::vector<std::uint32_t> later_blocks(std::uint32_t b, const LoadedBlock& block) const {
    std::vector<std::uint32_t> of_source(block.vertices.size(), kNone);
    for_each_shared(block.vertices, blocks_.shared, [&](std::size_t v, std::size_t shared) {
      for (const std::uint32_t other : blocks_.shared.groups_of(shared))
        if (other > b) of_source[v] = std::min(of_source[v], other);
      if (moved_to_[shared] > b) of_source[v] = std::min(of_source[v], moved_to_[shared]);
    });
    std::vector<std::uint32_t> later;
    for (const std::uint32_t v : block.mesh.source_vertex) later.push_back(of_source[v]);
    return later;
  }

  void cut(std::uint32_t b, const LoadedBlock& block) {
    const chartify::BlockCharts cut = cut_block(block.mesh.mesh, later_blocks(b, block), options_);
    std::vector<std::vector<std::uint32_t>> faces(cut.charts.chart_count), isolated(cut.charts.chart_count);
    for (std::uint32_t f = 0; f < cut.charts.chart_of_face.size(); ++f) faces[cut.charts.chart_of_face[f]].push_back(f);
    for (std::size_t v = 0; v < block.of_isolated.size(); ++v)
      isolated[cut.charts.chart_of_isolated_vertex[v]].push_back(block.of_isolated[v]);
    for (std::uint32_t c = 0; c < cut.charts.chart_count; ++c) {
      const std::uint32_t later = cut.waits_for[c];
      const std::uint64_t size = faces[c].size() + isolated[c].size();
      if (later != kNone && load_[later] + size <= most_faces_)
        pass_on(block, faces[c], isolated[c], later);
      else
        finish(block, faces[c], isolated[c]);
    }
  }

  void pass_on(const LoadedBlock& block, const std::vector<std::uint32_t>& faces,
               const std::vector<std::uint32_t>& isolated, std::uint32_t later) {
    const std::uint64_t begin = waiting_.size();
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t f : faces) {
      const SortedFace& face = block.faces[block.of_mesh[block.mesh.source_face[f]]];
      waiting_.add(face);
      vertices.insert(vertices.end(), face.corners.begin(), face.corners.end());
    }
    for (const std::uint32_t place : isolated) waiting_.add(block.faces[place]);
    const auto size = static_cast<std::size_t>(waiting_.size() - begin);
    segments_[later].push_back({begin, size});
    load_[later] += size;
    sort_vertices(vertices);
    for_each_shared(vertices, blocks_.shared,
                    [&](std::size_t, std::size_t shared) { moved_to_[shared] = std::max(moved_to_[shared], later); });
  }

  void finish(const LoadedBlock& block, const std::vector<std::uint32_t>& faces,
              const std::vector<std::uint32_t>& isolated) {
    std::vector<ChartFace> chart;
    std::uint64_t key = ~std::uint64_t{0};
    for (const std::uint32_t f : faces) {
      const SortedFace& face = block.faces[block.of_mesh[block.mesh.source_face[f]]];
      key = std::min(key, face.key);
      Triangle corners{};
      for (std::size_t i = 0; i < 3; ++i)
        corners[i] = block.vertices[block.mesh.source_vertex[block.mesh.mesh.faces[f][i]]];
      chart.push_back({corners, face.face});
    }
    for (const std::uint32_t place : isolated) {
      key = std::min(key, block.faces[place].key);
      chart.push_back({block.faces[place].corners, block.faces[place].face});
    }
    spool_.add(key, chart, static_cast<std::uint32_t>(isolated.size()));
  }

  struct Segment {
    std::uint64_t begin;
    std::size_t size;
  };

  const FaceBlocks& blocks_;
  const PointFile& points_;
  const Lattice& lattice_;
  std::uint64_t most_faces_;
  chartify::Options options_;
  const LargeWork& work_;
  ScratchRecords<SortedFace> waiting_;
  std::map<std::uint32_t, std::vector<Segment>> segments_;  ///< of `waiting_`, by the block that they wait for
  ChartSpool spool_;
  std::vector<std::uint64_t> load_;      ///< per block its faces, and those that wait for it
  std::vector<std::uint32_t> moved_to_;  ///< per shared vertex the last block that faces at it wait for
};

}  // namespace

ChartSpool cut_blocks(const FaceBlocks& blocks, const PointFile& points, const Lattice& lattice,
                      std::uint64_t most_faces, const chartify::Options& options, const LargeWork& work) {
  return Cutter(blocks, points, lattice, most_faces, options, work).run();
}

}  // namespace ramcdb::detail
