#include "codec/exact_codec.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "codec/float_order.h"
#include "codec/layer_numbers.h"
#include "codec/range_coder.h"
#include "codec/varint.h"

namespace ramcdb::codec {

// exact  = format:1 check:fixed32 stream
// check  = the lower half of XXH3-64 over the numbers as float_order has them, each as 8 bytes, lowest first
// stream = per point, per axis: [digits] rest
// digits = of a lattice with a number of steps per unit: how many decimals more than a lattice coordinate has the
//          decimal fraction has that the number is nearest to, 0..7, or 8 if none; in unary, by the axis' digits before
// rest   = digits 0: nothing. 1..7: what these decimals say, -10^digits / 2 to 10^digits / 2, as a MissNumber.
//          8 or none: how far float_order is from that of the lattice coordinate, as a MissNumber; the width to be
//          expected is that of the way to the farther end of the lattice cell, half a step away.

namespace {

constexpr std::uint8_t kExactFormat = 1;
constexpr unsigned kMostDigits = 7;
constexpr std::array<double, kMostDigits + 1> kPowers{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7};

unsigned width_of(double number) { return static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(number))); }

/// The numbers around one lattice coordinate.
class Cell {
 public:
  Cell(const Lattice& lattice, LatticePoint point, int axis, NumberType type)
      : type_(type),
        per_unit_(lattice.steps_per_unit),
        steps_(std::floor(lattice.origin[axis] * per_unit_ + 0.5) + point[axis]),
        half_(lattice.step / 2),
        position_(per_unit_ != 0 ? steps_ / per_unit_ : lattice.origin[axis] + point[axis] * lattice.step) {}

  [[nodiscard]] bool is_decimal() const { return per_unit_ != 0; }
  [[nodiscard]] std::uint64_t center() const { return float_order(position_, type_); }
  /// The decimal fraction that is `rest` units of its last decimal, the `digits`-th, from the lattice coordinate.
  [[nodiscard]] std::uint64_t decimal(unsigned digits, double rest) const {
    return float_order((steps_ * kPowers[digits] + rest) / (per_unit_ * kPowers[digits]), type_);
  }
  [[nodiscard]] unsigned width() const {
    const std::uint64_t below = center() - float_order(position_ - half_, type_);
    const std::uint64_t above = float_order(position_ + half_, type_) - center();
    return static_cast<unsigned>(std::bit_width(std::max(below, above)));
  }

  struct Decimals {
    unsigned digits = kMostDigits + 1;  ///< beyond kMostDigits: no decimal fraction, or none that is cheaper
    double rest = 0;
  };
  /// The fewest decimals that name a number.
  [[nodiscard]] Decimals decimals(std::uint64_t number) const {
    const double value = from_float_order(number, type_);
    const unsigned most = width();
    for (unsigned digits = 0; digits <= kMostDigits && width_of(kPowers[digits] / 2) < most + 1; ++digits) {
      const double unit = per_unit_ * kPowers[digits];
      const double rest = std::floor((value - position_) * unit + 0.5);
      if (decimal(digits, rest) == number) return {digits, rest};
    }
    return {};
  }

 private:
  NumberType type_;
  double per_unit_, steps_, half_, position_;
};

/// Coordinates in a stream; encoder and decoder in one.
template <class Coder>
class CoordinateCoder {
 public:
  CoordinateCoder(Coder& coder, NumberType type) : coder_(coder), ring_(type == NumberType::float32 ? 32 : 64) {}

  void code(std::uint64_t& number, const Cell& cell, int axis) {
    if (cell.is_decimal()) {
      Cell::Decimals found;
      if constexpr (Coder::kEncodes) found = cell.decimals(number);
      found.digits = code_digits(found.digits, last_digits_[static_cast<std::size_t>(axis)]);
      if (found.digits <= kMostDigits) {
        const unsigned width = width_of(kPowers[found.digits] / 2);
        if (found.digits > 0)
          found.rest = static_cast<double>(rests_.code(coder_, width, static_cast<std::int64_t>(found.rest)));
        number = cell.decimal(found.digits, found.digits > 0 ? found.rest : 0);
        return;
      }
    }
    const std::uint64_t center = cell.center();
    const std::int64_t miss = misses_.code(coder_, cell.width(), ring_.difference(number, center));
    number = ring_.wrap(center + static_cast<std::uint64_t>(miss));
  }

 private:
  unsigned code_digits(unsigned digits, unsigned& last) {
    unsigned coded = 0;
    while (coded <= kMostDigits && coder_.code(more_[last][coded], coded < digits)) ++coded;
    return last = coded;
  }

