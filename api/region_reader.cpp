#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "api/face_matching.h"
#include "api/file_attributes.h"
#include "api/region_faces.h"
#include "api/region_file.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

constexpr std::string_view kHowToGoOn =
    "only vertices may move here: undo what added, removed or joined faces or vertices";

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// A file's mesh on the lattice.
class FileMesh {
 public:
  FileMesh(const mesh_file::MeshData& data, const MeshRecord& record, const Point& origin)
      : corners(data.corners), firsts_{0} {
    positions.reserve(data.positions.size());
    points.reserve(data.positions.size());
    for (const Point& p : data.positions) {
      Point q = p;
      for (int a = 0; a < 3; ++a)
        if (origin[a] != 0) q[a] += origin[a];  // -0 + 0 would be +0
      positions.push_back(record.rounded(q));
      points.push_back(record.lattice.snap(positions.back()));
    }
    for (std::size_t f = 0; f < data.face_count(); ++f)
      firsts_.push_back(firsts_.back() + (data.face_sizes.empty() ? 3 : data.face_sizes[f]));
  }

  std::vector<Point> positions;  ///< as the mesh would keep them, before its lattice
  std::vector<LatticePoint> points;
  const std::vector<std::uint32_t>& corners;

  [[nodiscard]] Surface surface() const { return {points, corners, firsts_}; }
  [[nodiscard]] const std::vector<std::uint32_t>& firsts() const { return firsts_; }
  [[nodiscard]] bool has_polygons() const { return corners.size() != 3 * (firsts_.size() - 1); }

 private:
  std::vector<std::uint32_t> firsts_;
};

/// Which vertex of the file each region vertex is, and which corner and face each corner and face is that a file has.
struct Match {
  std::vector<std::uint32_t> vertices, corners, faces;
};

std::string place(const Lattice& lattice, LatticePoint p) {
  const Point q = lattice.position(p);
  return fmt::format("near {:.9g},{:.9g},{:.9g}", q.x, q.y, q.z);
}

/// The file's vertex of every region vertex, kNone while it is not known.
class Targets {
 public:
  Targets(std::size_t vertices, const std::vector<LatticePoint>& points) : of_(vertices, kNone), points_(points) {}

  /// False when the vertex was told another point before: the file tore it apart.
  bool set(std::uint32_t vertex, std::uint32_t file_vertex) {
    if (of_[vertex] != kNone) return points_[of_[vertex]] == points_[file_vertex];
    of_[vertex] = file_vertex;
    return true;
  }
  [[nodiscard]] std::vector<std::uint32_t> take() { return std::move(of_); }

 private:
  std::vector<std::uint32_t> of_;
  const std::vector<LatticePoint>& points_;
};

std::vector<VertexMove> moves_of(const Snapshot::Impl& at, const RegionMesh& region, const FileMesh& file,
                                 const Match& match) {
  std::vector<VertexMove> moves;
  for (std::uint32_t v = 0; v < region.points.size(); ++v) {
    if (match.vertices[v] == kNone) continue;
    if (auto move = move_to(at, region, v, file.positions[match.vertices[v]])) moves.push_back(*move);
  }
  return moves;
}

std::vector<std::uint32_t> counted(std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

/// The file still numbers vertices and faces as it was written.
std::optional<Match> match_by_order(const RegionMesh& region, const RegionFaces& faces, const FileMesh& file) {
  if (file.points.size() != region.points.size() || file.corners != faces.vertices() || file.firsts() != faces.firsts())
    return std::nullopt;
  return Match{counted(file.points.size()), counted(file.corners.size()), counted(faces.count())};
}

/// A face as its vertices from the smallest sequence on.
struct NormalFace {
  std::vector<std::uint32_t> vertices;
  std::uint32_t face, turn;
};

std::vector<NormalFace> normal_faces(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> firsts) {
  std::vector<NormalFace> faces;
  for (std::uint32_t f = 0; f + 1 < firsts.size(); ++f) {
    const auto face = corners.subspan(firsts[f], firsts[f + 1] - firsts[f]);
    const auto smallest = std::min_element(face.begin(), face.end());
    std::uint32_t best = static_cast<std::uint32_t>(smallest - face.begin());
    for (std::uint32_t turn = best + 1; turn < face.size(); ++turn)
      if (face[turn] == *smallest &&
          std::lexicographical_compare(face.begin() + turn, face.end(), face.begin() + best, face.end()))
        best = turn;
    NormalFace normal{{}, f, best};
    for (std::size_t i = 0; i < face.size(); ++i) normal.vertices.push_back(face[(i + best) % face.size()]);
    faces.push_back(std::move(normal));
  }
  std::sort(faces.begin(), faces.end(), [](const NormalFace& a, const NormalFace& b) {
    return std::tie(a.vertices, a.face) < std::tie(b.vertices, b.face);
  });
  return faces;
}

/// The file kept the vertex ids: every vertex says who it is, and the faces must be the region's.
std::optional<Match> match_by_ids(const RegionMesh& region, const RegionFaces& faces, const FileMesh& file,
                                  const std::vector<std::uint64_t>& ids) {
  if (ids.size() != file.points.size() || ids.size() != region.points.size()) return std::nullopt;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of;
  for (std::uint32_t v = 0; v < region.keys.size(); ++v) vertex_of.emplace(region.keys[v].packed(), v);
  std::vector<std::uint32_t> region_vertex;
  Targets targets(region.points.size(), file.points);
  for (std::uint32_t v = 0; v < ids.size(); ++v) {
    const auto it = vertex_of.find(ids[v]);
    if (it == vertex_of.end() || !targets.set(it->second, v)) return std::nullopt;
    region_vertex.push_back(it->second);
  }
  std::vector<std::uint32_t> corners;
  for (const std::uint32_t v : file.corners) corners.push_back(region_vertex[v]);
  const auto theirs = normal_faces(corners, file.firsts()), mine = normal_faces(faces.vertices(), faces.firsts());
  if (theirs.size() != mine.size()) return std::nullopt;
  Match match{targets.take(), std::vector<std::uint32_t>(faces.vertices().size()),
              std::vector<std::uint32_t>(mine.size())};
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (mine[i].vertices != theirs[i].vertices) return std::nullopt;
    match.faces[mine[i].face] = theirs[i].face;
    const auto size = static_cast<std::uint32_t>(mine[i].vertices.size());
    for (std::uint32_t k = 0; k < size; ++k)
      match.corners[faces.firsts()[mine[i].face] + (mine[i].turn + k) % size] =
          file.firsts()[theirs[i].face] + (theirs[i].turn + k) % size;
  }
  return match;
}

