#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "chartify/chartify.h"
#include "chartify/half_edge_twins.h"
#include "chartify/hilbert_cells.h"
#include "chartify/partition.h"

namespace ramcdb::chartify {
namespace {

/// What tells a corner of a face apart from others, by positions alone: its own, and that of the apex across the edge
/// which begins there.
struct CornerMark {
  LatticePoint position, apex;
  friend auto operator<=>(const CornerMark&, const CornerMark&) = default;
};
using FaceMark = std::array<CornerMark, 3>;

class Sorter {
 public:
  explicit Sorter(const IndexedMesh& mesh) : mesh_(mesh), twins_(find_twins(mesh, group_half_edges(mesh))) {}

  CanonicalMesh run() {
    const std::size_t faces = mesh_.faces.size();
    const HilbertCells cells(mesh_);
    turn_.resize(faces);
    key_.resize(faces);
    for (std::uint32_t f = 0; f < faces; ++f) {
      turn_[f] = smallest_turn(f);
      key_[f] = cells.key_of_face(f);
    }
    CanonicalMesh out;
    out.source_face.resize(faces);
    std::iota(out.source_face.begin(), out.source_face.end(), 0U);
    std::sort(out.source_face.begin(), out.source_face.end(),
              [&](std::uint32_t a, std::uint32_t b) { return comes_before(a, b); });
    number_vertices(out, cells);
    return out;
  }

 private:
  [[nodiscard]] LatticePoint position(std::uint32_t face, std::uint32_t turn, std::uint32_t i) const {
    return mesh_.positions[mesh_.faces[face][(i + turn) % 3]];
  }

  [[nodiscard]] FaceMark mark(std::uint32_t face, std::uint32_t turn) const {
    FaceMark m;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const HalfEdge twin = twins_[3 * face + (i + turn) % 3];
      // Where there is no neighbour a point outside the lattice stands for the apex.
      const LatticePoint none{kMaxLatticeCoordinate + 1, 0, 0};
      const LatticePoint apex =
          twin == kNoTwin ? none : mesh_.positions[mesh_.faces[face_of(twin)][previous_in_face(twin) % 3]];
      m[i] = {position(face, turn, i), apex};
    }
    return m;
  }

  /// The turn that makes the sequence of positions smallest; apexes decide where two turns give the same.
  [[nodiscard]] std::uint8_t smallest_turn(std::uint32_t face) const {
    const auto positions = [&](std::uint32_t turn) {
      return std::array{position(face, turn, 0), position(face, turn, 1), position(face, turn, 2)};
    };
    std::uint32_t best = 0;
    for (std::uint32_t turn = 1; turn < 3; ++turn) {
      const auto order = positions(turn) <=> positions(best);
      if (order < 0 || (order == 0 && mark(face, turn) < mark(face, best))) best = turn;
    }
    return static_cast<std::uint8_t>(best);
  }

  [[nodiscard]] bool comes_before(std::uint32_t a, std::uint32_t b) const {
    if (key_[a] != key_[b]) return key_[a] < key_[b];
    for (std::uint32_t i = 0; i < 3; ++i)
      if (const auto order = position(a, turn_[a], i) <=> position(b, turn_[b], i); order != 0) return order < 0;
    const FaceMark mark_a = mark(a, turn_[a]), mark_b = mark(b, turn_[b]);
    return mark_a != mark_b ? mark_a < mark_b : a < b;
  }

  /// Vertices in the order in which the sorted faces first name them; isolated ones behind, along the curve.
  void number_vertices(CanonicalMesh& out, const HilbertCells& cells) const {
    std::vector<std::uint32_t> to(mesh_.positions.size(), kNone);
    const auto number = [&](std::uint32_t v) {
      if (to[v] == kNone) {
        to[v] = static_cast<std::uint32_t>(out.source_vertex.size());
        out.source_vertex.push_back(v);
      }
      return to[v];
    };
    out.mesh.faces.reserve(mesh_.faces.size());
    for (const std::uint32_t f : out.source_face) {
      Triangle t{};
      for (std::uint32_t i = 0; i < 3; ++i) t[i] = number(mesh_.faces[f][(i + turn_[f]) % 3]);
      out.mesh.faces.push_back(t);
    }
    std::vector<std::uint32_t> isolated;
    for (std::uint32_t v = 0; v < to.size(); ++v)
      if (to[v] == kNone) isolated.push_back(v);
    const auto rank = [&](std::uint32_t v) { return std::tuple(cells.key_of_vertex(v), mesh_.positions[v], v); };
    std::sort(isolated.begin(), isolated.end(), [&](std::uint32_t a, std::uint32_t b) { return rank(a) < rank(b); });
    for (const std::uint32_t v : isolated) number(v);
    out.mesh.positions.reserve(out.source_vertex.size());
    for (const std::uint32_t v : out.source_vertex) out.mesh.positions.push_back(mesh_.positions[v]);
  }

  const IndexedMesh& mesh_;
  std::vector<HalfEdge> twins_;
  std::vector<std::uint8_t> turn_;
  std::vector<std::uint64_t> key_;
};

}  // namespace

CanonicalMesh canonical_order(const IndexedMesh& mesh) { return Sorter(mesh).run(); }

}  // namespace ramcdb::chartify
