#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "api/border_snap.h"
#include "api/edited_region_builder.h"
#include "api/file_attributes.h"
#include "api/file_frame.h"
#include "api/mesh_file/triangulate.h"
#include "api/region_faces.h"
#include "api/region_file.h"
#include "api/region_match.h"
#include "api/region_mesh.h"
#include "api/value_interpolation.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

constexpr std::uint32_t kNone = RegionMatch::kNone;

/// A file's mesh on the lattice.
class FileMesh {
 public:
  /// \param written its positions, relative to `origin`
  FileMesh(const mesh_file::MeshData& data, std::span<const Point> written, const MeshRecord& record,
           const Point& origin)
      : corners(data.corners), firsts_{0} {
    positions.reserve(written.size());
    points.reserve(written.size());
    for (const Point& p : written) {
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

/// Makes an edited region of what was found in a file.
class FileEditBuilder {
 public:
  FileEditBuilder(const Snapshot::Impl& at, const RegionMesh& region, const MatchedRegion& matched,
                  const FileMesh& file)
      : at_(at), region_(region), faces_(matched.faces), match_(matched.match), file_(file), builder_(at, region) {}

  EditedRegion run() {
    add_vertices();
    add_faces_that_stay();
    add_new_faces();
    return builder_.finish(region_.attributes);
  }

  [[nodiscard]] FilePlaces take_places() { return std::move(places_); }

 private:
  void add_vertices() {
    vertex_of_region_.assign(region_.points.size(), kNone);
    for (const RegionMatch::Vertex& vertex : match_.vertices) {
      const Point position = vertex.other == kNone ? position_in(region_, at_.record().lattice, vertex.region)
                                                   : file_.positions[vertex.other];
      const std::uint32_t added = builder_.add_vertex(vertex.region, position);
      if (vertex.region != kNone) vertex_of_region_[vertex.region] = added;
      places_.vertices.push_back(vertex.other);
    }
  }

  /// The triangles of the region's faces that the file has.
  void add_faces_that_stay() {
    std::vector<std::uint32_t> file_face(faces_.count(), kNone);
    for (std::uint32_t f = 0; f < match_.faces.size(); ++f)
      if (match_.faces[f].face != kNone) file_face[match_.faces[f].face] = f;
    const std::vector<std::uint32_t> corner_of = faces_.file_corners(), face_of = faces_.file_faces();
    for (std::uint32_t t = 0; t < region_.faces.size(); ++t) {
      const std::uint32_t face = face_of[t], other = file_face[face];
      if (other == kNone) continue;
      const Triangle& v = region_.faces[t];
      builder_.add_face({vertex_of_region_[v[0]], vertex_of_region_[v[1]], vertex_of_region_[v[2]]}, t);
      places_.faces.push_back(other);
      const std::uint32_t first = faces_.firsts()[face], size = faces_.firsts()[face + 1] - first;
      for (std::uint32_t i = 0; i < 3; ++i)
        places_.corners.push_back(file_.firsts()[other] +
                                  (corner_of[3 * t + i] - first + size - match_.faces[other].turn) % size);
    }
  }

  void add_new_faces() {
    std::vector<std::uint32_t> faces, corners, sizes;
    for (std::uint32_t f = 0; f < match_.faces.size(); ++f) {
      if (match_.faces[f].face != kNone) continue;
      faces.push_back(f);
      sizes.push_back(file_.firsts()[f + 1] - file_.firsts()[f]);
      for (std::uint32_t c = file_.firsts()[f]; c < file_.firsts()[f + 1]; ++c) corners.push_back(c);
    }
    std::vector<Point> positions;
    for (const LatticePoint p : file_.points)
      positions.push_back({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t corner : corners) vertices.push_back(file_.corners[corner]);
    const mesh_file::Triangulation cut = mesh_file::triangulate(positions, vertices, sizes);
    std::size_t first_corner = 0;
    for (std::size_t t = 0, end; t < cut.corners.size(); t = end) {
      const std::uint32_t face = cut.face[t];
      for (end = t; end < cut.corners.size() && cut.face[end] == face;) ++end;
      add_new_face(faces[face], std::span(cut.corners).subspan(t, end - t), corners,
                   std::span(corners).subspan(first_corner, sizes[face]));
      first_corner += sizes[face];
    }
  }

  /// \param triangles positions in `corners`
  void add_new_face(std::uint32_t face, std::span<const Triangle> triangles, const std::vector<std::uint32_t>& corners,
                    std::span<const std::uint32_t> own) {
    std::vector<std::uint32_t> corner_at(own.size(), kNone);
    std::vector<std::uint32_t> added_faces;
    for (const Triangle& t : triangles) {
      Triangle vertices{};
      for (std::size_t i = 0; i < 3; ++i) vertices[i] = match_.vertex[file_.corners[corners[t[i]]]];
      const std::uint32_t added = builder_.add_face(vertices, kNew);
      added_faces.push_back(added);
      places_.faces.push_back(face);
      for (std::uint32_t i = 0; i < 3; ++i) {
        places_.corners.push_back(corners[t[i]]);
        corner_at[corners[t[i]] - own.front()] = 3 * added + i;
      }
    }
    if (own.size() > 3) builder_.add_polygon(corner_at, added_faces);
  }

  const Snapshot::Impl& at_;
  const RegionMesh& region_;
  const RegionFaces& faces_;
  const RegionMatch& match_;
  const FileMesh& file_;
  EditedRegionBuilder builder_;
  std::vector<std::uint32_t> vertex_of_region_;
  FilePlaces places_;
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

/// Where a region's vertices are, as a file has them.
std::vector<Point> relative_positions(const Snapshot::Impl& at, const RegionMesh& region, const Point& origin) {
  std::vector<Point> positions;
  positions.reserve(region.points.size());
  for (std::size_t v = 0; v < region.points.size(); ++v) {
    Point p = position_in(region, at.record().lattice, v);
    for (int a = 0; a < 3; ++a)
      if (origin[a] != 0) p[a] -= origin[a];
    positions.push_back(p);
  }
  return positions;
}

}  // namespace

FileEdit edited_in_file(const Snapshot::Impl& at, const RegionMesh& region, const mesh_file::MeshData& data,
                        const Point& local_origin, bool trust_ids) {
  FileEdit found;
  std::vector<Point> written = data.positions;
  if (const auto frame = find_frame(region, at.record().lattice, local_origin, written)) {
    for (Point& p : written) p = frame->apply(p);
    found.notes.frame = frame->describe();
  }
  FileMesh file(data, written, at.record(), local_origin);
  const std::span<const std::uint64_t> ids = trust_ids ? data.vertex_ids : std::span<const std::uint64_t>();
  const MatchedRegion matched = match_region(region, file.as_other(ids, repeats_vertices(data)));
  const double loss = coordinate_loss(relative_positions(at, region, local_origin), written);
  found.notes.snapped_back =
      snap_back_border(region, at.record().lattice, matched.match, loss, file.positions, file.points).vertices;
  FileEditBuilder builder(at, region, matched, file);
  found.edited = builder.run();
  if (!region.attributes.empty()) {
    found.notes.attributes_missing = take_values(data, builder.take_places(), found.edited.mesh);
    found.notes.values_interpolated = interpolate_new(region, found.edited);
  }
  for (const Attribute* unused : attributes_without_place(data, region))
    found.notes.not_taken.push_back(unused->info.name);
  return found;
}

}  // namespace ramcdb::detail
