#include "api/face_blocks.h"

#include <algorithm>

#include "api/external_sort.h"
#include "chartify/hilbert_cells.h"
#include "chartify/parallel.h"

namespace ramcdb::detail {
namespace {

constexpr const char* kStage = "sort";

class BlockSorter {
 public:
  BlockSorter(const MeshSpool& mesh, const Lattice& lattice, const LatticeBox& range, const LargeWork& work)
      : mesh_(mesh),
        lattice_(lattice),
        curve_(range),
        work_(work),
        sorter_(work.folder, work.memory / 4, work.threads, [this] { report(done_); }) {}

  FaceBlocks run(std::uint64_t block_faces) {
    add_faces();
    add_isolated_vertices();
    FaceBlocks blocks(work_.folder);
    SharedVertexFinder finder(work_, kStage);
    std::vector<std::uint32_t> vertices;
    std::uint64_t begin = 0;
    SortedFace before;
    const auto end_block = [&] {
      blocks.ends.push_back(begin = blocks.faces.size());
      finder.add_group(std::move(vertices));
      vertices.clear();
      report(0.5 + 0.4 * share(begin));
    };
    sorter_.merge([&](const SortedFace& face) {
      const std::uint64_t held = blocks.faces.size() - begin;
      // Equal keys stay together, so that blocks do not hang on how the file numbers faces, unless these are too many.
      const bool may_split = face.key != before.key || (held >= 2 * block_faces && !is_of_polygon(face, before));
      if (held >= block_faces && may_split) end_block();
      before = face;
      blocks.faces.add(face);
      for (const std::uint32_t v : face.corners)
        if (v != SortedFace::kNoVertex) vertices.push_back(v);
      if (held % 65536 == 0) report(0.5 + 0.4 * share(blocks.faces.size()));
    });
    if (blocks.faces.size() > begin) end_block();
    blocks.faces.flush();
    blocks.shared = finder.find();
    return blocks;
  }

 private:
  void report(double done) { work_.report(kStage, done_ = done); }
  [[nodiscard]] double share(std::uint64_t faces) const {
    return static_cast<double>(faces) / static_cast<double>(mesh_.faces().size() + 1);
  }

  [[nodiscard]] LatticePoint point(std::uint32_t vertex) const { return lattice_.snap(mesh_.points.at(vertex)); }

  void add_faces() {
    constexpr std::size_t kSome = 1 << 12;
    std::vector<std::uint64_t> keys;
    std::vector<SortedFace> polygon;
    mesh_.faces().for_each_piece([&](std::span<const Triangle> piece, std::uint64_t first) {
      keys.resize(piece.size());
      parallel_for((piece.size() + kSome - 1) / kSome, work_.threads, [&](std::size_t part) {
        for (std::size_t f = part * kSome; f < std::min(piece.size(), (part + 1) * kSome); ++f)
          keys[f] = curve_.key(point(piece[f][0]), point(piece[f][1]), point(piece[f][2]));
      });
      for (std::size_t f = 0; f < piece.size(); ++f) {
        const SortedFace face{keys[f], static_cast<std::uint32_t>(first + f), piece[f]};
        if (mesh_.polygons)
          add_to_polygon(face, polygon);
        else
          sorter_.add(face);
      }
      report(0.5 * share(first));
    });
    add_polygon(polygon);
  }

  [[nodiscard]] bool is_of_polygon(const SortedFace& face, const SortedFace& before) const {
    return mesh_.polygons && !face.is_isolated_vertex() && !before.is_isolated_vertex() &&
           mesh_.source(face.face).face == mesh_.source(before.face).face;
  }

  void add_to_polygon(const SortedFace& face, std::vector<SortedFace>& polygon) {
    if (!polygon.empty() && mesh_.source(polygon.front().face).face != mesh_.source(face.face).face)
      add_polygon(polygon);
    polygon.push_back(face);
  }

  /// Its triangles lie where the first of them does.
  void add_polygon(std::vector<SortedFace>& polygon) {
    std::uint64_t key = ~std::uint64_t{0};
    for (const SortedFace& face : polygon) key = std::min(key, face.key);
    for (SortedFace& face : polygon) {
      face.key = key;
      sorter_.add(face);
    }
    polygon.clear();
  }

  void add_isolated_vertices() {
    for (std::uint32_t v = 0; v < mesh_.points.size(); ++v) {
      if (v % (1U << 20) == 0) report(0.5);
      if (mesh_.in_a_face[v]) continue;
      const LatticePoint p = point(v);
      sorter_.add({curve_.key(p, p, p), SortedFace::kNoVertex, {v, SortedFace::kNoVertex, SortedFace::kNoVertex}});
    }
  }

  const MeshSpool& mesh_;
  const Lattice& lattice_;
  chartify::HilbertCurve curve_;
  const LargeWork& work_;
  double done_ = 0;
  ExternalSorter<SortedFace> sorter_;
};

}  // namespace

FaceBlocks sort_into_blocks(const MeshSpool& mesh, const Lattice& lattice, const LatticeBox& range,
                            std::uint64_t block_faces, const LargeWork& work) {
  return BlockSorter(mesh, lattice, range, work).run(block_faces);
}

}  // namespace ramcdb::detail
