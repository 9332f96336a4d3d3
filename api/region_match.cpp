#include "api/region_match.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "api/region_mesh.h"
#include "api/welded_surface.h"

namespace ramcdb::detail {
namespace {

/// The vertex of the region that each id names.
std::vector<std::uint32_t> vertices_named(const RegionMesh& region, std::span<const std::uint64_t> ids) {
  if (ids.empty()) return {};
  std::vector<std::uint64_t> keys;
  for (const VertexKey& key : region.keys) keys.push_back(hash_of(key.packed(), 0));
  const HashIndex index(std::move(keys));
  std::vector<std::uint32_t> named;
  for (const std::uint64_t id : ids) {
    std::uint32_t v = index.first(hash_of(id, 0));
    while (v != kNowhere && region.keys[v].packed() != id) v = index.after(v);
    named.push_back(v);
  }
  return named;
}

std::vector<std::uint32_t> isolated_vertices(std::size_t vertices, std::span<const std::uint32_t> corners) {
  std::vector<bool> used(vertices, false);
  for (const std::uint32_t v : corners) used[v] = true;
  std::vector<std::uint32_t> isolated;
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (!used[v]) isolated.push_back(v);
  return isolated;
}

/// What is known of a vertex of the other mesh: the vertex of the region that it is, or kNowhere; and if it is new, the
/// number of the new vertex.
struct Found {
  std::vector<std::uint32_t> region_vertex, fresh;
  std::vector<FaceMatch> faces;
};

/// Vertices of both meshes that lie on one point are one while they are matched: which of the region's they are, the
/// faces say that survive.
class WeldedMatch {
 public:
  WeldedMatch(const Surface& region, const Surface& other)
      : region_(region), other_(other), mine_(weld_by_place(region)), theirs_(weld_by_place(other)) {}

  Found run() {
    SurfaceMatch match = match_surfaces(mine_.surface(), theirs_.surface());
    found_.region_vertex.assign(other_.points.size(), kNowhere);
    found_.faces = std::move(match.faces);
    vertices_of_faces();
    remaining_vertices(match.vertices);
    drop_joined_faces();
    found_.fresh = std::move(theirs_.node);
    return std::move(found_);
  }

 private:
  /// The vertex of the region at a corner of a face that survives.
  [[nodiscard]] std::uint32_t vertex_at(FaceMatch match, std::uint32_t i) const {
    return region_.corners[region_.corner(match.face, i + match.turn)];
  }

  void vertices_of_faces() {
    for (std::uint32_t g = 0; g < found_.faces.size(); ++g) {
      if (found_.faces[g].face == FaceMatch::kNone) continue;
      for (std::uint32_t i = 0; i < other_.size(g); ++i) {
        std::uint32_t& v = found_.region_vertex[other_.corners[other_.corner(g, i)]];
        if (v == kNowhere) v = vertex_at(found_.faces[g], i);
      }
    }
  }

  /// Vertices of new faces only: they are the vertex that lies there, of several the first that survives.
  void remaining_vertices(const VertexPairs& pairs) {
    std::vector<std::uint32_t> at(mine_.points.size(), kNowhere);
    for (const std::uint32_t v : found_.region_vertex)
      if (v != kNowhere) at[mine_.node[v]] = std::min(at[mine_.node[v]], v);
    std::vector<std::uint32_t> first(mine_.points.size(), kNowhere);
    for (const std::uint32_t v : region_.corners) first[mine_.node[v]] = std::min(first[mine_.node[v]], v);
    for (const std::uint32_t w : other_.corners) {
      const std::uint32_t node = pairs.from(theirs_.node[w]);
      if (found_.region_vertex[w] == kNowhere && node != kNowhere)
        found_.region_vertex[w] = at[node] != kNowhere ? at[node] : first[node];
    }
  }

  /// The other mesh may have joined vertices, which then are the first of them only.
  void drop_joined_faces() {
    for (std::uint32_t g = 0; g < found_.faces.size(); ++g)
      for (std::uint32_t i = 0; found_.faces[g].face != FaceMatch::kNone && i < other_.size(g); ++i)
        if (found_.region_vertex[other_.corners[other_.corner(g, i)]] != vertex_at(found_.faces[g], i))
          found_.faces[g] = {};
  }

