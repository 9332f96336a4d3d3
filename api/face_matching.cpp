#include "api/face_matching.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace ramcdb::detail {
namespace {

constexpr std::uint32_t kNone = FaceMatch::kNone;

/// A face, begun at its smallest sequence of positions.
struct Shape {
  std::uint32_t face = 0;
  std::uint32_t turn = 0;
};

/// Compares two faces corner by corner from their turns on; larger faces are greater.
int compare(const Surface& s, Shape a, const Surface& t, Shape b) {
  const std::uint32_t size = s.size(a.face), other = t.size(b.face);
  if (size != other) return size < other ? -1 : 1;
  for (std::uint32_t i = 0; i < size; ++i) {
    const auto order = s.point(a.face, a.turn + i) <=> t.point(b.face, b.turn + i);
    if (order != 0) return order < 0 ? -1 : 1;
  }
  return 0;
}

Shape shape_of(const Surface& s, std::uint32_t face) {
  Shape best{face, 0};
  for (std::uint32_t turn = 1; turn < s.size(face); ++turn)
    if (compare(s, {face, turn}, s, best) < 0) best.turn = turn;
  return best;
}

std::vector<Shape> sorted_shapes(const Surface& s) {
  std::vector<Shape> shapes(s.face_count());
  for (std::uint32_t f = 0; f < shapes.size(); ++f) shapes[f] = shape_of(s, f);
  std::sort(shapes.begin(), shapes.end(), [&](Shape a, Shape b) {
    const int order = compare(s, a, s, b);
    return order != 0 ? order < 0 : a.face < b.face;
  });
  return shapes;
}

/// Corner -> face and following corner.
struct CornerMap {
  std::vector<std::uint32_t> face, next;

  explicit CornerMap(const Surface& s) {
    for (std::uint32_t f = 0; f < s.face_count(); ++f)
      for (std::uint32_t i = 0; i < s.size(f); ++i) {
        face.push_back(f);
        next.push_back(s.corner(f, i + 1));
      }
  }
};

/// The directed edge from a corner to the next one of its face, by vertices.
struct Edge {
  std::uint32_t a, b, corner;
};

/// For every directed edge the corner of the one face that passes it the other way; kNone on borders and wherever more
/// than two faces meet.
std::vector<std::uint32_t> opposite_corners(const CornerMap& map, std::span<const std::uint32_t> vertices) {
  std::vector<Edge> edges;
  edges.reserve(vertices.size());
  for (std::uint32_t c = 0; c < vertices.size(); ++c) {
    const std::uint32_t a = vertices[c], b = vertices[map.next[c]];
    edges.push_back({std::min(a, b), std::max(a, b), c});
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& x, const Edge& y) { return std::tie(x.a, x.b, x.corner) < std::tie(y.a, y.b, y.corner); });
  std::vector<std::uint32_t> opposite(edges.size(), kNone);
  for (std::size_t i = 0, end; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end].a == edges[i].a && edges[end].b == edges[i].b;) ++end;
    if (end - i != 2 || vertices[edges[i].corner] == vertices[edges[i + 1].corner]) continue;
    opposite[edges[i].corner] = edges[i + 1].corner;
    opposite[edges[i + 1].corner] = edges[i].corner;
  }
  return opposite;
}

/// Corners with one vertex per position, so that a soup has neighbours too.
std::vector<std::uint32_t> welded_corners(const Surface& s) {
  std::vector<std::uint32_t> order(s.points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::tie(s.points[a], a) < std::tie(s.points[b], b); });
  std::vector<std::uint32_t> representative(s.points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    representative[order[i]] =
        i && s.points[order[i]] == s.points[order[i - 1]] ? representative[order[i - 1]] : order[i];
  std::vector<std::uint32_t> corners(s.corners.begin(), s.corners.end());
  for (std::uint32_t& v : corners) v = representative[v];
  return corners;
}

class Matcher {
 public:
  Matcher(const Surface& from, const Surface& to)
      : from_(from),
        to_(to),
        from_map_(from),
        to_map_(to),
        matches_(from.face_count()),
        taken_(to.face_count(), false) {}

