#include "api/chart_seams.h"

#include <algorithm>
#include <compare>
#include <utility>

#include "api/face_blocks.h"

namespace ramcdb::detail {
namespace {

constexpr const char* kStage = "join";

/// An edge of a batch between vertices that others have as well.
struct EdgeOfBatch {
  chartify::NumberedEdge edge;
  std::uint32_t batch;
  friend auto operator<=>(const EdgeOfBatch&, const EdgeOfBatch&) = default;
};

/// The faces around all shared vertices, as a mesh of their own.
class SharedSurroundings {
 public:
  void add(const ChartBatch& batch, const std::vector<std::uint8_t>& shared) {
    for (const Triangle& t : batch.mesh.faces)
      if (shared[t[0]] || shared[t[1]] || shared[t[2]])
        faces_.push_back({batch.number[t[0]], batch.number[t[1]], batch.number[t[2]]});
  }

  [[nodiscard]] Topology analyze(const SharedVertices& shared) {
    std::vector<std::uint32_t> vertices;
    for (const Triangle& t : faces_) vertices.insert(vertices.end(), t.begin(), t.end());
    sort_vertices(vertices);
    for (Triangle& t : faces_)
      for (std::uint32_t& v : t)
        v = static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
    std::vector<std::uint8_t> is_shared(vertices.size(), 0);
    for_each_shared(vertices, shared, [&](std::size_t v, std::size_t) { is_shared[v] = 1; });
    chartify::IndexedMesh mesh{std::vector<LatticePoint>(vertices.size()), std::move(faces_)};
    return analyze_shared(mesh, is_shared);
  }

 private:
  std::vector<Triangle> faces_;  ///< by vertices of the whole mesh
};

class SeamFinder {
 public:
  SeamFinder(const ChartSpool& spool, const std::vector<ChartSpool::Batch>& batches, const PointFile& points,
             const Lattice& lattice, const LargeWork& work)
      : spool_(spool), batches_(batches), points_(points), lattice_(lattice), work_(work) {}

  ChartSeams run() {
    out_.wires.resize(batches_.size());
    seams_of_.resize(batches_.size());
    if (batches_.size() > 1) {
      find_shared_vertices();
      find_seams();
    }
    join();
    return std::move(out_);
  }

 private:
  void report(int pass, std::size_t batch) const {
    work_.report(kStage, (pass + static_cast<double>(batch) / static_cast<double>(batches_.size())) / 3);
  }
  [[nodiscard]] ChartBatch load(std::size_t b) const { return load_charts(spool_, batches_[b], points_, lattice_); }

  void find_shared_vertices() {
    SharedVertexFinder finder(work_, kStage);
    for (std::size_t b = 0; b < batches_.size(); ++b) {
      report(0, b);
      std::vector<std::uint32_t> vertices;
      for (std::size_t c = batches_[b].first; c < batches_[b].last; ++c)
        for (const ChartFace& face : spool_.faces_of(c))
          for (const std::uint32_t v : face.corners)
            if (v != SortedFace::kNoVertex) vertices.push_back(v);
      finder.add_group(std::move(vertices));
    }
    out_.shared = finder.find();
  }

  void find_seams() {
    std::vector<EdgeOfBatch> edges;
    for (std::uint32_t b = 0; b < batches_.size(); ++b) {
      report(1, b);
      const ChartBatch batch = load(b);
      const auto shared = out_.shared_in(batch);
      for (const auto& edge : chartify::edges_between_shared({batch.mesh, batch.charts, batch.number, shared}))
        edges.push_back({edge, b});
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
      while (end < edges.size() && edges[end].edge == edges[begin].edge) ++end;
      if (end - begin < 2) continue;
      chartify::Seam& seam = seams_.emplace_back();
      seam.edge = edges[begin].edge;
      for (std::size_t i = begin; i < end; ++i) {
        seam.parts.push_back(edges[i].batch);
        seams_of_[edges[i].batch].push_back(seam.edge);
      }
    }
  }

  void join() {
    chartify::SharedEnds ends;
    SharedSurroundings surroundings;
    for (std::uint32_t b = 0; b < batches_.size(); ++b) {
      report(2, b);
      const ChartBatch batch = load(b);
      const auto shared = out_.shared_in(batch);
      out_.topology += analyze_own(batch.mesh, shared);
      if (batches_.size() == 1) return;
      surroundings.add(batch, shared);
      const auto found = chartify::find_shared_ends({batch.mesh, batch.charts, batch.number, shared}, seams_of_[b]);
      ends.cut_edges.insert(ends.cut_edges.end(), found.cut_edges.begin(), found.cut_edges.end());
      ends.corners.insert(ends.corners.end(), found.corners.begin(), found.corners.end());
    }
    out_.topology += surroundings.analyze(out_.shared);
    out_.net =
        chartify::join_seams(seams_, std::move(ends), [&](std::uint32_t v) { return lattice_.snap(points_.at(v)); });
    for (std::uint32_t w = 0; w < out_.net.wires.size(); ++w)
      for (const std::uint32_t b : out_.net.wires[w].parts) out_.wires[b].push_back(w);
  }

  const ChartSpool& spool_;
  const std::vector<ChartSpool::Batch>& batches_;
  const PointFile& points_;
  const Lattice& lattice_;
  const LargeWork& work_;
  std::vector<chartify::Seam> seams_;
  std::vector<std::vector<chartify::NumberedEdge>> seams_of_;  ///< per batch, ascending
  ChartSeams out_;
};

}  // namespace

std::vector<std::uint8_t> ChartSeams::shared_in(const ChartBatch& batch) const {
  std::vector<std::uint8_t> is_shared;
  for (const std::uint32_t number : batch.number)
    is_shared.push_back(std::ranges::binary_search(shared.vertices, number));
  return is_shared;
}

ChartSeams find_seams(const ChartSpool& spool, const std::vector<ChartSpool::Batch>& batches, const PointFile& points,
                      const Lattice& lattice, const LargeWork& work) {
  return SeamFinder(spool, batches, points, lattice, work).run();
}

}  // namespace ramcdb::detail