  Surface region_, other_;
  WeldedSurface mine_, theirs_;
  Found found_;
};

/// Vertices with equal ids on one point are one; so are those on one point that have none.
Found match_joined(const Surface& region, const WeldedSurface& joined, std::span<const std::uint32_t> named) {
  std::vector<std::uint32_t> ids(named.empty() ? 0 : joined.points.size(), kNowhere);
  for (std::size_t w = 0; w < named.size(); ++w) ids[joined.node[w]] = named[w];
  SurfaceMatch match = match_surfaces(region, joined.surface(), std::move(ids));
  Found found{{}, joined.node, std::move(match.faces)};
  for (const std::uint32_t node : joined.node) found.region_vertex.push_back(match.vertices.from(node));
  return found;
}

Found match_kept_apart(const Surface& region, const Surface& other, std::span<const std::uint32_t> named,
                       std::span<const std::uint32_t> known) {
  SurfaceMatch match = match_surfaces(region, other, {named.begin(), named.end()}, known);
  Found found{std::vector<std::uint32_t>(other.points.size()), std::vector<std::uint32_t>(other.points.size()),
              std::move(match.faces)};
  for (std::uint32_t w = 0; w < other.points.size(); ++w) {
    found.region_vertex[w] = match.vertices.from(w);
    found.fresh[w] = w;
  }
  return found;
}

/// A file that splits vertices but kept their ids tells those apart that lie on one point.
Found match(const Surface& region, const OtherMesh& other, std::span<const std::uint32_t> named) {
  if (!other.splits_vertices) return match_kept_apart(region, other.surface(), named, other.known);
  const auto known =
      static_cast<std::size_t>(named.size()) - static_cast<std::size_t>(std::ranges::count(named, kNowhere));
  if (known * 2 > other.points.size()) return match_joined(region, weld_by_place(other.surface(), named), named);
  return WeldedMatch(region, other.surface()).run();
}

auto by_position(std::span<const LatticePoint> points) {
  return [points](std::uint32_t a, std::uint32_t b) { return std::tie(points[a], a) < std::tie(points[b], b); };
}

/// Pairs vertices without faces: by their ids, by their places, also where one has got its first or lost its last face,
/// and if as many are left on either side, in order of position.
class IsolatedVertices {
 public:
  IsolatedVertices(const RegionMesh& region, const RegionFaces& faces, const OtherMesh& other, Found& found)
      : region_(region),
        other_(other),
        found_(found),
        mine_(isolated_vertices(region.points.size(), faces.vertices())),
        theirs_(isolated_vertices(other.points.size(), other.corners)),
        none_at_all_(theirs_.empty()),
        taken_(region.points.size(), false) {
    for (const std::uint32_t v : found.region_vertex)
      if (v != kNowhere) taken_[v] = true;
    drop_paired();
  }

  void pair(const std::vector<std::uint32_t>& named) {
    pair_in_place(mine_, untaken_of_other());
    drop_paired();
    if (none_at_all_) return;
    for (const std::uint32_t w : theirs_)
      if (!named.empty() && named[w] != kNowhere && !taken_[named[w]]) pair(named[w], w);
    drop_paired();
    pair_in_place(untaken_of_region(), theirs_);
    drop_paired();
    std::ranges::sort(mine_, by_position(region_.points));
    std::ranges::sort(theirs_, by_position(other_.points));
    if (mine_.size() != theirs_.size()) return;
    for (std::size_t i = 0; i < mine_.size(); ++i) pair(mine_[i], theirs_[i]);
    if (mine_.size() > 1) guessed_ = mine_;
  }
  [[nodiscard]] std::vector<std::uint32_t> guessed() const { return guessed_; }
  /// Those that stay because the other mesh cannot say anything of them.
  [[nodiscard]] std::span<const std::uint32_t> untold() const {
    return none_at_all_ ? std::span<const std::uint32_t>(mine_) : std::span<const std::uint32_t>();
  }

 private:
  void pair(std::uint32_t v, std::uint32_t w) {
    found_.region_vertex[w] = v;
    taken_[v] = true;
  }

