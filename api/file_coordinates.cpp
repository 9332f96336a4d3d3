#include "api/file_coordinates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "api/snapshot_impl.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using mesh_file::Format;
using mesh_file::is_gltf;
using mesh_file::Scalar;
using Float = std::numeric_limits<float>;

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// A region's positions, and which numbers in a file lead back to them.
class Positions {
 public:
  Positions(const Snapshot& snapshot, const RegionMesh& region) : lattice_(snapshot.lattice()), region_(region) {
    positions_.reserve(region.points.size());
    for (std::size_t v = 0; v < region.points.size(); ++v) positions_.push_back(snapshot.position(region, v));
  }

  /// In text a float32 is read as a double up to half a float32 step away. Lattice points have to be the same for the
  /// steps to either side; positions to the last bit were float32 themselves, or are lost.
  [[nodiscard]] bool held_by_floats(const Point& origin) const {
    return all_of([&](std::size_t v, int a) {
      const double local = positions_[v][a] - origin[a];
      if (!(std::abs(local) <= double{Float::max()})) return false;
      const auto number = static_cast<float>(local);
      return leads_back(v, a, double{number}, origin) &&
             (is_lossless() || (leads_back(v, a, std::nextafter(number, -Float::infinity()), origin) &&
                                leads_back(v, a, std::nextafter(number, Float::infinity()), origin)));
    });
  }
  [[nodiscard]] bool held_by_doubles(const Point& origin) const {
    return all_of([&](std::size_t v, int a) { return leads_back(v, a, positions_[v][a] - origin[a], origin); });
  }
  /// What programs that print "%g" leave of the numbers. Positions to the last bit no such program leaves alone.
  [[nodiscard]] bool held_by_six_digits(const Point& origin) const {
    constexpr double kLargestError = 5e-6;  // of a number that begins with 1.00000
    return is_lossless() || all_of([&](std::size_t v, int a) {
             return std::abs(positions_[v][a] - origin[a]) * kLargestError < lattice_.step / 2;
           });
  }

  /// A round point near the middle: a multiple of a power of ten, or below one unit of two, about the region's size.
  [[nodiscard]] Point near_middle() const {
    Point lo = positions_.front(), hi = lo;
    for (const Point& p : positions_)
      for (int a = 0; a < 3; ++a) {
        lo[a] = std::min(lo[a], p[a]);
        hi[a] = std::max(hi[a], p[a]);
      }
    const double extent = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z, lattice_.step});
    double unit = 1;
    if (extent < 1)
      unit = std::ldexp(1.0, std::ilogb(extent));
    else
      while (unit * 10 <= extent) unit *= 10;
    Point middle;
    for (int a = 0; a < 3; ++a) middle[a] = std::floor((lo[a] / 2 + hi[a] / 2) / unit + 0.5) * unit;
    return middle;
  }

  [[nodiscard]] std::vector<Point> as_floats_from(const Point& origin) && {
    for (Point& p : positions_)
      for (int a = 0; a < 3; ++a) p[a] = static_cast<double>(static_cast<float>(p[a] - origin[a])) + origin[a];
    return std::move(positions_);
  }
  [[nodiscard]] std::vector<Point> relative_to(const Point& origin) && {
    for (Point& p : positions_)
      for (int a = 0; a < 3; ++a)
        if (origin[a] != 0) p[a] -= origin[a];  // -0 - 0 would stay -0, but not as a sum again
    return std::move(positions_);
  }

 private:
  [[nodiscard]] bool is_lossless() const { return !region_.exact.empty(); }

  template <class Holds>
  [[nodiscard]] bool all_of(Holds&& holds) const {
    try {
      for (std::size_t v = 0; v < positions_.size(); ++v)
        for (int a = 0; a < 3; ++a)
          if (!holds(v, a)) return false;
      return true;
    } catch (const Error&) {
      return false;  // a neighbour lies outside the lattice, as beside its last point, or is infinite
    }
  }

  [[nodiscard]] bool leads_back(std::size_t v, int a, double number, const Point& origin) const {
    const double found = origin[a] == 0 ? number : number + origin[a];
    if (is_lossless()) return same_bits(found, positions_[v][a]);
    return lattice_.snap(found, a) == region_.points[v][a];
  }

  const Lattice& lattice_;
  const RegionMesh& region_;
  std::vector<Point> positions_;
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

void refuse_floats(Format format) {
  throw Error(Errc::invalid_argument,
              std::string(is_gltf(format) ? "glTF" : "STL") + " holds 32-bit floats, too coarse for these coordinates",
              {}, "write .ply, .obj or .off");
}

}  // namespace

bool floats_hold(const Snapshot& snapshot, const RegionMesh& region) {
  return Positions(snapshot, region).held_by_floats({});
}

Scalar scalar_for(const MeshRecord& record, Format format, bool floats) {
  if (format == Format::stl) {
    if (!floats) refuse_floats(format);
    return Scalar::float32;
  }
  return floats && record.written_as != NumberType::float64 ? Scalar::float32 : Scalar::float64;
}

FileCoordinates coordinates_for(const Snapshot& snapshot, const RegionMesh& region, Format format,
                                const FileOptions& options, bool may_shift) {
  Positions positions(snapshot, region);
  FileCoordinates coordinates;
  coordinates.origin = origin_for(positions, format, options, may_shift).value_or(Point{});
  const bool only_floats = format == Format::stl || is_gltf(format);
  const bool as_doubles = !may_shift && !only_floats && snapshot.impl().record().written_as == NumberType::float64;
  if (as_doubles || !positions.held_by_floats(coordinates.origin)) coordinates.scalar = Scalar::float64;
  if (coordinates.scalar == Scalar::float64 && is_gltf(format)) coordinates.file_origin = positions.near_middle();
  if (coordinates.scalar == Scalar::float64 && only_floats && !positions.held_by_floats(coordinates.file_origin))
    refuse_floats(format);
  if (coordinates.scalar == Scalar::float64 && !positions.held_by_doubles(coordinates.origin))
    throw Error(Errc::invalid_argument, "coordinates relative to a local origin would lose bits of this lossless mesh",
                {}, "leave out --local-origin");
  coordinates.positions = coordinates.file_origin == Point{}
                              ? std::move(positions).relative_to(coordinates.origin)
                              : std::move(positions).as_floats_from(coordinates.file_origin);
  return coordinates;
}

}  // namespace ramcdb::detail
