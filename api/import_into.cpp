#include "api/import_into.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "api/commit.h"
#include "api/edited_region_builder.h"
#include "api/file_attributes.h"
#include "api/import.h"
#include "api/lattice_choice.h"
#include "api/mesh_file/mesh_file.h"
#include "api/region_mesh.h"
#include "api/snapshot_impl.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

/// How far the farthest position goes along an axis to become the mesh's; the mesh keeps it on its lattice, or to the
/// last bit of its type. None, where all come back as the numbers of their file.
double measure_error(const MeshRecord& record, const std::vector<Point>& positions) {
  const NumberType type = type_of(positions);
  double error = 0;
  bool all_come_back = true;
  for (const Point& p : positions) {
    const LatticePoint snapped = record.lattice.snap(p);
    const Point kept = record.exact ? record.rounded(p) : record.lattice.position(snapped);
    for (int a = 0; a < 3; ++a) {
      error = std::max(error, std::abs(kept[a] - p[a]));
      all_come_back &= as_type(kept[a], type) == p[a];
    }
  }
  return all_come_back ? 0 : error;
}

/// A chart as it is, and a file's mesh beside it.
class AddedMesh {
 public:
  AddedMesh(const Snapshot& base, const RegionMesh& region, const mesh_file::MeshData& data,
            const mesh_file::Triangulation& cut)
      : region_(region), data_(data), cut_(cut), builder_(base.impl(), region) {
    for (std::uint32_t v = 0; v < region.points.size(); ++v) (void)builder_.add_vertex(v, base.position(region, v));
    for (std::uint32_t f = 0; f < region.faces.size(); ++f) (void)builder_.add_face(region.faces[f], f);
    places_.vertices.assign(region.points.size(), kNew);
    places_.faces.assign(region.faces.size(), kNew);
    places_.corners.assign(3 * region.faces.size(), kNew);
  }

  /// \param positions of the file, as it has them
  EditedRegion run(const std::vector<Point>& positions, FileNotes& notes) {
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
      (void)builder_.add_vertex(kNew, positions[v]);
      places_.vertices.push_back(v);
    }
    std::uint32_t corner = 0;
    for (std::size_t t = 0, end; t < cut_.corners.size(); t = end) {
      for (end = t; end < cut_.corners.size() && cut_.face[end] == cut_.face[t];) ++end;
      const std::uint32_t size = static_cast<std::uint32_t>(end - t) + 2;
      add_face(cut_.face[t], std::span(cut_.corners).subspan(t, end - t), corner, size);
      corner += size;
    }
    EditedRegion edited = builder_.finish(region_.attributes);
    notes.attributes_missing = take_values(data_, places_, edited.mesh);
    return edited;
  }

 private:
  void add_face(std::uint32_t face, std::span<const Triangle> triangles, std::uint32_t first, std::uint32_t size) {
    const auto before = static_cast<std::uint32_t>(region_.points.size());
    std::vector<std::uint32_t> corner_at(size, kNew);
    std::vector<std::uint32_t> added_faces;
    for (const Triangle& t : triangles) {
      Triangle vertices{};
      for (std::size_t i = 0; i < 3; ++i) vertices[i] = before + data_.corners[t[i]];
      const std::uint32_t added = builder_.add_face(vertices, kNew);
      added_faces.push_back(added);
      places_.faces.push_back(face);
      for (std::uint32_t i = 0; i < 3; ++i) {
        places_.corners.push_back(t[i]);
        corner_at[t[i] - first] = 3 * added + i;
      }
    }
    if (size > 3) builder_.add_polygon(corner_at, added_faces);
  }

  const RegionMesh& region_;
  const mesh_file::MeshData& data_;
  const mesh_file::Triangulation& cut_;
  EditedRegionBuilder builder_;
  FilePlaces places_;
};

/// The file's positions as lattice points, by which polygons are cut as at import.
void put_on_lattice(const Lattice& lattice, std::vector<Point>& positions) {
  for (Point& p : positions) {
    const LatticePoint q = lattice.snap(p);
    p = {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z)};
  }
}

}  // namespace

ImportIntoReport import_into(const Snapshot& base, const std::filesystem::path& file,
                             const ImportIntoOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  ImportIntoReport report;
  const MeshRecord& record = base.impl().record();
  mesh_file::MeshData data =
      read_file_whole(file, options.weld, options.commit.progress, report.vertices_welded, report.dropped);
  report.vertices = data.positions.size();
  report.measured_error = measure_error(record, data.positions);
  const std::vector<Point> positions = data.positions;
  put_on_lattice(record.lattice, data.positions);
  const mesh_file::Triangulation cut = mesh_file::triangulate(data);
  report.faces = cut.corners.size();
  report.polygons = cut.polygons;
  report.polygons_as_fans = cut.fans;

  PendingEdit edit;
  edit.operation = "import";
  edit.parts = {{&base.impl(), base.find({{NearestTo{middle_of(positions)}}, 0})}};
  edit.region = load_region(edit.parts, options.commit.threads, nullptr, true);
  edit.edited = AddedMesh(base, edit.region, data, cut).run(positions, edit.notes);
  for (const Attribute* unused : attributes_without_place(data, edit.region))
    report.dropped.push_back({"attribute '" + unused->info.name + "', which the mesh does not have", unused->count()});
  if (!data.references.empty()) report.dropped.push_back({"references to other files", data.references.size()});
  edit.changes = changes_of(base.impl(), edit.region, edit.edited);
  CommitOptions commit = options.commit;
  if (commit.message.empty()) commit.message = "import " + file.filename().string();
  if (!options.dry_run) {
    report.commit = commit_edit(edit, commit, attempt_name(db::new_attempt_id(), commit.branch, edit));
  } else {
    report.commit.notes = edit.notes;
    report.commit.parent = base.version();
    report.commit.vertices_added = report.vertices;
    report.commit.faces_added = report.faces;
  }
  report.commit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb::detail