  void drop_paired() {
    std::erase_if(mine_, [&](std::uint32_t v) { return taken_[v]; });
    std::erase_if(theirs_, [&](std::uint32_t w) { return found_.region_vertex[w] != kNowhere; });
  }

  [[nodiscard]] std::vector<std::uint32_t> untaken_of_region() const {
    std::vector<std::uint32_t> untaken;
    for (std::uint32_t v = 0; v < taken_.size(); ++v)
      if (!taken_[v]) untaken.push_back(v);
    return untaken;
  }
  /// The first of those that are one.
  [[nodiscard]] std::vector<std::uint32_t> untaken_of_other() const {
    std::vector<std::uint32_t> untaken;
    std::vector<bool> seen(found_.fresh.size(), false);
    for (std::uint32_t w = 0; w < found_.fresh.size(); ++w) {
      if (found_.region_vertex[w] == kNowhere && !seen[found_.fresh[w]]) untaken.push_back(w);
      seen[found_.fresh[w]] = true;
    }
    return untaken;
  }

  void pair_in_place(std::vector<std::uint32_t> mine, std::vector<std::uint32_t> theirs) {
    if (mine.empty() || theirs.empty()) return;
    std::ranges::sort(mine, by_position(region_.points));
    std::ranges::sort(theirs, by_position(other_.points));
    std::vector<std::uint32_t> of_fresh(found_.fresh.size(), kNowhere);
    for (std::size_t i = 0, j = 0; i < mine.size() && j < theirs.size();) {
      const auto order = region_.points[mine[i]] <=> other_.points[theirs[j]];
      if (order == 0) of_fresh[found_.fresh[theirs[j]]] = mine[i];
      i += order <= 0;
      j += order >= 0;
    }
    for (std::uint32_t w = 0; w < found_.fresh.size(); ++w)
      if (found_.region_vertex[w] == kNowhere && of_fresh[found_.fresh[w]] != kNowhere)
        pair(of_fresh[found_.fresh[w]], w);
  }

  const RegionMesh& region_;
  const OtherMesh& other_;
  Found& found_;
  std::vector<std::uint32_t> mine_, theirs_, guessed_;
  bool none_at_all_;
  std::vector<bool> taken_;
};

/// Lists the vertices of the edited mesh in the order in which the other mesh first has them.
RegionMatch listed(const RegionMesh& region, Found found, std::span<const std::uint32_t> untold) {
  RegionMatch match;
  std::vector<std::uint32_t> of_region(region.points.size(), kNowhere), fresh(found.fresh.size(), kNowhere);
  const auto add = [&](std::uint32_t v, std::uint32_t w) {
    match.vertices.push_back({v, w});
    return static_cast<std::uint32_t>(match.vertices.size() - 1);
  };
  for (std::uint32_t w = 0; w < found.region_vertex.size(); ++w) {
    const std::uint32_t v = found.region_vertex[w];
    std::uint32_t& at = v != kNowhere ? of_region[v] : fresh[found.fresh[w]];
    if (at == kNowhere) at = add(v, w);
    match.vertex.push_back(at);
  }
  for (const std::uint32_t v : untold) of_region[v] = add(v, kNowhere);
  match.vertices_gone = static_cast<std::uint64_t>(std::ranges::count(of_region, kNowhere));
  match.faces = std::move(found.faces);
  return match;
}

std::uint64_t surviving(const RegionMatch& match) {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(match.faces, [](const FaceMatch& m) { return m.face != FaceMatch::kNone; }));
}

}  // namespace

namespace {

/// Where the faces of a chart of a region are.
std::span<const Triangle> faces_of(const RegionMesh& region, ChartId id) {
  const auto chart = static_cast<std::uint32_t>(std::ranges::lower_bound(region.charts, id) - region.charts.begin());
  const auto begin = region.chart_of_face.begin();
  const auto [first, last] = std::equal_range(begin, region.chart_of_face.end(), chart);
  return std::span(region.faces)
      .subspan(static_cast<std::size_t>(first - begin), static_cast<std::size_t>(last - first));
}

/// The vertices of a region on edges that charts outside share: by who they are, and by where they lie, which is
/// kNowhere where several do.
struct OuterBorder {
  std::map<VertexKey, std::uint32_t> by_key;
  std::map<LatticePoint, std::uint32_t> by_place;

