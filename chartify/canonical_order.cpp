#include <algorithm>
#include <array>
#include <mutex>
#include <tuple>

#include "chartify/chartify.h"
#include "chartify/half_edge_twins.h"
#include "chartify/hilbert_cells.h"
#include "chartify/parallel.h"
#include "chartify/radix_sort.h"

namespace ramcdb::chartify {
namespace {

/// What tells a corner of a face apart from others, by positions alone: its own, and that of the apex across the edge
/// which begins there.
struct CornerMark {
  LatticePoint position, apex;
  friend auto operator<=>(const CornerMark&, const CornerMark&) = default;
};
using FaceMark = std::array<CornerMark, 3>;

/// A face, where it lies on the curve, and from which corner on it is named.
struct Place {
  std::uint64_t key;
  std::uint32_t face;
  std::uint32_t turn;
};

class Sorter {
 public:
  Sorter(const IndexedMesh& mesh, unsigned threads) : mesh_(mesh), threads_(threads), cells_(mesh) {}

  CanonicalMesh run() {
    std::vector<Place> places(mesh_.faces.size());
    parallel_ranges(places.size(), threads_, [&](std::size_t begin, std::size_t end) {
      for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f)
        places[f] = {cells_.key_of_face(f), f, smallest_turn(f)};
    });
    radix_sort(places, &Place::key);
    const auto same_key = [](const Place& a, const Place& b) { return a.key != b.key; };
    for (auto first = places.begin(); first != places.end();) {
      const auto last = std::adjacent_find(first, places.end(), same_key);
      const auto end = last == places.end() ? last : last + 1;
      if (end - first > 1) std::sort(first, end, [&](const Place& a, const Place& b) { return comes_before(a, b); });
      first = end;
    }
    return number_vertices(places);
  }

 private:
  [[nodiscard]] LatticePoint position(std::uint32_t face, std::uint32_t turn, std::uint32_t i) const {
    return mesh_.positions[mesh_.faces[face][(i + turn) % 3]];
  }

  [[nodiscard]] FaceMark mark(std::uint32_t face, std::uint32_t turn) const {
    const std::vector<HalfEdge>& twins = twins_of_mesh();
    FaceMark m;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const HalfEdge twin = twins[3 * face + (i + turn) % 3];
      // Where there is no neighbour a point outside the lattice stands for the apex.
      const LatticePoint none{kMaxLatticeCoordinate + 1, 0, 0};
      const LatticePoint apex =
          twin == kNoTwin ? none : mesh_.positions[mesh_.faces[face_of(twin)][previous_in_face(twin) % 3]];
      m[i] = {position(face, turn, i), apex};
    }
    return m;
  }

  /// The turn that makes the sequence of positions smallest; apexes decide where two turns give the same.
  [[nodiscard]] std::uint32_t smallest_turn(std::uint32_t face) const {
    const auto positions = [&](std::uint32_t turn) {
      return std::array{position(face, turn, 0), position(face, turn, 1), position(face, turn, 2)};
    };
    std::uint32_t best = 0;
    for (std::uint32_t turn = 1; turn < 3; ++turn) {
      const auto order = positions(turn) <=> positions(best);
      if (order < 0 || (order == 0 && mark(face, turn) < mark(face, best))) best = turn;
    }
    return best;
  }

  /// REQUIRES: equal keys
  [[nodiscard]] bool comes_before(const Place& a, const Place& b) const {
    for (std::uint32_t i = 0; i < 3; ++i)
      if (const auto order = position(a.face, a.turn, i) <=> position(b.face, b.turn, i); order != 0) return order < 0;
    const FaceMark mark_a = mark(a.face, a.turn), mark_b = mark(b.face, b.turn);
    return mark_a != mark_b ? mark_a < mark_b : a.face < b.face;
  }

  /// Found when equal positions first ask for them, which few meshes do.
  [[nodiscard]] const std::vector<HalfEdge>& twins_of_mesh() const {
    std::call_once(twins_found_, [&] { twins_ = find_twins(mesh_, group_half_edges(mesh_)); });
    return twins_;
  }

  /// Vertices in the order in which the sorted faces first name them; isolated ones behind, along the curve.
  [[nodiscard]] CanonicalMesh number_vertices(const std::vector<Place>& places) const {
    CanonicalMesh out;
    std::vector<std::uint32_t> to(mesh_.positions.size(), kNone);
    const auto number = [&](std::uint32_t v) {
      if (to[v] == kNone) {
        to[v] = static_cast<std::uint32_t>(out.source_vertex.size());
        out.source_vertex.push_back(v);
      }
      return to[v];
    };
    out.source_vertex.reserve(to.size());
    out.source_face.reserve(places.size());
    out.mesh.faces.reserve(places.size());
    for (const Place& place : places) {
      const Triangle& corners = mesh_.faces[place.face];
      Triangle t{};
      for (std::uint32_t i = 0; i < 3; ++i) t[i] = number(corners[(i + place.turn) % 3]);
      out.mesh.faces.push_back(t);
      out.source_face.push_back(place.face);
    }
    std::vector<std::uint32_t> isolated;
    for (std::uint32_t v = 0; v < to.size(); ++v)
      if (to[v] == kNone) isolated.push_back(v);
    const auto rank = [&](std::uint32_t v) { return std::tuple(cells_.key_of_vertex(v), mesh_.positions[v], v); };
    std::sort(isolated.begin(), isolated.end(), [&](std::uint32_t a, std::uint32_t b) { return rank(a) < rank(b); });
    for (const std::uint32_t v : isolated) number(v);
    out.mesh.positions.reserve(out.source_vertex.size());
    for (const std::uint32_t v : out.source_vertex) out.mesh.positions.push_back(mesh_.positions[v]);
    return out;
  }

  const IndexedMesh& mesh_;
  unsigned threads_;
  HilbertCells cells_;
  mutable std::once_flag twins_found_;
  mutable std::vector<HalfEdge> twins_;
};

}  // namespace

CanonicalMesh canonical_order(const IndexedMesh& mesh, unsigned threads) { return Sorter(mesh, threads).run(); }

}  // namespace ramcdb::chartify
