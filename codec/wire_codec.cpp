#include "codec/wire_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "codec/range_coder.h"
#include "ramcdb/error.h"

/// Wire blob: the inner points of some wires.
///   u8      format 1 in the upper half, 0 in the lower
///   stream  range coder (range_coder.h): number of wires; width of the residuals to expect, 5 bits raw; then wire by
///           wire: id (0: the next one, else by how many later), inner points - 1, predictor (0 blended, 1 linear), and
///           for every point, for x, y, z: the residual of the prediction
///
/// The ends come from the wire-net, and only predictions need them: what is coded, and how, depends on residuals alone.
/// So wires can leave a blob (an edited one gets a new one) while the others stay readable.
///
/// The blended predictor knows where the wire has to arrive: next = p1 + a d1 + b d2 + c g with d1, d2 the last two
/// steps and g the chord to the end divided by the steps that are left; weights by how much is known (research: least
/// squares over scans). Machine-made wires run straight: there next = p1 + d1 is better. A wire takes the one with the
/// smaller residuals.
///
/// A residual is coded by the width of its magnitude in unary, sign, second-highest bit, and the rest raw. The unary
/// bits are learned relative to the width that is expected: of a running mean of magnitudes along its axis.
namespace ramcdb::codec {
namespace {

constexpr std::uint8_t kWireFormat = 1;

/// More than any blob has, and little enough that hostile counts cost little.
constexpr std::uint32_t kMostPoints = 1 << 20;

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

/// Where the next inner point is expected. `points` holds those before it; `end` is the end corner.
LatticePoint predict(bool linear, const std::vector<LatticePoint>& points, LatticePoint end,
                     std::uint32_t points_left) {
  const std::size_t n = points.size();
  const LatticePoint p1 = points[n - 1];
  const Weights w = n == 1 ? kFirst : n == 2 ? kSecond : points_left <= kNearEndPoints ? kNearEnd : kMidway;
  LatticePoint result;
  for (int a = 0; a < 3; ++a) {
    const std::int64_t d1 = n > 1 ? std::int64_t{p1[a]} - points[n - 2][a] : 0;
    const std::int64_t d2 = n > 2 ? std::int64_t{points[n - 2][a]} - points[n - 3][a] : 0;
    const std::int64_t chord = divide_rounded((std::int64_t{end[a]} - p1[a]) * 1024, std::int64_t{points_left} + 1);
    const std::int64_t step =
        linear && n > 1 ? d1 : divide_rounded(w.d1 * 1024 * d1 + w.d2 * 1024 * d2 + w.chord * chord, 1024 * 1024);
    result[a] = clamp_coordinate(p1[a] + step);
  }
  return result;
}

using Residual = std::array<std::int32_t, 3>;

std::vector<Residual> residuals_of(bool linear, const Wire& wire) {
  std::vector<Residual> residuals;
  std::vector<LatticePoint> points{wire.points.front()};
  const auto inner = static_cast<std::uint32_t>(wire.points.size() - 2);
  for (std::uint32_t i = 0; i < inner; ++i) {
    const LatticePoint p = wire.points[i + 1], expected = predict(linear, points, wire.points.back(), inner - i);
    residuals.push_back({p.x - expected.x, p.y - expected.y, p.z - expected.z});
    points.push_back(p);
  }
  return residuals;
}

int width_of(std::int32_t value) {
  return static_cast<int>(std::bit_width(static_cast<std::uint32_t>(std::abs(std::int64_t{value}))));
}

/// About the bits that residuals take.
std::uint64_t cost_of(const std::vector<Residual>& residuals) {
  std::uint64_t cost = 0;
  for (const Residual& residual : residuals)
    for (const std::int32_t value : residual) cost += static_cast<std::uint64_t>(width_of(value));
  return cost;
}

/// Probability of "wider still", by how the width reached compares to the width expected: -6 or less ... +6 or more.
/// Counted over wires of scans, terrains and machine parts.
constexpr std::array<std::uint16_t, 13> kWider{63500, 63000, 61700, 58500, 55500, 48500, 32500,
                                               18000, 11000, 10000, 8000,  8000,  8000};
constexpr std::uint16_t kWiderWeight = 12;

class ResidualCoder {
 public:
  /// \param expected width of the first residuals
  explicit ResidualCoder(int expected) {
    mean_.fill((std::uint64_t{12} << expected) & ~std::uint64_t{15});
    for (std::size_t i = 0; i < wider_.size(); ++i) wider_[i] = AdaptiveBit(kWider[i], kWiderWeight);
  }