  Matching run() {
    from_opposite_ = opposites_of(from_, from_map_);
    to_opposite_ = opposites_of(to_, to_map_);
    match_unique_shapes();
    walk();
    match_edges();
    walk();
    match_equal_shapes(from_);
    walk();
    match_moved_shapes();
    Matching result;
    for (std::uint32_t f = 0; f < matches_.size(); ++f)
      if (matches_[f].face == kNone && result.unmatched++ == 0) result.first_unmatched = f;
    result.matches = std::move(matches_);
    return result;
  }

 private:
  /// Neighbours by vertices; where vertices have none, by positions.
  static std::vector<std::uint32_t> opposites_of(const Surface& s, const CornerMap& map) {
    std::vector<std::uint32_t> opposite = opposite_corners(map, s.corners);
    const std::vector<std::uint32_t> by_position = opposite_corners(map, welded_corners(s));
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
    if (matches_[f].face != kNone || taken_[g] || from_.size(f) != to_.size(g)) return false;
    matches_[f] = {g, turn};
    taken_[g] = true;
    front_.push_back(f);
    return true;
  }

  void match_shapes(Shape a, Shape b) {
    const std::uint32_t size = from_.size(a.face);
    if (to_.size(b.face) != size) return;
    match(a.face, b.face, (b.turn + size - a.turn) % size);
  }

