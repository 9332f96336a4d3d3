#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "api/face_matching.h"
#include "api/region_file.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

constexpr std::string_view kHowToGoOn =
    "only vertices may move here: undo what added, removed or joined faces or vertices";

/// A file's mesh on the lattice.
struct FileMesh {
  std::vector<LatticePoint> points;
  std::vector<Triangle> faces;
};

FileMesh snap_file(const mesh_file::MeshData& data, const Lattice& lattice, const Point& origin) {
  FileMesh mesh;
  mesh.points.reserve(data.positions.size());
  for (const Point& p : data.positions)
    mesh.points.push_back(lattice.snap({p.x + origin.x, p.y + origin.y, p.z + origin.z}));
  for (std::size_t c = 0; c + 2 < data.corners.size(); c += 3)
    mesh.faces.push_back({data.corners[c], data.corners[c + 1], data.corners[c + 2]});
  return mesh;
}

std::string place(const Lattice& lattice, LatticePoint p) {
  const Point q = lattice.position(p);
  return fmt::format("near {:.9g},{:.9g},{:.9g}", q.x, q.y, q.z);
}

/// New point of every region vertex, or none while it is not known.
class Targets {
 public:
  explicit Targets(const RegionMesh& region) : to_(region.points.size()), known_(region.points.size(), false) {}

  /// False when the vertex was told another point before: the file tore it apart.
  bool set(std::uint32_t vertex, LatticePoint point) {
    if (known_[vertex]) return to_[vertex] == point;
    to_[vertex] = point;
    return known_[vertex] = true;
  }
  [[nodiscard]] bool known(std::uint32_t vertex) const { return known_[vertex]; }
  [[nodiscard]] LatticePoint of(std::uint32_t vertex) const { return to_[vertex]; }

 private:
  std::vector<LatticePoint> to_;
  std::vector<bool> known_;
};

std::vector<VertexMove> moves_of(const RegionMesh& region, const Targets& targets) {
  std::vector<VertexMove> moves;
  for (std::uint32_t v = 0; v < region.points.size(); ++v)
    if (targets.known(v) && targets.of(v) != region.points[v])
      moves.push_back({region.keys[v], region.points[v], targets.of(v)});
  return moves;
}

/// The file still numbers vertices and faces as it was written.
std::optional<Targets> match_by_order(const RegionMesh& region, const FileMesh& file) {
  if (file.points.size() != region.points.size() || file.faces != region.faces) return std::nullopt;
  Targets targets(region);
  for (std::uint32_t v = 0; v < file.points.size(); ++v) targets.set(v, file.points[v]);
  return targets;
}