  explicit OuterBorder(const RegionMesh& region) {
    for (std::uint32_t v = 0; v < region.points.size(); ++v) {
      if (!region.outer_border[v]) continue;
      by_key.emplace(region.keys[v], v);
      if (const auto [at, is_first] = by_place.emplace(region.points[v], v); !is_first) at->second = kNowhere;
    }
  }
};

/// Pairs of vertices of a region and of a mesh that both are for sure, each in one pair.
class KnownVertices {
 public:
  KnownVertices(const RegionMesh& region, const RegionMesh& mesh)
      : region_(region), mesh_(mesh), known_(mesh.points.size(), kNowhere), taken_(region.points.size(), false) {}

  /// Per vertex of the mesh the region's, by charts that both hold in the same state and by what both share with charts
  /// outside: that stays where it is, though others may lie on the same point, and wires there may have been cut.
  std::vector<std::uint32_t> find(std::span<const ChartId> equal) {
    for (const ChartId id : equal) {
      const auto mine = faces_of(region_, id), theirs = faces_of(mesh_, id);
      for (std::size_t f = 0; f < theirs.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) pair(mine[f][i], theirs[f][i]);
    }
    const OuterBorder mine(region_), theirs(mesh_);
    for (const auto& [key, w] : theirs.by_key)
      if (const auto found = mine.by_key.find(key);
          found != mine.by_key.end() && region_.points[found->second] == mesh_.points[w])
        pair(found->second, w);
    for (const auto& [place, w] : theirs.by_place)
      if (const auto found = mine.by_place.find(place);
          w != kNowhere && found != mine.by_place.end() && found->second != kNowhere)
        pair(found->second, w);
    return std::move(known_);
  }

 private:
  void pair(std::uint32_t v, std::uint32_t w) {
    if (known_[w] != kNowhere || taken_[v]) return;
    known_[w] = v;
    taken_[v] = true;
  }

  const RegionMesh& region_;
  const RegionMesh& mesh_;
  std::vector<std::uint32_t> known_;
  std::vector<bool> taken_;
};

}  // namespace

bool RegionMatch::same_connectivity() const {
  return !faces_gone && !vertices_gone && surviving(*this) == faces.size() &&
         std::ranges::none_of(vertices, [](const Vertex& v) { return v.region == kNowhere; });
}

RegionMatch match_region(const RegionMesh& region, const RegionFaces& faces, const OtherMesh& other) {
  const std::vector<std::uint32_t> named = vertices_named(region, other.ids);
  Found found = match({region.points, faces.vertices(), faces.firsts()}, other, named);
  IsolatedVertices isolated(region, faces, other, found);
  isolated.pair(named);
  RegionMatch result = listed(region, std::move(found), isolated.untold());
  result.guessed = isolated.guessed();
  result.faces_gone = faces.count() - surviving(result);
  return result;
}

MatchedRegion match_region(const RegionMesh& region, const OtherMesh& other) {
  const auto matched = [&](bool as_triangles) {
    MatchedRegion result{RegionFaces(region, as_triangles), {}};
    result.match = match_region(region, result.faces, other);
    return result;
  };
  const std::size_t count = other.firsts.size() - 1;
  const bool has_polygons = other.corners.size() != 3 * count;
  if (has_polygons || region.polygon_sizes.empty()) return matched(false);
  MatchedRegion triangles = matched(true);
  if (surviving(triangles.match) == count && count == region.faces.size()) return triangles;
  MatchedRegion polygons = matched(false);
  const std::uint64_t found = surviving(triangles.match);
  return found * 2 >= count && found > surviving(polygons.match) ? std::move(triangles) : std::move(polygons);
}

RegionMatch match_region(const RegionMesh& region, const RegionMesh& mesh, const Lattice& lattice,
                         std::span<const ChartId> equal) {
  const std::vector<Point> places = positions_in(mesh, lattice);
  const TriangleCorners triangles(mesh.faces);
  const Surface surface = triangles.over(mesh.points);
  const std::vector<std::uint32_t> known = KnownVertices(region, mesh).find(equal);
  return match_region(region, RegionFaces(region, true),
                      {places, surface.points, surface.corners, surface.firsts, {}, false, known});
}

}  // namespace ramcdb::detail