  /// Calls `group` with each run of equal shapes, [begin, end) in either list, where both have some.
  /// \param from as `from_`, with the same points or others
  template <class Visit>
  void for_equal(const Surface& from, Visit&& group) const {
    const std::vector<Shape>&a = from_shapes_, &b = to_shapes_;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
      const int order = compare(from, a[i], to_, b[j]);
      if (order < 0) {
        ++i;
      } else if (order > 0) {
        ++j;
      } else {
        std::size_t i_end = i, j_end = j;
        while (i_end < a.size() && compare(from, a[i_end], from, a[i]) == 0) ++i_end;
        while (j_end < b.size() && compare(to_, b[j_end], to_, b[j]) == 0) ++j_end;
        group(i, i_end, j, j_end);
        i = i_end;
        j = j_end;
      }
    }
  }

  void match_unique_shapes() {
    from_shapes_ = sorted_shapes(from_);
    to_shapes_ = sorted_shapes(to_);
    for_equal(from_, [&](std::size_t i, std::size_t i_end, std::size_t j, std::size_t j_end) {
      if (i_end - i == 1 && j_end - j == 1 && begins_once(from_shapes_[i]))
        match_shapes(from_shapes_[i], to_shapes_[j]);
    });
  }

  /// Whether the smallest sequence of a face begins at one of its corners only.
  [[nodiscard]] bool begins_once(Shape shape) const {
    for (std::uint32_t turn = 1; turn < from_.size(shape.face); ++turn)
      if (compare(from_, {shape.face, shape.turn + turn}, from_, shape) == 0) return false;
    return true;
  }

  /// What is left of several faces in one place: they are alike, any pairing gives the same surface.
  void match_equal_shapes(const Surface& from) {
    for_equal(from, [&](std::size_t i, std::size_t i_end, std::size_t j, std::size_t j_end) {
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

  /// Faces without an edge that stayed, as degenerate ones at a vertex that moved: they are where the faces around say
  /// that their vertices went.
  void match_moved_shapes() {
    if (std::ranges::none_of(matches_, [](const FaceMatch& m) { return m.face == kNone; })) return;
    std::vector<LatticePoint> points(from_.points.begin(), from_.points.end());
    for (std::uint32_t f = 0; f < matches_.size(); ++f)
      for (std::uint32_t i = 0; matches_[f].face != kNone && i < from_.size(f); ++i)
        points[from_.corners[from_.corner(f, i)]] = to_.point(matches_[f].face, i + matches_[f].turn);
    const Surface moved{points, from_.corners, from_.firsts};
    from_shapes_ = sorted_shapes(moved);
    match_equal_shapes(moved);
  }

  /// A face, begun at the corner of an edge that lies at a, b.
  struct PlacedEdge {
    LatticePoint a, b;
    Shape face;
  };
  /// Faces that lie at the same edge and are alike, [begin, end) of a list.
  struct AlikeEdges {
    std::size_t begin, end;
  };

  template <class IsFree>
  static std::vector<PlacedEdge> free_edges(const Surface& s, IsFree&& is_free) {
    std::vector<PlacedEdge> edges;
    for (std::uint32_t f = 0; f < s.face_count(); ++f)
      for (std::uint32_t i = 0; is_free(f) && i < s.size(f); ++i)
        edges.push_back({s.point(f, i), s.point(f, i + 1), {f, i}});
    std::sort(edges.begin(), edges.end(), [](const PlacedEdge& x, const PlacedEdge& y) {
      return std::tie(x.a, x.b, x.face.face, x.face.turn) < std::tie(y.a, y.b, y.face.face, y.face.turn);
    });
    return edges;
  }

  /// An edge where several different faces lie says nothing.
  static std::vector<AlikeEdges> alike_edges(const Surface& s, const std::vector<PlacedEdge>& edges) {
    std::vector<AlikeEdges> alike;
    for (std::size_t i = 0, end; i < edges.size(); i = end) {
      bool all_alike = edges[i].a != edges[i].b;
      for (end = i; end < edges.size() && edges[end].a == edges[i].a && edges[end].b == edges[i].b; ++end)
        all_alike = all_alike && compare(s, edges[i].face, s, edges[end].face) == 0;
      if (all_alike) alike.push_back({i, end});
    }
    return alike;
  }

  /// For faces of which only one edge stayed in place.
  void match_edges() {
    const auto mine = free_edges(from_, [&](std::uint32_t f) { return matches_[f].face == kNone; });
    const auto theirs = free_edges(to_, [&](std::uint32_t f) { return !taken_[f]; });
    const auto a = alike_edges(from_, mine), b = alike_edges(to_, theirs);
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
      const PlacedEdge &x = mine[a[i].begin], &y = theirs[b[j].begin];
      const auto order = std::tie(x.a, x.b) <=> std::tie(y.a, y.b);
      if (order == 0 && a[i].end - a[i].begin == b[j].end - b[j].begin)
        for (std::size_t k = 0; k < a[i].end - a[i].begin; ++k)
          match_shapes(mine[a[i].begin + k].face, theirs[b[j].begin + k].face);
      i += order <= 0;
      j += order >= 0;
    }
  }

  bool match_corners(std::uint32_t from_corner, std::uint32_t to_corner) {
    const std::uint32_t f = from_map_.face[from_corner], g = to_map_.face[to_corner], size = to_.size(g);
    if (from_.size(f) != size) return false;
    return match(f, g, (to_corner - to_.firsts[g] + size - (from_corner - from_.firsts[f])) % size);
  }

  void walk() {
    while (!front_.empty()) {
      const std::uint32_t f = front_.back();
      front_.pop_back();
      const FaceMatch m = matches_[f];
      for (std::uint32_t i = 0; i < from_.size(f); ++i) {
        const std::uint32_t mine = from_opposite_[from_.corner(f, i)];
        const std::uint32_t theirs = to_opposite_[to_.corner(m.face, i + m.turn)];
        if (mine != kNone && theirs != kNone) match_corners(mine, theirs);
      }
    }
  }

  const Surface& from_;
  const Surface& to_;
  CornerMap from_map_, to_map_;
  std::vector<FaceMatch> matches_;
  std::vector<bool> taken_;
  std::vector<std::uint32_t> from_opposite_, to_opposite_, front_;
  std::vector<Shape> from_shapes_, to_shapes_;
};

}  // namespace

TriangleCorners::TriangleCorners(std::span<const Triangle> faces) : firsts_{0} {
  corners_.reserve(3 * faces.size());
  for (const Triangle& t : faces) {
    corners_.insert(corners_.end(), t.begin(), t.end());
    firsts_.push_back(static_cast<std::uint32_t>(corners_.size()));
  }
}

Matching match_faces(const Surface& from, const Surface& to) { return Matcher(from, to).run(); }

}  // namespace ramcdb::detail
