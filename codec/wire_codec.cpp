#include "codec/wire_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "codec/range_coder.h"
#include "ramcdb/error.h"

/// Wire blob:
///   u8      format 1 in the upper half, predictor in the lower: 0 blended, 1 linear
///   stream  range coder (range_coder.h); for every inner point in order, for x, y, z: the residual of the prediction
///
/// The two ends and the number of inner points come from the wire-net. The blended predictor knows where the wire has
/// to arrive: next = p1 + a d1 + b d2 + c g with d1, d2 the last two steps and g the chord to the end divided by the
/// steps that are left; weights by how much is known (research: least squares over scans). Machine-made wires run
/// straight: there next = p1 + d1 is better. The encoder writes both and keeps the shorter.
///
/// A residual is coded by the width of its magnitude in unary, sign, second-highest bit, and the rest raw. The unary
/// bits are learned relative to the width that is expected: of a running mean of magnitudes that starts from the chord.
namespace ramcdb::codec {
namespace {

enum class Predictor : std::uint8_t { blended = 0, linear = 1 };

constexpr std::uint8_t kWireFormat = 1;

/// More than any wire has, and little enough that hostile counts cost little.
constexpr std::size_t kMostPoints = 1 << 20;

/// Weights of a step back, the step before it, and the chord, in 1/1024.
struct Weights {
  std::int64_t d1, d2, chord;
};
constexpr Weights kFirst{0, 0, 977}, kSecond{440, 0, 597}, kNearEnd{153, 10, 841}, kMidway{402, 204, 413};
constexpr std::uint32_t kNearEndPoints = 4;

std::int64_t divide_rounded(std::int64_t a, std::int64_t b) {
  const std::int64_t doubled = 2 * a + b;  // b > 0: floor((2a + b) / 2b)
  const std::int64_t q = doubled / (2 * b);
  return q - (doubled % (2 * b) < 0);
}

std::int32_t clamp_coordinate(std::int64_t v) {
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(v, -kMaxLatticeCoordinate, kMaxLatticeCoordinate));
}

/// Where inner point `i` is expected. `points` holds those before it; `end` is the end corner.
LatticePoint predict(Predictor predictor, const std::vector<LatticePoint>& points, LatticePoint end,
                     std::uint32_t points_left) {
  const std::size_t n = points.size();
  const LatticePoint p1 = points[n - 1];
  const Weights w = n == 1 ? kFirst : n == 2 ? kSecond : points_left <= kNearEndPoints ? kNearEnd : kMidway;
  LatticePoint result;
  for (int a = 0; a < 3; ++a) {
    const std::int64_t d1 = n > 1 ? std::int64_t{p1[a]} - points[n - 2][a] : 0;
    const std::int64_t d2 = n > 2 ? std::int64_t{points[n - 2][a]} - points[n - 3][a] : 0;
    const std::int64_t chord = divide_rounded((std::int64_t{end[a]} - p1[a]) * 1024, std::int64_t{points_left} + 1);
    const std::int64_t step = predictor == Predictor::linear && n > 1
                                  ? d1
                                  : divide_rounded(w.d1 * 1024 * d1 + w.d2 * 1024 * d2 + w.chord * chord, 1024 * 1024);
    result[a] = clamp_coordinate(p1[a] + step);
  }
  return result;
}

/// Probability of "wider still", by how the width reached compares to the width expected: -6 or less ... +6 or more.
constexpr std::array<std::uint16_t, 13> kWider{64000, 64000, 63500, 63000, 62000, 60500, 56500,
                                               47000, 30000, 13000, 5000,  2500,  1500};

class ResidualCoder {
 public:
  explicit ResidualCoder(std::uint64_t expected) : mean_(16 * expected) {
    for (auto& axis : wider_)
      for (std::size_t i = 0; i < axis.size(); ++i) axis[i] = AdaptiveBit(kWider[i], 6);
  }

  template <class Coder>
  std::int32_t code(Coder& coder, int axis, std::int32_t value) {
    const auto magnitude = static_cast<std::uint32_t>(std::abs(std::int64_t{value}));
    const int actual = static_cast<int>(std::bit_width(magnitude));
    const int expected = static_cast<int>(std::bit_width(mean_ >> 4));
    auto& wider = wider_[static_cast<std::size_t>(axis)];
    int width = 0;
    while (width < 31 &&
           coder.code(wider[static_cast<std::size_t>(std::clamp(width - expected, -6, 6) + 6)], actual > width))
      ++width;
    if (width == 0) {
      learn(0);
      return 0;
    }
    const bool negative = coder.code(negative_[static_cast<std::size_t>(axis)], value < 0);
    std::uint32_t x = 1;
    int left = width - 1;
    if (left > 0) {
      --left;
      x = 2 * x + coder.code(second_, (magnitude >> left) & 1);
    }
    x = x << left | coder.code_raw(magnitude & ((1U << left) - 1), left);
    learn(x);
    return negative ? -static_cast<std::int32_t>(x) : static_cast<std::int32_t>(x);
  }

