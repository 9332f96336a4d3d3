#include "api/lattice_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "codec/exact_codec.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

/// Beyond this many steps a round lattice is not looked for: edits shall have room around the mesh.
constexpr double kMostSteps = 1 << 28;

struct Extent {
  Point lo, hi;
  double largest = 0;

  explicit Extent(const PositionSource& positions) {
    bool first = true;
    positions.walk([&](std::span<const Point> some) {
      if (std::exchange(first, false)) lo = hi = some.front();
      for (const Point& p : some)
        for (int a = 0; a < 3; ++a) {
          lo[a] = std::min(lo[a], p[a]);
          hi[a] = std::max(hi[a], p[a]);
        }
      return true;
    });
    largest = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
  }
};

/// With its origin the highest multiple of the step below the low corner.
Lattice with_round_origin(const Extent& extent, double step, double steps_per_unit) {
  Lattice lattice{{}, step, steps_per_unit};
  for (int a = 0; a < 3; ++a)
    lattice.origin[a] = steps_per_unit != 0 ? std::floor(extent.lo[a] * steps_per_unit) / steps_per_unit
                                            : std::floor(extent.lo[a] / step) * step;
  return lattice;
}

/// 10^k for |k| <= 22 is a double, or one over a double.
Lattice decimal_lattice(const Extent& extent, int digit, int exponent) {
  double power = 1;
  for (int i = 0; i < std::abs(exponent); ++i) power *= 10;
  if (exponent > 0) return with_round_origin(extent, digit * power, 0);
  const double per_unit = power / digit;  // whole: 5 and 2 divide 10
  return with_round_origin(extent, 1 / per_unit, per_unit);
}

Lattice binary_lattice(const Extent& extent, int exponent) {
  return with_round_origin(extent, std::ldexp(1.0, exponent), 0);
}

/// Whether every position comes back as the number of `type` that it was.
bool holds_all(const Lattice& lattice, const PositionSource& positions, NumberType type) {
  bool all = true;
  positions.walk([&](std::span<const Point> some) {
    return all = std::ranges::all_of(some, [&](const Point& p) {
             const Point q = lattice.position(lattice.snap(p));
             return as_type(q.x, type) == p.x && as_type(q.y, type) == p.y && as_type(q.z, type) == p.z;
           });
  });
  return all;
}

/// The lattices of round decimal steps up to `most`, coarse ones first, as far as the mesh has few enough steps.
std::vector<Lattice> decimal_lattices(const Extent& extent, double most) {
  std::vector<Lattice> lattices;
  if (!(most > 0)) return lattices;
  const int top = std::clamp(static_cast<int>(std::log10(most)) + 1, -21, 22);
  for (int exponent = top; exponent >= -22; --exponent)
    for (const int digit : {5, 2, 1}) {
      const Lattice lattice = decimal_lattice(extent, digit, exponent);
      if (lattice.step > most) continue;
      if (extent.largest / lattice.step > kMostSteps) return lattices;
      lattices.push_back(lattice);
    }
  return lattices;
}

/// The largest k so that all coordinates are multiples of 2^k; none when all are zero.
std::optional<int> common_exponent(const PositionSource& positions) {
  std::optional<int> common;
  const auto add = [&](double number) {
    if (number == 0) return;
    int exponent = 0;
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::abs(number), &exponent), 53));
    const int lowest = exponent - 53 + std::countr_zero(mantissa);
    if (!common || lowest < *common) common = lowest;
  };
  positions.walk([&](std::span<const Point> some) {
    for (const Point& p : some)
      for (int a = 0; a < 3; ++a) add(p[a]);
    return true;
  });
  return common;
}

/// A step 2^k as wide as the gaps between numbers as large as 99 of 100 coordinates at most are.
Lattice gap_lattice(std::span<const Point> positions, NumberType type, const Extent& extent) {
  std::vector<double> magnitudes;
  for (const Point& p : positions)
    for (int a = 0; a < 3; ++a) magnitudes.push_back(std::abs(p[a]));
  const auto most = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() * 99 / 100);
  std::nth_element(magnitudes.begin(), most, magnitudes.end());
  const int digits =
      type == NumberType::float32 ? std::numeric_limits<float>::digits : std::numeric_limits<double>::digits;
  int of_gap = 0, of_extent = 0;
  (void)std::frexp(*most, &of_gap);
  (void)std::frexp(extent.largest, &of_extent);
  constexpr int kExtentBits = 27, kLeast = -1022;
  return binary_lattice(extent, std::max({*most == 0 ? kLeast : of_gap - digits, of_extent - kExtentBits, kLeast}));
}