  Coder& coder_;
  Ring ring_;
  MissNumber misses_, rests_;
  std::array<std::array<AdaptiveBit, kMostDigits + 1>, kMostDigits + 2> more_;
  std::array<unsigned, 3> last_digits_{};
};

using Numbers = std::vector<std::uint64_t>;

Numbers numbers_of(std::span<const Point> exact, NumberType type) {
  Numbers numbers;
  numbers.reserve(3 * exact.size());
  for (const Point& p : exact)
    for (int axis = 0; axis < 3; ++axis) numbers.push_back(float_order(p[axis], type));
  return numbers;
}

std::uint32_t check_of(const Numbers& numbers) {
  Buffer bytes;
  bytes.reserve(8 * numbers.size());
  for (const std::uint64_t number : numbers)
    for (int shift = 0; shift < 64; shift += 8) bytes.push_back(static_cast<std::uint8_t>(number >> shift));
  return static_cast<std::uint32_t>(XXH3_64bits(bytes.data(), bytes.size()));
}

/// Reads or writes `numbers`, as the coder does.
template <class Coder>
void code_stream(Coder& coder, Numbers& numbers, std::span<const LatticePoint> points, const Lattice& lattice,
                 NumberType type) {
  CoordinateCoder coordinates(coder, type);
  auto number = numbers.begin();
  for (const LatticePoint point : points)
    for (int axis = 0; axis < 3; ++axis) coordinates.code(*number++, Cell(lattice, point, axis, type), axis);
}

bool snap_to(std::span<const Point> exact, std::span<const LatticePoint> points, const Lattice& lattice) {
  try {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (lattice.snap(exact[i]) != points[i]) return false;
    return true;
  } catch (const Error&) {
    return false;
  }
}

bool are_of(NumberType type, std::span<const Point> exact) {
  if (!is_float(type)) return false;
  return type == NumberType::float64 || std::ranges::all_of(exact, [](const Point& p) {
           for (int axis = 0; axis < 3; ++axis)
             if (static_cast<double>(static_cast<float>(p[axis])) != p[axis]) return false;
           return true;
         });
}

}  // namespace

unsigned exact_bits(const Point& p, const Lattice& lattice, NumberType type) {
  const LatticePoint point = lattice.snap(p);
  unsigned bits = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Cell cell(lattice, point, axis, type);
    const std::uint64_t number = float_order(p[axis], type);
    const unsigned digits = cell.is_decimal() ? cell.decimals(number).digits : kMostDigits + 1;
    if (number == cell.center()) continue;
    bits += 1 + (digits <= kMostDigits ? width_of(kPowers[digits]) : cell.width());
  }
  return bits;
}

Buffer encode_exact(std::span<const Point> exact, std::span<const LatticePoint> points, const Lattice& lattice,
                    NumberType type) {
  if (exact.size() != points.size() || !are_of(type, exact) || !snap_to(exact, points, lattice))
    throw Error(Errc::invalid_argument, "exact positions do not belong to their lattice points");
  const Numbers numbers = numbers_of(exact, type);
  RangeEncoder coder;
  Numbers coded = numbers;
  code_stream(coder, coded, points, lattice, type);
  Buffer blob{kExactFormat};
  put_fixed32(blob, check_of(numbers));
  const Buffer stream = coder.finish();
  blob.insert(blob.end(), stream.begin(), stream.end());
  if (numbers_of(decode_exact(blob, points, lattice, type), type) != numbers)
    throw Error(Errc::invalid_argument, "exact positions cannot be coded", {}, "report this: it is a bug");
  return blob;
}

std::vector<Point> decode_exact(Bytes blob, std::span<const LatticePoint> points, const Lattice& lattice,
                                NumberType type) {
  ByteReader reader(blob, "exact blob");
  if (reader.byte() != kExactFormat) reader.fail("has an unknown format");
  const std::uint32_t check = reader.fixed32();
  Numbers numbers(3 * points.size());
  RangeDecoder coder(reader.rest());
  code_stream(coder, numbers, points, lattice, type);
  coder.finish();
  if (check_of(numbers) != check) reader.fail("is damaged, or belongs to another chart");
  std::vector<Point> exact(points.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    exact[i / 3][static_cast<int>(i % 3)] = from_float_order(numbers[i], type);
  if (!snap_to(exact, points, lattice)) reader.fail("has positions that do not belong to their lattice points");
  return exact;
}

}  // namespace ramcdb::codec
