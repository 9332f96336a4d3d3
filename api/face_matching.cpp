#include "api/face_matching.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace ramcdb::detail {
namespace {

constexpr std::uint32_t kNone = FaceMatch::kNone;

/// Three positions, turned so that the smallest sequence comes first.
struct Shape {
  std::array<LatticePoint, 3> p;
  std::uint32_t turn = 0;  ///< p[i] is corner (i + turn) % 3 of the face
  std::uint32_t face = 0;
};

Shape shape_of(const Surface& s, std::uint32_t face) {
  Shape best;
  for (std::uint32_t turn = 0; turn < 3; ++turn) {
    Shape shape{{}, turn, face};
    for (std::uint32_t i = 0; i < 3; ++i) shape.p[i] = s.points[s.faces[face][(i + turn) % 3]];
    if (turn == 0 || shape.p < best.p) best = shape;
  }
  return best;
}

std::vector<Shape> sorted_shapes(const Surface& s) {
  std::vector<Shape> shapes(s.faces.size());
  for (std::uint32_t f = 0; f < s.faces.size(); ++f) shapes[f] = shape_of(s, f);
  std::sort(shapes.begin(), shapes.end(),
            [](const Shape& a, const Shape& b) { return std::tie(a.p, a.face) < std::tie(b.p, b.face); });
  return shapes;
}

/// The directed edge from corner 3 * face + i to the next corner of the face, by vertices.
struct Edge {
  std::uint32_t a, b, corner;
};

/// For every directed edge the corner of the one face that passes it the other way; kNone on borders and wherever more
/// than two faces meet.
std::vector<std::uint32_t> opposite_corners(const Surface& s) {
  std::vector<Edge> edges;
  edges.reserve(3 * s.faces.size());
  for (std::uint32_t f = 0; f < s.faces.size(); ++f)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t a = s.faces[f][i], b = s.faces[f][(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), 3 * f + i});
    }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& x, const Edge& y) { return std::tie(x.a, x.b, x.corner) < std::tie(y.a, y.b, y.corner); });
  std::vector<std::uint32_t> opposite(edges.size(), kNone);
  const auto start = [&](std::uint32_t corner) { return s.faces[corner / 3][corner % 3]; };
  for (std::size_t i = 0, end; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end].a == edges[i].a && edges[end].b == edges[i].b;) ++end;
    if (end - i != 2 || start(edges[i].corner) == start(edges[i + 1].corner)) continue;
    opposite[edges[i].corner] = edges[i + 1].corner;
    opposite[edges[i + 1].corner] = edges[i].corner;
  }
  return opposite;
}

/// A surface whose vertices are one per position, so that a soup has neighbours too.
std::vector<Triangle> welded_faces(const Surface& s) {
  std::vector<std::uint32_t> order(s.points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::tie(s.points[a], a) < std::tie(s.points[b], b); });
  std::vector<std::uint32_t> representative(s.points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    representative[order[i]] =
        i && s.points[order[i]] == s.points[order[i - 1]] ? representative[order[i - 1]] : order[i];
  std::vector<Triangle> faces(s.faces.begin(), s.faces.end());
  for (Triangle& t : faces)
    for (std::uint32_t& v : t) v = representative[v];
  return faces;
}

class Matcher {
 public:
  Matcher(const Surface& from, const Surface& to)
      : from_(from), to_(to), matches_(from.faces.size()), taken_(to.faces.size(), false) {}

  Matching run() {
    from_opposite_ = opposites_of(from_);
    to_opposite_ = opposites_of(to_);
    match_unique_shapes();
    walk();
    match_unique_edges();
    walk();
    match_equal_shapes();
    walk();
    Matching result;
    for (std::uint32_t f = 0; f < matches_.size(); ++f)
      if (matches_[f].face == kNone && result.unmatched++ == 0) result.first_unmatched = f;
    result.matches = std::move(matches_);
    return result;
  }

 private:
  /// Neighbours by vertices; where vertices have none, by positions.
  static std::vector<std::uint32_t> opposites_of(const Surface& s) {
    std::vector<std::uint32_t> opposite = opposite_corners(s);
    const std::vector<Triangle> welded = welded_faces(s);
    const std::vector<std::uint32_t> by_position = opposite_corners({s.points, welded});
    for (std::size_t c = 0; c < opposite.size(); ++c) {
      const std::uint32_t other = by_position[c];
      if (opposite[c] == kNone && other != kNone && opposite[other] == kNone) {
        opposite[c] = other;
        opposite[other] = static_cast<std::uint32_t>(c);
      }
    }
    return opposite;
  }

  bool match(std::uint32_t f, std::uint32_t g, std::uint32_t turn) {
    if (matches_[f].face != kNone || taken_[g]) return false;
    matches_[f] = {g, turn};
    taken_[g] = true;
    front_.push_back(f);
    return true;
  }

