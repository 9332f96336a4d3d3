#include <algorithm>
#include <array>
#include <span>
#include <tuple>
#include <utility>

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

/// The neighbours of some faces, where most of a mesh's are asked for by nobody.
class SomeTwins {
 public:
  /// \param faces ascending
  SomeTwins(const IndexedMesh& mesh, std::vector<std::uint32_t> faces) : faces_(std::move(faces)) {
    const Part part = around(mesh);
    const std::vector<HalfEdge> twins = find_twins(part.mesh, group_half_edges(part.mesh));
    for (const std::uint32_t f : faces_) {
      const auto at = std::ranges::lower_bound(part.faces, f) - part.faces.begin();
      for (std::size_t i = 0; i < 3; ++i) {
        const HalfEdge twin = twins[3 * static_cast<std::size_t>(at) + i];
        twins_.push_back(twin == kNoTwin ? kNoTwin : 3 * part.faces[face_of(twin)] + twin % 3);
      }
    }
  }

  /// REQUIRES: one of the faces
  [[nodiscard]] HalfEdge of(std::uint32_t face, std::uint32_t corner) const {
    return twins_[3 * static_cast<std::size_t>(std::ranges::lower_bound(faces_, face) - faces_.begin()) + corner];
  }

 private:
  struct Part {
    IndexedMesh mesh;
    std::vector<std::uint32_t> faces;  ///< of the whole mesh, ascending
  };

  /// All faces that may share an edge with one of the faces: those with two of their vertices.
  [[nodiscard]] Part around(const IndexedMesh& mesh) const {
    std::vector<std::uint32_t> to(mesh.positions.size(), kNone);
    Part part;
    const auto number = [&](std::uint32_t v) {
      if (to[v] == kNone) {
        to[v] = static_cast<std::uint32_t>(part.mesh.positions.size());
        part.mesh.positions.push_back(mesh.positions[v]);
      }
      return to[v];
    };
    for (const std::uint32_t f : faces_)
      for (const std::uint32_t v : mesh.faces[f]) (void)number(v);
    const auto count = part.mesh.positions.size();
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      const Triangle& t = mesh.faces[f];
      if (std::ranges::count_if(t, [&](std::uint32_t v) { return to[v] < count; }) < 2) continue;
      part.faces.push_back(f);
      part.mesh.faces.push_back({number(t[0]), number(t[1]), number(t[2])});
      if (!mesh.polygon_of_face.empty()) part.mesh.polygon_of_face.push_back(mesh.polygon_of_face[f]);
    }
    return part;
  }

  std::vector<std::uint32_t> faces_;
  std::vector<HalfEdge> twins_;
};

class Sorter {
 public:
  Sorter(const IndexedMesh& mesh, unsigned threads) : mesh_(mesh), threads_(threads), cells_(mesh) {}

  CanonicalMesh run(const Progress& progress) {
    std::vector<Place> places(mesh_.faces.size());
    parallel_ranges(
        places.size(), threads_,
        [&](std::size_t begin, std::size_t end) {
          for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f)
            places[f] = {cells_.key_of_face(f), f, first_turn(f)};
        },
        part_of(progress, 0, 0.3));
    radix_sort(places, &Place::key);
    report(progress, 0.4);
    std::vector<std::span<Place>> ties = sort_by_positions(places);
    report(progress, 0.5);
    if (!ties.empty()) sort_by_neighbours(ties);
    return number_vertices(places, part_of(progress, 0.6, 1));
  }

 private:
  using Positions = std::array<LatticePoint, 3>;

  [[nodiscard]] Positions positions(std::uint32_t face, std::uint32_t turn) const {
    const Triangle& t = mesh_.faces[face];
    return {mesh_.positions[t[turn]], mesh_.positions[t[(turn + 1) % 3]], mesh_.positions[t[(turn + 2) % 3]]};
  }
  [[nodiscard]] Positions positions(const Place& place) const { return positions(place.face, place.turn); }

  /// The first turn that makes the sequence of positions smallest. Two turns give the same only where all three are
  /// equal.
  [[nodiscard]] std::uint32_t first_turn(std::uint32_t face) const {
    std::uint32_t best = 0;
    for (std::uint32_t turn = 1; turn < 3; ++turn)
      if (positions(face, turn) < positions(face, best)) best = turn;
    return best;
  }

  /// Returns runs of faces that lie on the same positions, and faces on one point.
  [[nodiscard]] std::vector<std::span<Place>> sort_by_positions(std::vector<Place>& places) const {
    std::vector<std::span<Place>> ties;
    const auto comes_before = [&](const Place& a, const Place& b) { return positions(a) < positions(b); };
    for (auto first = places.begin(); first != places.end();) {
      const auto end = std::find_if(first + 1, places.end(), [&](const Place& p) { return p.key != first->key; });
      if (end - first > 1) std::sort(first, end, comes_before);
      while (first != end) {
        const Positions here = positions(*first);
        const auto last = std::find_if(first + 1, end, [&](const Place& p) { return positions(p) != here; });
        if (last - first > 1 || (here[0] == here[1] && here[1] == here[2])) ties.emplace_back(first, last);
        first = last;
      }
    }
    return ties;
  }

  void sort_by_neighbours(const std::vector<std::span<Place>>& ties) const {
    std::vector<std::uint32_t> faces;
    for (const std::span<Place> tie : ties)
      for (const Place& place : tie) faces.push_back(place.face);
    std::ranges::sort(faces);
    const SomeTwins twins(mesh_, std::move(faces));
    for (const std::span<Place> tie : ties) {
      const Positions here = positions(tie.front());
      std::vector<std::pair<FaceMark, Place>> marked;
      for (Place place : tie) {
        FaceMark best = mark(place, twins);
        for (std::uint32_t turn = 1; here[0] == here[1] && here[1] == here[2] && turn < 3; ++turn) {
          const Place turned{place.key, place.face, turn};
          if (FaceMark other = mark(turned, twins); other < best) {
            best = other;
            place = turned;
          }
        }
        marked.emplace_back(best, place);
      }
      std::ranges::sort(marked, [](const auto& a, const auto& b) {
        return std::tie(a.first, a.second.face) < std::tie(b.first, b.second.face);
      });
      std::ranges::transform(marked, tie.begin(), [](const auto& m) { return m.second; });
    }
  }

  [[nodiscard]] FaceMark mark(const Place& place, const SomeTwins& twins) const {
    FaceMark m;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t corner = (i + place.turn) % 3;
      const HalfEdge twin = twins.of(place.face, corner);
      // Where there is no neighbour a point outside the lattice stands for the apex.
      const LatticePoint none{kMaxLatticeCoordinate + 1, 0, 0};
      const LatticePoint apex =
          twin == kNoTwin ? none : mesh_.positions[mesh_.faces[face_of(twin)][previous_in_face(twin) % 3]];
      m[i] = {mesh_.positions[mesh_.faces[place.face][corner]], apex};
    }
    return m;
  }

  /// Vertices in the order in which the sorted faces first name them; isolated ones behind, along the curve.
  [[nodiscard]] CanonicalMesh number_vertices(const std::vector<Place>& places, const Progress& progress) const {
    constexpr std::size_t kFacesBetweenReports = 1 << 18;
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
      if (out.source_face.size() % kFacesBetweenReports == 0)
        report(progress, static_cast<double>(out.source_face.size()) / static_cast<double>(places.size()));
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
};

}  // namespace

CanonicalMesh canonical_order(const IndexedMesh& mesh, unsigned threads, const Progress& progress) {
  return Sorter(mesh, threads).run(progress);
}

}  // namespace ramcdb::chartify
