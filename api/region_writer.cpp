#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/file_coordinates.h"
#include "api/region_faces.h"
#include "api/region_file.h"
#include "api/snapshot_impl.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using mesh_file::FaceColor;

/// A colour on a wheel, for things that only need to differ from their neighbours.
FaceColor hue(double turn) {
  const auto channel = [&](double shift) {
    const double t = turn + shift - std::floor(turn + shift);
    const double wave = t < 0.5 ? 4 * t - 1 : 3 - 4 * t;  // triangle wave, -1..1
    return static_cast<std::uint8_t>(std::clamp(150 + 90 * wave, 0.0, 255.0));
  };
  return {channel(0.25), channel(0.25 + 1.0 / 3), channel(0.25 + 2.0 / 3)};
}

/// Blue for the least, over white, to red for the most.
FaceColor heat(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  const auto level = [](double v) { return static_cast<std::uint8_t>(40 + 215 * std::clamp(v, 0.0, 1.0)); };
  return {level(2 * s), level(1 - std::abs(2 * s - 1)), level(2 - 2 * s)};
}

std::vector<FaceColor> shades(const std::vector<double>& values) {
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  std::vector<FaceColor> colors;
  for (const double v : values) colors.push_back(heat(*hi > *lo ? (v - *lo) / (*hi - *lo) : 0.0));
  return colors;
}

std::vector<FaceColor> chart_colors(const Snapshot& snapshot, const RegionMesh& region, Paint paint) {
  std::vector<FaceColor> colors;
  if (paint == Paint::chart) {
    // Steps of the golden angle keep the colours of successive ids far apart.
    for (const ChartId id : region.charts) colors.push_back(hue(static_cast<double>(id.value) * 0.61803398874989485));
    return colors;
  }
  std::vector<double> values;
  for (const ChartSummary& c : snapshot.describe(region.charts)) {
    const double vertices = std::max(1U, c.inner_vertices + c.border_vertices / 2);
    values.push_back(paint == Paint::bits ? 8.0 * static_cast<double>(c.bytes) / vertices : c.version.value);
  }
  return shades(values);
}

}  // namespace

WrittenRegion write_region(const Snapshot& snapshot, const RegionMesh& region, const std::filesystem::path& file,
                           const FileOptions& options, bool with_ids, bool may_shift) {
  const mesh_file::Format format = mesh_file::format_of(file);
  if (options.paint != Paint::none && format != mesh_file::Format::ply && format != mesh_file::Format::off)
    throw Error(Errc::invalid_argument, "this format has no face colours", file.string(), "write .ply or .off");

  const FileCoordinates coordinates = coordinates_for(snapshot, region, format, options, may_shift);
  mesh_file::MeshOutput out;
  out.scalar = coordinates.scalar;
  out.origin = coordinates.file_origin;
  std::vector<std::uint64_t> ids;
  if (with_ids && (format == mesh_file::Format::ply || mesh_file::is_gltf(format)))
    for (const VertexKey& key : region.keys) ids.push_back(key.packed());
  const RegionFaces faces(region);
  std::vector<FaceColor> face_colors;
  if (options.paint != Paint::none) {
    const auto colors = chart_colors(snapshot, region, options.paint);
    for (std::size_t f = 0; f < faces.count(); ++f)
      face_colors.push_back(colors[region.chart_of_face[faces.corners(f).front() / 3]]);
  }
  std::vector<Attribute> attributes;
  for (const Attribute& attribute : region.attributes) attributes.push_back(faces.for_file(attribute));
  out.positions = coordinates.positions;
  out.corners = faces.vertices();
  out.face_sizes = faces.sizes();
  out.attributes = attributes;
  out.references = snapshot.impl().layers().references;
  out.vertex_ids = ids;
  out.face_colors = face_colors;
  return {coordinates.origin, mesh_file::write_mesh(file, format, out, options.ascii)};
}

}  // namespace ramcdb::detail
