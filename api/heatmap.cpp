#include "api/heatmap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "api/change_figures.h"
#include "api/mesh_file/mesh_file.h"
#include "api/region_mesh.h"
#include "api/sidecar.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using Color = std::array<double, 3>;

/// Viridis in nine steps: equally far apart to the eye, ever lighter, and told apart without seeing red or green.
constexpr std::array<Color, 9> kRamp = {{{68, 1, 84},
                                         {71, 44, 122},
                                         {59, 81, 139},
                                         {44, 113, 142},
                                         {33, 144, 141},
                                         {39, 173, 129},
                                         {92, 200, 99},
                                         {170, 220, 50},
                                         {253, 231, 37}}};
constexpr Color kAdded = {230, 30, 140};

/// \param share 0..1
Color ramp(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kRamp.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kRamp.size() - 2);
  const double part = at - static_cast<double>(below);
  Color color{};
  for (std::size_t i = 0; i < 3; ++i)
    color[i] = std::floor(kRamp[below][i] * (1 - part) + kRamp[below + 1][i] * part + 0.5);
  return color;
}

/// Positions as a file can have them. Where float32 is too coarse for them, PLY has doubles, and glTF floats from an
/// origin that is a multiple of their last bit.
struct HeatPositions {
  std::vector<Point> positions;
  mesh_file::Scalar scalar = mesh_file::Scalar::float32;
  Point origin;

  void fit(bool is_gltf) {
    Point lo = positions.front(), hi = lo;
    double far = 0, extent = 0;
    for (const Point& p : positions)
      for (int a = 0; a < 3; ++a) {
        lo[a] = std::min(lo[a], p[a]);
        hi[a] = std::max(hi[a], p[a]);
        far = std::max(far, std::abs(p[a]));
        extent = std::max(extent, hi[a] - lo[a]);
      }
    constexpr double kCoarse = 1000;
    if (extent == 0 || far < kCoarse * extent) return;
    scalar = mesh_file::Scalar::float64;
    if (!is_gltf) return;
    const double unit = std::ldexp(1.0, std::ilogb(extent) - 20);
    const auto whole = [&](double x) { return std::floor(x / unit + 0.5) * unit; };
    for (int a = 0; a < 3; ++a) origin[a] = whole(lo[a] + (hi[a] - lo[a]) / 2);
    for (Point& p : positions)
      for (int a = 0; a < 3; ++a) p[a] = whole(p[a]);
  }
};

/// The mesh with the faces that are new taken off the others.
class HeatMesh {
 public:
  HeatMesh(const Snapshot::Impl& at, const Heat& heat, double most) : heat_(heat) {
    const RegionMesh& mesh = heat.mesh;
    for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
      where_.push_back(position_in(mesh, at.record().lattice, v));
      add(v, ramp(most > 0 ? heat.displacement[v] / most : 0));
    }
    std::vector<std::uint32_t> copy(mesh.points.size(), kNew);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
      for (const std::uint32_t v : mesh.faces[f]) {
        if (heat.is_new[f] && copy[v] == kNew) copy[v] = add(v, kAdded);
        corners_.push_back(heat.is_new[f] ? copy[v] : v);
      }
    drop_unused();
  }

  void write(const std::filesystem::path& file) {
    const mesh_file::Format format = mesh_file::format_of(file);
    out_.fit(mesh_file::is_gltf(format));
    const std::vector<Attribute> attributes = {
        {{"color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color, {}, {}}, colors_},
        {{"displacement", AttributeOf::vertex, NumberType::float32, 1, Meaning::other, {}, {}}, displacements_}};
    mesh_file::MeshOutput output;
    output.positions = out_.positions;
    output.corners = corners_;
    output.scalar = out_.scalar;
    output.origin = out_.origin;
    output.attributes = attributes;
    (void)mesh_file::write_mesh(file, format, output);
  }

 private:
  std::uint32_t add(std::uint32_t v, const Color& color) {
    out_.positions.push_back(where_[v]);
    colors_.insert(colors_.end(), color.begin(), color.end());
    displacements_.push_back(static_cast<float>(heat_.displacement[v]));
    return static_cast<std::uint32_t>(displacements_.size() - 1);
  }

  /// Vertices that only new faces had are there as copies.
  void drop_unused() {
    std::vector<bool> used(displacements_.size(), false);
    for (const std::uint32_t v : corners_) used[v] = true;
    std::vector<std::uint32_t> number(used.size(), kNew);
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (!used[v]) continue;
      number[v] = count;
      out_.positions[count] = out_.positions[v];
      displacements_[count] = displacements_[v];
      for (std::size_t i = 0; i < 3; ++i) colors_[3 * count + i] = colors_[3 * v + i];
      ++count;
    }
    out_.positions.resize(count);
    displacements_.resize(count);
    colors_.resize(3 * std::size_t{count});
    for (std::uint32_t& v : corners_) v = number[v];
  }

  const Heat& heat_;
  std::vector<Point> where_;
  HeatPositions out_;
  std::vector<double> colors_, displacements_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Heat heat_of_edit(const PendingEdit& edit) {
  Heat heat{edit.edited.mesh, displacements_of(edit.edited, edit.changes), {}};
  heat.is_new.assign(heat.mesh.faces.size(), false);
  for (const std::uint32_t f : edit.changes.faces_new) heat.is_new[f] = true;
  return heat;
}

void require_heatmap_file(const std::filesystem::path& file) {
  const mesh_file::Format format = mesh_file::format_of(file);
  if (format != mesh_file::Format::ply && format != mesh_file::Format::glb)
    throw Error(Errc::invalid_argument, "a heat map is a .ply or .glb file", file.string(), "choose such a name");
  if (std::filesystem::exists(sidecar_path(file)))
    throw Error(Errc::invalid_argument, "a checked-out file has the name of the heat map", file.string(),
                "choose another name");
}

void write_heatmap(const Snapshot::Impl& at, const Heat& heat, double most, const std::filesystem::path& file) {
  if (heat.mesh.faces.empty())
    throw Error(Errc::invalid_argument, "there is nothing to draw a heat map of", file.string(),
                "compare versions that differ, or show all of the mesh");
  HeatMesh(at, heat, most).write(file);
}

}  // namespace ramcdb::detail
