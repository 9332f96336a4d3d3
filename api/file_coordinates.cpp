#include "api/file_coordinates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "api/same_values.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using mesh_file::Format;
using mesh_file::is_gltf;
using mesh_file::Scalar;
using Float = std::numeric_limits<float>;

/// Which numbers in a file lead back to a mesh's positions.
class Positions {
 public:
  explicit Positions(const MeshPoints& mesh) : mesh_(mesh) {}

  /// In text a float32 is read as a double up to half a float32 step away. Lattice points have to be the same for the
  /// steps to either side; positions to the last bit were float32 themselves, or are lost.
  [[nodiscard]] bool held_by_floats(const Point& origin) const {
    return all_of([&](std::size_t v, int a, double at) {
      const double local = at - origin[a];
      if (!(std::abs(local) <= double{Float::max()})) return false;
      const auto number = static_cast<float>(local);
      return leads_back(v, a, at, double{number}, origin) &&
             (is_lossless() || (leads_back(v, a, at, std::nextafter(number, -Float::infinity()), origin) &&
                                leads_back(v, a, at, std::nextafter(number, Float::infinity()), origin)));
    });
  }
  [[nodiscard]] bool held_by_doubles(const Point& origin) const {
    return all_of([&](std::size_t v, int a, double at) { return leads_back(v, a, at, at - origin[a], origin); });
  }
  /// What programs that print "%g" leave of the numbers. Positions to the last bit no such program leaves alone.
  [[nodiscard]] bool held_by_six_digits(const Point& origin) const {
    constexpr double kLargestError = 5e-6;  // of a number that begins with 1.00000
    return is_lossless() || all_of([&](std::size_t, int a, double at) {
             return std::abs(at - origin[a]) * kLargestError < mesh_.lattice.step / 2;
           });
  }

  /// A round point near the middle: a multiple of a power of ten, or below one unit of two, about the region's size.
  [[nodiscard]] Point near_middle() const {
    Point lo = mesh_.position(0), hi = lo;
    for (std::size_t v = 0; v < mesh_.points.size(); ++v) {
      const Point p = mesh_.position(v);
      for (int a = 0; a < 3; ++a) {
        lo[a] = std::min(lo[a], p[a]);
        hi[a] = std::max(hi[a], p[a]);
      }
    }
    const double extent = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z, mesh_.lattice.step});
    double unit = 1;
    if (extent < 1)
      unit = std::ldexp(1.0, std::ilogb(extent));
    else
      while (unit * 10 <= extent) unit *= 10;
    Point middle;
    for (int a = 0; a < 3; ++a) middle[a] = std::floor((lo[a] / 2 + hi[a] / 2) / unit + 0.5) * unit;
    return middle;
  }

 private:
  [[nodiscard]] bool is_lossless() const { return !mesh_.exact.empty(); }

  template <class Holds>
  [[nodiscard]] bool all_of(Holds&& holds) const {
    try {
      for (std::size_t v = 0; v < mesh_.points.size(); ++v) {
        const Point at = mesh_.position(v);
        for (int a = 0; a < 3; ++a)
          if (!holds(v, a, at[a])) return false;
      }
      return true;
    } catch (const Error&) {
      return false;  // a neighbour lies outside the lattice, as beside its last point, or is infinite
    }
  }

  [[nodiscard]] bool leads_back(std::size_t v, int a, double at, double number, const Point& origin) const {
    const double found = origin[a] == 0 ? number : number + origin[a];
    if (is_lossless()) return same_bits(found, at);
    return mesh_.lattice.snap(found, a) == mesh_.points[v][a];
  }

  const MeshPoints& mesh_;
};

bool is_text(Format format, const FileOptions& options) {
  return format == Format::obj || format == Format::off || (format == Format::ply && options.ascii);
}

std::optional<Point> origin_for(const Positions& positions, Format format, const FileOptions& options, bool may_shift) {
  if (!may_shift || options.local_origin == false) return std::nullopt;
  const Point middle = positions.near_middle();
  if (options.local_origin) return middle;
  if (is_gltf(format)) return std::nullopt;  // it has an origin of its own
  const bool too_coarse = !positions.held_by_floats({});
  const bool too_long = is_text(format, options) && !positions.held_by_six_digits({});
  const bool helps = positions.held_by_floats(middle) && (too_coarse || positions.held_by_six_digits(middle));
  return (too_coarse || too_long) && helps ? std::optional(middle) : std::nullopt;
}

}  // namespace

Point FileCoordinates::in_file(const Point& position) const {
  Point p = position;
  for (int a = 0; a < 3; ++a) {
    if (!(file_origin == Point{}))
      p[a] = static_cast<double>(static_cast<float>(p[a] - file_origin[a])) + file_origin[a];
    else if (origin[a] != 0)  // -0 - 0 would stay -0, but not as a sum again
      p[a] -= origin[a];
  }
  return p;
}

FileCoordinates coordinates_for(const MeshPoints& mesh, NumberType written_as, Format format,
                                const FileOptions& options, bool may_shift) {
  const Positions positions(mesh);
  FileCoordinates coordinates;
  coordinates.origin = origin_for(positions, format, options, may_shift).value_or(Point{});
  const bool only_floats = format == Format::stl || is_gltf(format);
  const bool as_doubles = !may_shift && !only_floats && written_as == NumberType::float64;
  if (as_doubles || !positions.held_by_floats(coordinates.origin)) coordinates.scalar = Scalar::float64;
  if (coordinates.scalar == Scalar::float64 && is_gltf(format)) coordinates.file_origin = positions.near_middle();
  if (coordinates.scalar == Scalar::float64 && only_floats && !positions.held_by_floats(coordinates.file_origin))
    throw Error(
        Errc::invalid_argument,
        std::string(is_gltf(format) ? "glTF" : "STL") + " holds 32-bit floats, too coarse for these coordinates", {},
        "write .ply, .obj or .off");
  if (coordinates.scalar == Scalar::float64 && !positions.held_by_doubles(coordinates.origin))
    throw Error(Errc::invalid_argument, "coordinates relative to a local origin would lose bits of this lossless mesh",
                {}, "leave out --local-origin");
  return coordinates;
}

}  // namespace ramcdb::detail