std::vector<Triangle> normalized(std::vector<Triangle> faces) {
  for (Triangle& t : faces) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// The file kept the vertex ids: every vertex says who it is, and the faces must be the region's.
std::optional<Targets> match_by_ids(const RegionMesh& region, const FileMesh& file,
                                    const std::vector<std::uint64_t>& ids) {
  if (ids.size() != file.points.size() || ids.size() != region.points.size()) return std::nullopt;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of;
  for (std::uint32_t v = 0; v < region.keys.size(); ++v) vertex_of.emplace(region.keys[v].packed(), v);
  std::vector<std::uint32_t> region_vertex;
  Targets targets(region);
  for (std::size_t v = 0; v < ids.size(); ++v) {
    const auto it = vertex_of.find(ids[v]);
    if (it == vertex_of.end() || !targets.set(it->second, file.points[v])) return std::nullopt;
    region_vertex.push_back(it->second);
  }
  std::vector<Triangle> faces = file.faces;
  for (Triangle& t : faces)
    for (std::uint32_t& v : t) v = region_vertex[v];
  if (normalized(std::move(faces)) != normalized(region.faces)) return std::nullopt;
  return targets;
}

std::vector<std::uint32_t> isolated_vertices(std::size_t vertices, const std::vector<Triangle>& faces) {
  std::vector<bool> used(vertices, false);
  for (const Triangle& t : faces)
    for (const std::uint32_t v : t) used[v] = true;
  std::vector<std::uint32_t> isolated;
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (!used[v]) isolated.push_back(v);
  return isolated;
}

/// Isolated vertices stay where the file has one in their place; the others are paired in order of position. A file
/// without any (STL, say) leaves them as they are.
void match_isolated(const RegionMesh& region, const FileMesh& file, Targets& targets) {
  auto mine = isolated_vertices(region.points.size(), region.faces);
  auto theirs = isolated_vertices(file.points.size(), file.faces);
  if (theirs.empty()) return;
  if (mine.size() != theirs.size())
    throw Error(Errc::invalid_argument,
                fmt::format("the file has {} isolated vertices, the region {}", theirs.size(), mine.size()), {},
                kHowToGoOn);
  const auto by_position = [](const std::vector<LatticePoint>& points) {
    return [&points](std::uint32_t a, std::uint32_t b) { return std::tie(points[a], a) < std::tie(points[b], b); };
  };
  std::sort(mine.begin(), mine.end(), by_position(region.points));
  std::sort(theirs.begin(), theirs.end(), by_position(file.points));
  std::vector<std::uint32_t> mine_left, theirs_left;
  std::size_t i = 0, j = 0;
  while (i < mine.size() || j < theirs.size()) {
    if (j == theirs.size() || (i < mine.size() && region.points[mine[i]] < file.points[theirs[j]]))
      mine_left.push_back(mine[i++]);
    else if (i == mine.size() || file.points[theirs[j]] < region.points[mine[i]])
      theirs_left.push_back(theirs[j++]);
    else
      ++i, ++j;
  }
  for (std::size_t k = 0; k < mine_left.size(); ++k) targets.set(mine_left[k], file.points[theirs_left[k]]);
}

/// Any order, any numbering: by lattice positions and connectivity.
Targets match_by_geometry(const RegionMesh& region, const FileMesh& file, const Lattice& lattice) {
  const Matching matching = match_faces({region.points, region.faces}, {file.points, file.faces});
  if (matching.unmatched)
    throw Error(
        Errc::invalid_argument,
        fmt::format("{} of {} faces of the region are not in the file", matching.unmatched, region.faces.size()),
        place(lattice, region.points[region.faces[matching.first_unmatched][0]]), kHowToGoOn);
  Targets targets(region);
  for (std::uint32_t f = 0; f < region.faces.size(); ++f) {
    const FaceMatch match = matching.matches[f];
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t v = region.faces[f][i];
      if (!targets.set(v, file.points[file.faces[match.face][(i + match.turn) % 3]]))
        throw Error(Errc::invalid_argument, "the file connects faces differently than the region",
                    place(lattice, region.points[v]), kHowToGoOn);
    }
  }
  match_isolated(region, file, targets);
  return targets;
}

}  // namespace

std::vector<VertexMove> moves_in_file(const RegionMesh& region, const Lattice& lattice, mesh_file::MeshData& data,
                                      const Point& local_origin, bool trust_ids) {
  mesh_file::triangulate(data);
  const FileMesh file = snap_file(data, lattice, local_origin);
  if (file.faces.size() != region.faces.size())
    throw Error(Errc::invalid_argument,
                fmt::format("the file has {} triangles, the region {}", file.faces.size(), region.faces.size()), {},
                kHowToGoOn);
  if (trust_ids)
    if (const auto targets = match_by_ids(region, file, data.vertex_ids)) return moves_of(region, *targets);
  const auto ordered = match_by_order(region, file);
  if (!ordered) return moves_of(region, match_by_geometry(region, file, lattice));
  // Most vertices in new places: moved, or a numbering that is the old one by chance? The fewer moves tell.
  std::vector<VertexMove> moves = moves_of(region, *ordered);
  if (moves.size() * 2 <= region.points.size()) return moves;
  try {
    std::vector<VertexMove> fewer = moves_of(region, match_by_geometry(region, file, lattice));
    return fewer.size() < moves.size() ? fewer : moves;
  } catch (const Error&) {
    return moves;
  }
}

}  // namespace ramcdb::detail
