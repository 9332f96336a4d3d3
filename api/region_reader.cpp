#include <fmt/format.h>

#include <algorithm>

#include "api/file_attributes.h"
#include "api/region_faces.h"
#include "api/region_file.h"
#include "api/region_match.h"
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

  [[nodiscard]] OtherMesh as_other(std::span<const std::uint64_t> ids, bool splits_vertices) const {
    return {positions, points, corners, firsts_, ids, splits_vertices};
  }
  [[nodiscard]] const std::vector<std::uint32_t>& firsts() const { return firsts_; }

 private:
  std::vector<std::uint32_t> firsts_;
};

/// Formats that cannot say it otherwise, and programs that give every face vertices of its own.
bool repeats_vertices(const mesh_file::MeshData& data) {
  if (data.repeats_vertices) return true;
  std::vector<bool> used(data.positions.size(), false);
  for (const std::uint32_t v : data.corners) {
    if (used[v]) return false;
    used[v] = true;
  }
  return true;
}

/// Which vertex of the file each region vertex is, and which corner and face each corner and face is that a file has.
struct PlacesInFile {
  std::vector<std::uint32_t> vertices, corners, faces;
};

PlacesInFile places_in(const FileMesh& file, const RegionMesh& region, const MatchedRegion& matched) {
  const RegionFaces& faces = matched.faces;
  PlacesInFile places{std::vector<std::uint32_t>(region.points.size(), kNone),
                      std::vector<std::uint32_t>(faces.vertices().size()), std::vector<std::uint32_t>(faces.count())};
  for (const RegionMatch::Vertex& v : matched.match.vertices) places.vertices[v.region] = v.other;
  for (std::uint32_t g = 0; g < matched.match.faces.size(); ++g) {
    const FaceMatch found = matched.match.faces[g];
    const std::uint32_t size = file.firsts()[g + 1] - file.firsts()[g];
    places.faces[found.face] = g;
    for (std::uint32_t i = 0; i < size; ++i)
      places.corners[faces.firsts()[found.face] + (i + found.turn) % size] = file.firsts()[g] + i;
  }
  return places;
}

std::string place(const Lattice& lattice, LatticePoint p) {
  const Point q = lattice.position(p);
  return fmt::format("near {:.9g},{:.9g},{:.9g}", q.x, q.y, q.z);
}

/// Throws with a place of the region whose faces changed.
void refuse_other_connectivity(const RegionMesh& region, const MatchedRegion& matched, const Lattice& lattice) {
  const RegionMatch& match = matched.match;
  if (match.same_connectivity()) return;
  std::vector<bool> survives(matched.faces.count(), false);
  for (const FaceMatch& found : match.faces)
    if (found.face != kNone) survives[found.face] = true;
  const auto gone = static_cast<std::size_t>(std::ranges::find(survives, false) - survives.begin());
  const std::string where = gone < survives.size()
                                ? place(lattice, region.points[matched.faces.vertices()[matched.faces.firsts()[gone]]])
                                : "";
  throw Error(Errc::invalid_argument,
              fmt::format("{} of {} faces and {} of {} vertices of the region are not in the file, which has {} faces",
                          match.faces_gone, matched.faces.count(), match.vertices_gone, region.points.size(),
                          match.faces.size()),
              where, kHowToGoOn);
}

std::vector<VertexMove> moves_of(const Snapshot::Impl& at, const RegionMesh& region, const FileMesh& file,
                                 const PlacesInFile& places) {
  std::vector<VertexMove> moves;
  for (std::uint32_t v = 0; v < region.points.size(); ++v) {
    if (places.vertices[v] == kNone) continue;
    if (auto move = move_to(at, region, v, file.positions[places.vertices[v]])) moves.push_back(*move);
  }
  return moves;
}

}  // namespace

FileEdit edit_in_file(const Snapshot::Impl& at, const RegionMesh& region, const mesh_file::MeshData& data,
                      const Point& local_origin, bool trust_ids) {
  const FileMesh file(data, at.record(), local_origin);
  const std::span<const std::uint64_t> ids = trust_ids ? data.vertex_ids : std::span<const std::uint64_t>();
  const MatchedRegion matched = match_region(region, file.as_other(ids, repeats_vertices(data)));
  refuse_other_connectivity(region, matched, at.record().lattice);
  const PlacesInFile places = places_in(file, region, matched);
  FileEdit edit;
  edit.moves = moves_of(at, region, file, places);
  if (!region.attributes.empty() && !data.attributes.empty())
    edit.attributes = attributes_in_file(region, matched.faces, data, {places.vertices, places.corners, places.faces});
  return edit;
}

}  // namespace ramcdb::detail