  template <class Coder>
  std::int32_t code(Coder& coder, std::size_t axis, std::int32_t value) {
    const auto magnitude = static_cast<std::uint32_t>(std::abs(std::int64_t{value}));
    const int actual = static_cast<int>(std::bit_width(magnitude));
    const int expected = static_cast<int>(std::bit_width(mean_[axis] >> 4));
    int width = 0;
    while (width < 31 &&
           coder.code(wider_[static_cast<std::size_t>(std::clamp(width - expected, -6, 6) + 6)], actual > width))
      ++width;
    std::uint32_t x = width > 0;
    const bool negative = x && coder.code(negative_[axis], value < 0);
    if (width > 1) {
      const int left = width - 2;
      x = 2 + coder.code(second_[static_cast<std::size_t>(width)], (magnitude >> left) & 1);
      x = x << left | coder.code_raw(magnitude & ((1U << left) - 1), left);
    }
    mean_[axis] = (3 * mean_[axis] + 16 * std::uint64_t{x}) / 4;
    return negative ? -static_cast<std::int32_t>(x) : static_cast<std::int32_t>(x);
  }

 private:
  std::array<std::uint64_t, 3> mean_;  ///< of magnitudes, in 1/16
  std::array<AdaptiveBit, 13> wider_;
  std::array<AdaptiveBit, 3> negative_;
  std::array<AdaptiveBit, 32> second_;
};

[[noreturn]] void corrupt_wires(const char* what) {
  throw Error(Errc::corrupt, std::string("wire blob: ") + what, {}, "run `ramcdb verify`");
}

void require_codable(const WireOfGroup& wire) {
  if (wire.wire->points.size() < 3) throw Error(Errc::invalid_argument, "a wire to be coded has inner points");
  for (const LatticePoint p : wire.wire->points)
    for (int a = 0; a < 3; ++a)
      if (std::abs(std::int64_t{p[a]}) > kMaxLatticeCoordinate)
        throw Error(Errc::invalid_argument, "a point of a wire leaves the lattice");
}

}  // namespace

/// Both directions: `group` is complete when encoding, and gets complete when decoding.
template <class Coder>
class WireGroupCoder {
 public:
  WireGroupCoder(Coder& coder, WireGroup& group) : coder_(coder), group_(group) {}

  void run() {
    const std::uint32_t wires = wires_.code(coder_, static_cast<std::uint32_t>(group_.members_.size()));
    if (wires == 0 || wires > kWireGroupPoints) corrupt_wires("no wires, or too many");
    const int expected = static_cast<int>(coder_.code_raw(Coder::kEncodes ? first_width() : 0, 5));
    ResidualCoder residuals(expected);
    for (std::uint32_t w = 0; w < wires; ++w) {
      if (!Coder::kEncodes) group_.members_.emplace_back();
      code_head(group_.members_[w]);
      const auto& member = group_.members_[w];
      for (std::uint32_t i = member.first; i < member.first + member.count; ++i) {
        if (!Coder::kEncodes) group_.residuals_.emplace_back();
        for (std::size_t a = 0; a < 3; ++a) {
          std::int32_t& value = group_.residuals_[i][a];
          value = residuals.code(coder_, a, value);
        }
      }
    }
  }

 private:
  /// Half a bit over the mean width of the first wire's residuals.
  std::uint32_t first_width() const {
    std::uint64_t sum = 0;
    const std::uint32_t count = 3 * group_.members_.front().count;
    for (std::uint32_t i = 0; i < count; ++i)
      sum += static_cast<std::uint64_t>(width_of(group_.residuals_[i / 3][i % 3]));
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(31, (2 * sum + count) / (2 * count)));
  }

  void code_head(WireGroup::Member& member) {
    if (points_so_far_ >= kWireGroupPoints) corrupt_wires("a wire too many");
    const std::uint32_t skipped = skipped_.code(coder_, member.id.value - last_id_ - 1);
    if (skipped >= ~std::uint32_t{0} - last_id_) corrupt_wires("its ids do not ascend");
    member.id = WireId(last_id_ += skipped + 1);
    const std::uint32_t count = points_.code(coder_, member.count - 1);
    if (count >= kMostPoints - points_so_far_) corrupt_wires("too many points");
    member.first = points_so_far_;
    member.count = count + 1;
    points_so_far_ += member.count;
    member.linear = coder_.code(linear_, member.linear);
  }

  Coder& coder_;
  WireGroup& group_;
  std::uint32_t last_id_ = 0, points_so_far_ = 0;
  AdaptiveUnsigned wires_, skipped_, points_;
  AdaptiveBit linear_;
};