std::vector<Point> sample_of(const PositionSource& positions) {
  constexpr std::uint64_t kMost = 4096;
  std::vector<Point> sample;
  std::uint64_t next = 0, first = 0;
  positions.walk([&](std::span<const Point> some) {
    for (; next < first + some.size(); next += positions.count / kMost + 1)
      sample.push_back(some[static_cast<std::size_t>(next - first)]);
    first += some.size();
    return true;
  });
  return sample;
}

/// About how many bits a position costs: those of the lattice, and those beside it. Prediction saves so many of a fine
/// lattice that one coarser than some 18 bits is no cheaper, unless it is all that there is.
double cost_of(const Lattice& lattice, std::span<const Point> sample, NumberType type, const Extent& extent) {
  double beside = 0;
  for (const Point& p : sample) beside += codec::exact_bits(p, lattice, type);
  const double bits = std::log2(extent.largest / lattice.step + 1);
  return 3 * (beside == 0 ? bits : std::max(18.0, bits)) + beside / static_cast<double>(sample.size());
}

Lattice lossless_lattice(const PositionSource& positions, NumberType type, const Extent& extent) {
  if (extent.largest == 0) return {extent.lo, 1.0};
  const std::vector<Point> sample = sample_of(positions);
  const double magnitude =
      std::max({std::abs(extent.lo.x), std::abs(extent.lo.y), std::abs(extent.lo.z), std::abs(extent.hi.x),
                std::abs(extent.hi.y), std::abs(extent.hi.z), extent.largest});
  std::vector<Lattice> candidates{gap_lattice(sample, type, extent)};
  const std::optional<int> exponent = common_exponent(positions);
  if (exponent && extent.largest / std::ldexp(1.0, *exponent) <= kMostSteps)
    candidates.push_back(binary_lattice(extent, *exponent));
  std::ranges::copy(decimal_lattices(extent, magnitude), std::back_inserter(candidates));
  return *std::ranges::min_element(candidates, {},
                                   [&](const Lattice& lattice) { return cost_of(lattice, sample, type, extent); });
}

Lattice precise_lattice(const PositionSource& positions, NumberType type, const Extent& extent, double precision) {
  if (!(precision > 0) || !std::isfinite(precision))
    throw Error(Errc::invalid_argument, fmt::format("precision {} is not a positive number", precision), {},
                "give the largest coordinate error you accept, in model units");
  const Lattice wanted{extent.lo, 2 * precision};
  if (extent.largest / wanted.step > kMaxLatticeCoordinate)
    throw Error(Errc::limit_exceeded, fmt::format("precision {:.9g} is too fine", precision),
                fmt::format("largest extent {:.9g}", extent.largest),
                fmt::format("use {:.9g} or more", extent.largest / kMaxLatticeCoordinate));
  std::vector<Lattice> round = decimal_lattices(extent, wanted.step * (1 + 1e-12));
  round.resize(std::min<std::size_t>(round.size(), 1));
  round.push_back(binary_lattice(extent, std::ilogb(wanted.step)));
  std::ranges::sort(round, std::ranges::greater{}, &Lattice::step);
  for (const Lattice& lattice : round)
    if (extent.largest / lattice.step <= kMostSteps && holds_all(lattice, positions, type)) return lattice;
  return round.front().step >= 0.9 * wanted.step ? round.front() : wanted;
}

}  // namespace

PositionSource PositionSource::of(std::span<const Point> positions) {
  return {positions.size(), [positions](const std::function<bool(std::span<const Point>)>& take) { take(positions); }};
}

NumberType type_of(std::span<const Point> positions) {
  const bool floats = std::ranges::all_of(positions, [](const Point& p) {
    return as_type(p.x, NumberType::float32) == p.x && as_type(p.y, NumberType::float32) == p.y &&
           as_type(p.z, NumberType::float32) == p.z;
  });
  return floats ? NumberType::float32 : NumberType::float64;
}

Lattice choose_lattice(const PositionSource& positions, NumberType type, const ImportOptions& options) {
  if (options.lattice) return *options.lattice;
  const Extent extent(positions);
  if (!std::isfinite(extent.largest))
    throw Error(Errc::limit_exceeded, "the mesh is too large", "its extent is no finite number", "scale it down");
  if (options.lossless) return lossless_lattice(positions, type, extent);
  if (options.precision != 0) return precise_lattice(positions, type, extent, options.precision);
  if (options.bits < 1 || options.bits > 30)
    throw Error(Errc::invalid_argument, fmt::format("{} bits are out of range", options.bits), {}, "use 1 to 30");
  // A mesh without extent still needs a step: any will do, all of it is one lattice point.
  if (extent.largest == 0) return {extent.lo, 1.0};
  const double step = extent.largest / static_cast<double>((1U << options.bits) - 1);
  return {extent.lo, std::max(step, std::numeric_limits<double>::denorm_min())};
}

}  // namespace ramcdb::detail