std::vector<std::uint32_t> isolated_vertices(std::size_t vertices, const std::vector<std::uint32_t>& corners) {
  std::vector<bool> used(vertices, false);
  for (const std::uint32_t v : corners) used[v] = true;
  std::vector<std::uint32_t> isolated;
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (!used[v]) isolated.push_back(v);
  return isolated;
}

/// Isolated vertices stay where the file has one in their place; the others are paired in order of position. A file
/// without any (STL, say) leaves them as they are.
void match_isolated(const RegionMesh& region, const RegionFaces& faces, const FileMesh& file, Targets& targets) {
  auto mine = isolated_vertices(region.points.size(), faces.vertices());
  auto theirs = isolated_vertices(file.points.size(), file.corners);
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
      targets.set(mine[i++], theirs[j++]);
  }
  for (std::size_t k = 0; k < mine_left.size(); ++k) targets.set(mine_left[k], theirs_left[k]);
}

/// Any order, any numbering: by lattice positions and connectivity.
Match match_by_geometry(const RegionMesh& region, const RegionFaces& faces, const FileMesh& file,
                        const Lattice& lattice) {
  const Surface mine{region.points, faces.vertices(), faces.firsts()}, theirs = file.surface();
  const Matching matching = match_faces(mine, theirs);
  if (matching.unmatched)
    throw Error(Errc::invalid_argument,
                fmt::format("{} of {} faces of the region are not in the file", matching.unmatched, faces.count()),
                place(lattice, mine.point(matching.first_unmatched, 0)), kHowToGoOn);
  Targets targets(region.points.size(), file.points);
  Match match;
  match.corners.resize(faces.vertices().size());
  for (std::uint32_t f = 0; f < faces.count(); ++f) {
    const FaceMatch found = matching.matches[f];
    match.faces.push_back(found.face);
    for (std::uint32_t i = 0; i < mine.size(f); ++i) {
      const std::uint32_t corner = mine.corner(f, i), other = theirs.corner(found.face, i + found.turn);
      match.corners[corner] = other;
      const std::uint32_t v = faces.vertices()[corner];
      if (!targets.set(v, file.corners[other]))
        throw Error(Errc::invalid_argument, "the file connects faces differently than the region",
                    place(lattice, region.points[v]), kHowToGoOn);
    }
  }
  match_isolated(region, faces, file, targets);
  match.vertices = targets.take();
  return match;
}

Match match_file(const Snapshot::Impl& at, const RegionMesh& region, const RegionFaces& faces, const FileMesh& file,
                 const std::vector<std::uint64_t>& ids) {
  const Lattice& lattice = at.record().lattice;
  if (!ids.empty())
    if (auto match = match_by_ids(region, faces, file, ids)) return *std::move(match);
  auto ordered = match_by_order(region, faces, file);
  if (!ordered) return match_by_geometry(region, faces, file, lattice);
  // Most vertices in new places: moved, or a numbering that is the old one by chance? The fewer moves tell.
  const std::size_t moves = moves_of(at, region, file, *ordered).size();
  if (moves * 2 <= region.points.size()) return *std::move(ordered);
  try {
    Match match = match_by_geometry(region, faces, file, lattice);
    return moves_of(at, region, file, match).size() < moves ? match : *std::move(ordered);
  } catch (const Error&) {
    return *std::move(ordered);
  }
}

}  // namespace

FileEdit edit_in_file(const Snapshot::Impl& at, const RegionMesh& region, const mesh_file::MeshData& data,
                      const Point& local_origin, bool trust_ids) {
  const FileMesh file(data, at.record(), local_origin);
  const RegionFaces faces(region, !file.has_polygons() && data.face_count() == region.faces.size());
  if (data.face_count() != faces.count())
    throw Error(Errc::invalid_argument,
                fmt::format("the file has {} faces, the region {}", data.face_count(), faces.count()), {}, kHowToGoOn);
  const Match match = match_file(at, region, faces, file, trust_ids ? data.vertex_ids : std::vector<std::uint64_t>{});
  FileEdit edit;
  edit.moves = moves_of(at, region, file, match);
  if (!region.attributes.empty() && !data.attributes.empty())
    edit.attributes = attributes_in_file(region, faces, data, {match.vertices, match.corners, match.faces});
  return edit;
}

}  // namespace ramcdb::detail