Buffer encode_wires(std::span<const WireOfGroup> wires) {
  if (wires.empty()) throw Error(Errc::invalid_argument, "a wire blob holds a wire");
  WireGroup group;
  std::uint64_t points = 0;
  for (const WireOfGroup& wire : wires) {
    require_codable(wire);
    if (!group.members_.empty() && wire.id <= group.members_.back().id)
      throw Error(Errc::invalid_argument, "the ids of wires to be coded ascend");
    if (points >= kWireGroupPoints) throw Error(Errc::invalid_argument, "more wires than a blob takes");
    const auto count = wire.wire->points.size() - 2;
    if ((points += count) > kMostPoints)
      throw Error(Errc::limit_exceeded, "wires have too many points", {}, "use smaller charts");
    auto blended = residuals_of(false, *wire.wire), linear = residuals_of(true, *wire.wire);
    const bool is_linear = cost_of(linear) < cost_of(blended);
    group.members_.push_back(
        {wire.id, is_linear, static_cast<std::uint32_t>(points - count), static_cast<std::uint32_t>(count)});
    const auto& residuals = is_linear ? linear : blended;
    group.residuals_.insert(group.residuals_.end(), residuals.begin(), residuals.end());
  }
  RangeEncoder encoder;
  WireGroupCoder(encoder, group).run();
  Buffer blob{static_cast<std::uint8_t>(kWireFormat << 4)};
  const Buffer stream = encoder.finish();
  blob.insert(blob.end(), stream.begin(), stream.end());
  const WireGroup decoded(blob);
  if (decoded.members_ != group.members_ || decoded.residuals_ != group.residuals_)
    throw Error(Errc::corrupt, "wires did not come back from their blob", {}, "this is a bug: please report it");
  return blob;
}

std::vector<CodedWireGroup> encode_in_groups(std::span<const WireOfGroup> wires) {
  std::vector<CodedWireGroup> groups;
  for (std::size_t first = 0, next = 0; first < wires.size(); first = next) {
    for (std::size_t points = 0; next < wires.size() && points < kWireGroupPoints; ++next)
      points += wires[next].wire->points.size() - 2;
    groups.push_back({first, next - first, encode_wires(wires.subspan(first, next - first))});
  }
  return groups;
}

WireGroup::WireGroup(Bytes blob) {
  if (blob.empty()) corrupt_wires("no bytes");
  if (blob[0] >> 4 == 0) corrupt_wires("no known format");
  if (blob[0] >> 4 != kWireFormat)
    throw Error(Errc::unsupported_version, "wire blob: unknown format", {}, "use a newer ramcdb");
  if (blob[0] & 15) corrupt_wires("bits that mean nothing");
  RangeDecoder decoder(blob.subspan(1));
  WireGroupCoder(decoder, *this).run();
  decoder.finish();
}

const WireGroup::Member& WireGroup::member(WireId id) const {
  const auto found = std::ranges::lower_bound(members_, id, {}, &Member::id);
  if (found == members_.end() || found->id != id) corrupt_wires("a wire is not in it");
  return *found;
}

Wire WireGroup::wire(WireId id, LatticePoint begin, LatticePoint end, std::uint32_t inner_points) const {
  const Member& coded = member(id);
  if (coded.count != inner_points) corrupt_wires("a wire has another number of points");
  Wire wire{{begin}};
  for (std::uint32_t i = 0; i < inner_points; ++i) {
    const LatticePoint expected = predict(coded.linear, wire.points, end, inner_points - i);
    LatticePoint p;
    for (int a = 0; a < 3; ++a) {
      const std::int64_t value = std::int64_t{expected[a]} + residuals_[coded.first + i][static_cast<std::size_t>(a)];
      if (std::abs(value) > kMaxLatticeCoordinate) corrupt_wires("a point leaves the lattice");
      p[a] = static_cast<std::int32_t>(value);
    }
    wire.points.push_back(p);
  }
  wire.points.push_back(end);
  return wire;
}

std::uint64_t WireGroup::share_of(WireId id, std::uint64_t bytes) const {
  const Member& coded = member(id);
  const auto up_to = [&](std::uint64_t point) { return bytes * point / residuals_.size(); };
  return up_to(std::uint64_t{coded.first} + coded.count) - up_to(coded.first);
}

std::vector<WireId> WireGroup::ids() const {
  std::vector<WireId> ids;
  for (const Member& member : members_) ids.push_back(member.id);
  return ids;
}

}  // namespace ramcdb::codec
