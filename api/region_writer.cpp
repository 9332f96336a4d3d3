#include "api/chart_paint.h"
#include "api/region_faces.h"
#include "api/region_file.h"
#include "api/snapshot_impl.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {

void check_paint(mesh_file::Format format, Paint paint, const std::filesystem::path& file) {
  if (paint != Paint::none && format != mesh_file::Format::ply && format != mesh_file::Format::off)
    throw Error(Errc::invalid_argument, "this format has no face colours", file.string(), "write .ply or .off");
}

WrittenRegion write_output_mesh(const Snapshot& snapshot, const OutputMesh& mesh, const FileCoordinates& coordinates,
                                std::span<const Point> positions, const std::filesystem::path& file,
                                const FileOptions& options) {
  mesh_file::MeshOutput out;
  out.scalar = coordinates.scalar;
  out.origin = coordinates.file_origin;
  out.positions = positions;
  out.corners = mesh.corners;
  out.face_sizes = mesh.face_sizes;
  out.attributes = mesh.attributes;
  out.references = snapshot.impl().layers().references;
  out.vertex_ids = mesh.vertex_ids;
  out.face_colors = mesh.face_colors;
  return {coordinates.origin, mesh_file::write_mesh(file, mesh_file::format_of(file), out, options.ascii)};
}

WrittenRegion write_region(const Snapshot& snapshot, const RegionMesh& region, const std::filesystem::path& file,
                           const FileOptions& options) {
  const mesh_file::Format format = mesh_file::format_of(file);
  check_paint(format, options.paint, file);
  std::vector<std::uint64_t> ids;
  if (format == mesh_file::Format::ply || mesh_file::is_gltf(format))
    for (const VertexKey& key : region.keys) ids.push_back(key.packed());
  const RegionFaces faces(region);
  std::vector<mesh_file::FaceColor> face_colors;
  if (options.paint != Paint::none) {
    const auto colors = chart_colors(snapshot, region.charts, options.paint);
    for (std::size_t f = 0; f < faces.count(); ++f)
      face_colors.push_back(colors[region.chart_of_face[faces.corners(f).front() / 3]]);
  }
  std::vector<Attribute> attributes;
  for (const Attribute& attribute : region.attributes) attributes.push_back(faces.for_file(attribute));
  const MeshPoints points{snapshot.lattice(), region.points, region.exact};
  const FileCoordinates coordinates =
      coordinates_for(points, snapshot.impl().record().written_as, format, options, true);
  std::vector<Point> positions;
  for (std::size_t v = 0; v < region.points.size(); ++v) positions.push_back(coordinates.in_file(points.position(v)));
  const OutputMesh mesh{faces.vertices(), faces.sizes(), attributes, ids, face_colors};
  return write_output_mesh(snapshot, mesh, coordinates, positions, file, options);
}

}  // namespace ramcdb::detail