  void match_shapes(const Shape& a, const Shape& b) { match(a.face, b.face, (b.turn + 3 - a.turn) % 3); }

  /// Calls `group` with each run of equal shapes, [begin, end) in either list, where both have some.
  template <class Visit>
  static void for_equal(const std::vector<Shape>& a, const std::vector<Shape>& b, Visit&& group) {
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
      if (a[i].p < b[j].p) {
        ++i;
      } else if (b[j].p < a[i].p) {
        ++j;
      } else {
        std::size_t i_end = i, j_end = j;
        while (i_end < a.size() && a[i_end].p == a[i].p) ++i_end;
        while (j_end < b.size() && b[j_end].p == b[j].p) ++j_end;
        group(i, i_end, j, j_end);
        i = i_end;
        j = j_end;
      }
    }
  }

  void match_unique_shapes() {
    from_shapes_ = sorted_shapes(from_);
    to_shapes_ = sorted_shapes(to_);
    for_equal(from_shapes_, to_shapes_, [&](std::size_t i, std::size_t i_end, std::size_t j, std::size_t j_end) {
      const bool turns_clear =
          !(from_shapes_[i].p[0] == from_shapes_[i].p[1] && from_shapes_[i].p[1] == from_shapes_[i].p[2]);
      if (i_end - i == 1 && j_end - j == 1 && turns_clear) match_shapes(from_shapes_[i], to_shapes_[j]);
    });
  }

  /// What is left of several faces in one place: they are alike, any pairing gives the same surface.
  void match_equal_shapes() {
    for_equal(from_shapes_, to_shapes_, [&](std::size_t i, std::size_t i_end, std::size_t j, std::size_t j_end) {
      while (i < i_end && j < j_end) {
        if (matches_[from_shapes_[i].face].face != kNone) {
          ++i;
        } else if (taken_[to_shapes_[j].face]) {
          ++j;
        } else {
          match_shapes(from_shapes_[i++], to_shapes_[j++]);
        }
      }
    });
  }

  struct PlacedEdge {
    LatticePoint a, b;
    std::uint32_t corner;
  };

  template <class IsFree>
  static std::vector<PlacedEdge> free_edges(const Surface& s, IsFree&& is_free) {
    std::vector<PlacedEdge> edges;
    for (std::uint32_t f = 0; f < s.faces.size(); ++f) {
      if (!is_free(f)) continue;
      for (std::uint32_t i = 0; i < 3; ++i)
        edges.push_back({s.points[s.faces[f][i]], s.points[s.faces[f][(i + 1) % 3]], 3 * f + i});
    }
    std::sort(edges.begin(), edges.end(), [](const PlacedEdge& x, const PlacedEdge& y) {
      return std::tie(x.a, x.b, x.corner) < std::tie(y.a, y.b, y.corner);
    });
    // An edge that stands several times says nothing.
    std::vector<PlacedEdge> unique;
    for (std::size_t i = 0, end; i < edges.size(); i = end) {
      for (end = i; end < edges.size() && edges[end].a == edges[i].a && edges[end].b == edges[i].b;) ++end;
      if (end - i == 1 && edges[i].a != edges[i].b) unique.push_back(edges[i]);
    }
    return unique;
  }

  /// For faces of which only one edge stayed in place.
  void match_unique_edges() {
    const auto a = free_edges(from_, [&](std::uint32_t f) { return matches_[f].face == kNone; });
    const auto b = free_edges(to_, [&](std::uint32_t f) { return !taken_[f]; });
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
      const auto order = std::tie(a[i].a, a[i].b) <=> std::tie(b[j].a, b[j].b);
      if (order == 0) match_corners(a[i].corner, b[j].corner);
      i += order <= 0;
      j += order >= 0;
    }
  }

  bool match_corners(std::uint32_t from_corner, std::uint32_t to_corner) {
    return match(from_corner / 3, to_corner / 3, (to_corner % 3 + 3 - from_corner % 3) % 3);
  }

  void walk() {
    while (!front_.empty()) {
      const std::uint32_t f = front_.back();
      front_.pop_back();
      const FaceMatch m = matches_[f];
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t mine = from_opposite_[3 * f + i], theirs = to_opposite_[3 * m.face + (i + m.turn) % 3];
        if (mine != kNone && theirs != kNone) match_corners(mine, theirs);
      }
    }
  }

  const Surface& from_;
  const Surface& to_;
  std::vector<FaceMatch> matches_;
  std::vector<bool> taken_;
  std::vector<std::uint32_t> from_opposite_, to_opposite_, front_;
  std::vector<Shape> from_shapes_, to_shapes_;
};

}  // namespace

Matching match_faces(const Surface& from, const Surface& to) { return Matcher(from, to).run(); }

}  // namespace ramcdb::detail