 private:
  void learn(std::uint32_t magnitude) { mean_ = (7 * mean_ + 16 * std::uint64_t{magnitude}) / 8; }

  std::uint64_t mean_;  ///< of magnitudes, in 1/16
  std::array<std::array<AdaptiveBit, 13>, 3> wider_;
  std::array<AdaptiveBit, 3> negative_;
  AdaptiveBit second_;
};

/// A third of the mean step, were the wire straight.
std::uint64_t expected_residual(LatticePoint begin, LatticePoint end, std::uint32_t inner_points) {
  std::int64_t chord = 0;
  for (int a = 0; a < 3; ++a) chord = std::max(chord, std::abs(std::int64_t{end[a]} - begin[a]));
  return static_cast<std::uint64_t>(chord) / (3 * (std::uint64_t{inner_points} + 1));
}

/// Both directions: `wire` holds all its points when encoding, and gets them when decoding.
template <class Coder>
void code_points(Coder& coder, Predictor predictor, Wire& wire, LatticePoint begin, LatticePoint end,
                 std::uint32_t inner_points) {
  std::vector<LatticePoint> points{begin};
  ResidualCoder residuals(expected_residual(begin, end, inner_points));
  for (std::uint32_t i = 0; i < inner_points; ++i) {
    const LatticePoint expected = predict(predictor, points, end, inner_points - i);
    LatticePoint p;
    for (int a = 0; a < 3; ++a) {
      const std::int32_t residual = Coder::kEncodes ? wire.points[i + 1][a] - expected[a] : 0;
      const std::int64_t value = std::int64_t{expected[a]} + residuals.code(coder, a, residual);
      if (std::abs(value) > kMaxLatticeCoordinate) throw Error(Errc::corrupt, "wire blob: a point leaves the lattice");
      p[a] = static_cast<std::int32_t>(value);
    }
    points.push_back(p);
  }
  points.push_back(end);
  if (!Coder::kEncodes) wire.points = std::move(points);
}

Buffer encode_with(Predictor predictor, const Wire& wire) {
  RangeEncoder encoder;
  Wire copy = wire;
  code_points(encoder, predictor, copy, wire.points.front(), wire.points.back(),
              static_cast<std::uint32_t>(wire.points.size() - 2));
  const Buffer stream = encoder.finish();
  Buffer blob;
  blob.reserve(1 + stream.size());
  blob.push_back(static_cast<std::uint8_t>(kWireFormat << 4 | static_cast<std::uint8_t>(predictor)));
  blob.insert(blob.end(), stream.begin(), stream.end());
  return blob;
}

}  // namespace

Buffer encode_wire(const Wire& wire) {
  if (wire.points.size() < 2) throw Error(Errc::invalid_argument, "a wire has at least two points");
  for (const LatticePoint p : wire.points)
    for (int a = 0; a < 3; ++a)
      if (std::abs(std::int64_t{p[a]}) > kMaxLatticeCoordinate)
        throw Error(Errc::invalid_argument, "a point of a wire leaves the lattice");
  if (wire.points.size() == 2) return {};
  if (wire.points.size() - 2 > kMostPoints)
    throw Error(Errc::limit_exceeded, "a wire has too many points", {}, "use smaller charts");
  Buffer blended = encode_with(Predictor::blended, wire);
  Buffer linear = encode_with(Predictor::linear, wire);
  return linear.size() < blended.size() ? linear : blended;
}

Wire decode_wire(Bytes blob, LatticePoint begin, LatticePoint end, std::uint32_t inner_points) {
  Wire wire;
  wire.points = {begin, end};
  if (inner_points == 0) {
    if (!blob.empty()) throw Error(Errc::corrupt, "wire blob: bytes for a wire without inner points");
    return wire;
  }
  if (blob.empty() || inner_points > kMostPoints) throw Error(Errc::corrupt, "wire blob: no bytes, or too many points");
  if (blob[0] >> 4 == 0) throw Error(Errc::corrupt, "wire blob: no known format");
  if (blob[0] >> 4 != kWireFormat)
    throw Error(Errc::unsupported_version, "wire blob: unknown format", {}, "use a newer ramcdb");
  if ((blob[0] & 15) > 1) throw Error(Errc::corrupt, "wire blob: unknown predictor");
  RangeDecoder decoder(blob.subspan(1));
  code_points(decoder, static_cast<Predictor>(blob[0] & 15), wire, begin, end, inner_points);
  decoder.finish();
  return wire;
}

}  // namespace ramcdb::codec
