#include "api/chart_seams.h"

#include <algorithm>
#include <compare>
#include <utility>

#include "api/face_blocks.h"
#include "api/vertex_ranks.h"
#include "chartify/parallel.h"

namespace ramcdb::detail {
namespace {

constexpr const char* kStage = "join";

/// An edge of a batch between vertices that others have as well.
struct EdgeOfBatch {
  chartify::NumberedEdge edge;
  std::uint32_t batch;
  friend auto operator<=>(const EdgeOfBatch&, const EdgeOfBatch&) = default;
};

/// Faces at shared vertices, by vertices of the whole mesh.
struct Surroundings {
  std::vector<Triangle> faces;
  std::vector<std::uint32_t> triangles;  ///< their numbers in MeshSpool::faces()
};

/// With all triangles of their polygons.
Surroundings faces_around(const ChartBatch& batch, const std::vector<std::uint8_t>& shared) {
  const std::vector<std::uint32_t>& polygons = batch.mesh.polygon_of_face;
  const auto is_shared = [&](const Triangle& t) { return shared[t[0]] || shared[t[1]] || shared[t[2]]; };
  std::vector<bool> around(polygons.size(), false);
  for (std::size_t f = 0; f < polygons.size(); ++f)
    if (is_shared(batch.mesh.faces[f])) around[polygons[f]] = true;
  Surroundings found;
  for (std::size_t f = 0; f < batch.mesh.faces.size(); ++f) {
    const Triangle& t = batch.mesh.faces[f];
    if (polygons.empty() ? !is_shared(t) : !around[polygons[f]]) continue;
    found.faces.push_back({batch.number[t[0]], batch.number[t[1]], batch.number[t[2]]});
    found.triangles.push_back(batch.face[f]);
  }
  return found;
}

/// The faces around all shared vertices, as a mesh of their own.
class SharedSurroundings {
 public:
  void add(const Surroundings& more) {
    faces_.insert(faces_.end(), more.faces.begin(), more.faces.end());
    triangles_.insert(triangles_.end(), more.triangles.begin(), more.triangles.end());
  }

  [[nodiscard]] Topology analyze(const SharedVertices& shared, const MeshSpool& of) {
    std::vector<std::uint32_t> corners;
    for (const Triangle& t : faces_) corners.insert(corners.end(), t.begin(), t.end());
    const VertexRanks ranks(corners);
    auto rank = ranks.rank.begin();
    for (Triangle& t : faces_)
      for (std::uint32_t& v : t) v = *rank++;
    std::vector<std::uint8_t> is_shared(ranks.vertices.size(), 0);
    for_each_shared(ranks.vertices, shared, [&](std::size_t v, std::size_t) { is_shared[v] = 1; });
    chartify::IndexedMesh mesh{std::vector<LatticePoint>(ranks.vertices.size()), std::move(faces_),
                               of.polygons_of(triangles_)};
    return analyze_shared(mesh, is_shared);
  }

 private:
  std::vector<Triangle> faces_;  ///< by vertices of the whole mesh
  std::vector<std::uint32_t> triangles_;
};

class SeamFinder {
 public:
  SeamFinder(const ChartSpool& spool, const std::vector<ChartSpool::Batch>& batches, std::size_t at_a_time,
             const MeshSpool& mesh, const Lattice& lattice, const LargeWork& work)
      : spool_(spool), batches_(batches), at_a_time_(at_a_time), mesh_(mesh), lattice_(lattice), work_(work) {}

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
  [[nodiscard]] ChartBatch load(std::size_t b) const { return load_charts(spool_, batches_[b], mesh_, lattice_); }

  /// Calls take(batch, work(batch)) for one batch after the other; what takes time is done for several at once.
  template <class Work, class Take>
  void for_each_batch(int pass, Work&& work, Take&& take) const {
    parallel_in_order(
        batches_.size(), at_a_time_, work_.threads, std::forward<Work>(work),
        [&](std::size_t b, auto&& result) { take(static_cast<std::uint32_t>(b), std::move(result)); },
        [&](double done) { work_.report(kStage, (pass + done) / 3); });
  }

  void find_shared_vertices() {
    SharedVertexFinder finder(work_, kStage);
    const auto vertices_of = [&](std::size_t b) {
      std::vector<std::uint32_t> vertices;
      for (std::size_t c = batches_[b].first; c < batches_[b].last; ++c) {
        const auto more = spool_.vertices_of(c);
        vertices.insert(vertices.end(), more.begin(), more.end());
      }
      sort_vertices(vertices);
      return vertices;
    };
    for_each_batch(0, vertices_of,
                   [&](std::uint32_t, std::vector<std::uint32_t> vertices) { finder.add_group(vertices); });
    out_.shared = finder.find();
  }

  void find_seams() {
    std::vector<EdgeOfBatch> edges;
    const auto edges_of = [&](std::size_t b) {
      const ChartBatch batch = load(b);
      const auto shared = out_.shared_in(batch);
      return chartify::edges_between_shared({batch.mesh, batch.charts, batch.number, shared});
    };
    for_each_batch(1, edges_of, [&](std::uint32_t b, const std::vector<chartify::NumberedEdge>& found) {
      for (const auto& edge : found) edges.push_back({edge, b});
    });
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

  /// What a batch alone knows of its end.
  struct BatchEnds {
    Topology topology;
    Surroundings surroundings;
    chartify::SharedEnds ends;
  };

  [[nodiscard]] BatchEnds ends_of(std::size_t b) const {
    const ChartBatch batch = load(b);
    const auto shared = out_.shared_in(batch);
    BatchEnds found{analyze_own(batch.mesh, shared), {}, {}};
    if (batches_.size() == 1) return found;
    found.surroundings = faces_around(batch, shared);
    found.ends = chartify::find_shared_ends({batch.mesh, batch.charts, batch.number, shared}, seams_of_[b]);
    return found;
  }

  void join() {
    chartify::SharedEnds ends;
    SharedSurroundings surroundings;
    for_each_batch(
        2, [&](std::size_t b) { return ends_of(b); },
        [&](std::uint32_t, const BatchEnds& found) {
          out_.topology += found.topology;
          surroundings.add(found.surroundings);
          ends.cut_edges.insert(ends.cut_edges.end(), found.ends.cut_edges.begin(), found.ends.cut_edges.end());
          ends.corners.insert(ends.corners.end(), found.ends.corners.begin(), found.ends.corners.end());
        });
    if (batches_.size() == 1) return;
    work_.report(kStage, 1);
    out_.topology += surroundings.analyze(out_.shared, mesh_);
    work_.report(kStage, 1);
    out_.net = chartify::join_seams(seams_, std::move(ends),
                                    [&](std::uint32_t v) { return lattice_.snap(mesh_.points.at(v)); });
    for (std::uint32_t w = 0; w < out_.net.wires.size(); ++w)
      for (const std::uint32_t b : out_.net.wires[w].parts) out_.wires[b].push_back(w);
  }

  const ChartSpool& spool_;
  const std::vector<ChartSpool::Batch>& batches_;
  std::size_t at_a_time_;
  const MeshSpool& mesh_;
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

ChartSeams find_seams(const ChartSpool& spool, const std::vector<ChartSpool::Batch>& batches, std::size_t at_a_time,
                      const MeshSpool& mesh, const Lattice& lattice, const LargeWork& work) {
  return SeamFinder(spool, batches, at_a_time, mesh, lattice, work).run();
}

}  // namespace ramcdb::detail
