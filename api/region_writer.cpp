#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/region_faces.h"
#include "api/region_file.h"
#include "api/snapshot_impl.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using mesh_file::FaceColor;

/// Whether files with float32 coordinates, moved by `origin`, lead back to the same lattice points. In text such a
/// number is read as a double up to half a float32 step away, so the steps to either side must lead back as well.
bool floats_hold(const Lattice& lattice, const std::vector<LatticePoint>& points, const Point& origin) {
  using Float = std::numeric_limits<float>;
  const auto holds = [&](LatticePoint p) {
    const Point exact = lattice.position(p);
    Point nearest, below, above;
    for (int a = 0; a < 3; ++a) {
      const double local = exact[a] - origin[a];
      if (!(std::abs(local) <= double{Float::max()})) return false;
      const auto number = static_cast<float>(local);
      nearest[a] = static_cast<double>(number) + origin[a];
      below[a] = static_cast<double>(std::nextafter(number, -Float::infinity())) + origin[a];
      above[a] = static_cast<double>(std::nextafter(number, Float::infinity())) + origin[a];
    }
    return lattice.snap(nearest) == p && lattice.snap(below) == p && lattice.snap(above) == p;
  };
  try {
    return std::all_of(points.begin(), points.end(), holds);
  } catch (const Error&) {
    return false;  // a neighbour lies outside the lattice, as beside its last point, or is infinite
  }
}

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
  const Lattice& lattice = snapshot.lattice();
  if (options.paint != Paint::none && format != mesh_file::Format::ply && format != mesh_file::Format::off)
    throw Error(Errc::invalid_argument, "this format has no face colours", file.string(), "write .ply or .off");

  mesh_file::MeshOutput out;
  Point origin;
  const bool floats = floats_hold(lattice, region.points, origin);
  out.scalar = floats ? mesh_file::Scalar::float32 : mesh_file::Scalar::float64;
  const bool stl = format == mesh_file::Format::stl;
  const bool gltf = format == mesh_file::Format::gltf || format == mesh_file::Format::glb;
  if (!floats && (stl || gltf)) {
    // glTF says in the file where its floats begin.
    if ((stl && !may_shift) || !floats_hold(lattice, region.points, lattice.origin))
      throw Error(Errc::invalid_argument,
                  fmt::format("{} holds 32-bit floats, too coarse for these coordinates", stl ? "STL" : "glTF"),
                  file.string(), "write .ply, .obj or .off");
    if (stl) {
      origin = lattice.origin;
      out.scalar = mesh_file::Scalar::float32;
    } else {
      out.origin = lattice.origin;
    }
  }
  std::vector<Point> positions;
  positions.reserve(region.points.size());
  for (const LatticePoint p : region.points) {
    Point q = lattice.position(p);
    for (int a = 0; a < 3; ++a) q[a] -= origin[a];
    if (gltf && !floats)
      for (int a = 0; a < 3; ++a) q[a] = static_cast<double>(static_cast<float>(q[a] - out.origin[a])) + out.origin[a];
    positions.push_back(q);
  }
  std::vector<std::uint64_t> ids;
  if (with_ids && (format == mesh_file::Format::ply || gltf))
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
  out.positions = positions;
  out.corners = faces.vertices();
  out.face_sizes = faces.sizes();
  out.attributes = attributes;
  out.references = snapshot.impl().layers().references;
  out.vertex_ids = ids;
  out.face_colors = face_colors;
  return {origin, mesh_file::write_mesh(file, format, out, options.ascii)};
}

}  // namespace ramcdb::detail
