#include "codec/wire_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "ramcdb/error.h"
#include "tests/codec/hostile_bytes.h"

namespace ramcdb::codec {
namespace {

constexpr std::int32_t kFar = kMaxLatticeCoordinate;

Wire line(int inner_points, LatticePoint step) {
  Wire wire;
  for (std::int32_t i = 0; i <= inner_points + 1; ++i) wire.points.push_back({i * step.x, 7 + i * step.y, i * step.z});
  return wire;
}

Wire walk(int inner_points, std::int32_t reach, std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto step = [&] {
    return static_cast<std::int32_t>(random() % (2 * static_cast<std::uint32_t>(reach) + 1)) - reach;
  };
  Wire wire{{{0, 0, 0}}};
  for (int i = 0; i <= inner_points; ++i) {
    const LatticePoint p = wire.points.back();
    wire.points.push_back({p.x + step(), p.y + step(), p.z + step()});
  }
  return wire;
}

Wire circle(int inner_points, double radius) {
  Wire wire;
  for (int i = 0; i <= inner_points + 1; ++i) {
    const double t = 2 * M_PI * (i % (inner_points + 1)) / (inner_points + 1);
    wire.points.push_back({static_cast<std::int32_t>(std::lround(radius * std::cos(t))),
                           static_cast<std::int32_t>(std::lround(radius * std::sin(t))), i % 3});
  }
  wire.points.back() = wire.points.front();
  return wire;
}

/// From one end of the lattice to the other and back, in all directions.
Wire extremes(int inner_points) {
  Wire wire;
  for (int i = 0; i <= inner_points + 1; ++i)
    wire.points.push_back({i % 2 ? kFar : -kFar, i / 2 % 2 ? kFar : -kFar, i / 4 % 2 ? kFar : -kFar});
  return wire;
}

std::vector<Wire> wires() {
  std::vector<Wire> all{line(1, {0, 0, 0}), line(1, {5, 1, -2}), line(200, {13, -4, 1}), line(50, {0, 0, 0}),
                        circle(3, 10),      circle(60, 5000),    circle(300, 1e9),       extremes(1),
                        extremes(2),        extremes(40)};
  for (std::uint32_t seed = 1; seed <= 200; ++seed)
    all.push_back(walk(static_cast<int>(1 + seed % 70), 1 << (seed % 23), seed));
  return all;
}

std::uint32_t inner_points(const Wire& wire) { return static_cast<std::uint32_t>(wire.points.size() - 2); }

/// A wire alone in its blob.
Buffer encode(const Wire& wire) {
  const WireOfGroup alone{WireId(7), &wire};
  return encode_wires(std::span(&alone, 1));
}

Wire decode(Bytes blob, const Wire& like) {
  return WireGroup(blob).wire(WireId(7), like.points.front(), like.points.back(), inner_points(like));
}

/// Every third id.
std::vector<WireOfGroup> numbered(const std::vector<Wire>& wires) {
  std::vector<WireOfGroup> group;
  for (const Wire& wire : wires) group.push_back({WireId(static_cast<std::uint32_t>(3 * group.size() + 1)), &wire});
  return group;
}

TEST(WireCodec, WiresComeBack) {
  for (const Wire& wire : wires()) {
    const Buffer blob = encode(wire);
    EXPECT_EQ(decode(blob, wire), wire);
    EXPECT_EQ(encode(wire), blob);
  }
}

TEST(WireCodec, WiresOfAGroupComeBackOneByOne) {
  const std::vector<Wire> all = wires();
  const std::vector<WireOfGroup> numbers = numbered(all);
  std::size_t together = 0, alone = 0;
  for (const CodedWireGroup& group : encode_in_groups(numbers)) {
    const WireGroup decoded(group.blob);
    for (const WireOfGroup& each : std::span(numbers).subspan(group.first, group.count)) {
      const Wire& wire = *each.wire;
      EXPECT_EQ(decoded.wire(each.id, wire.points.front(), wire.points.back(), inner_points(wire)), wire);
    }
    together += group.blob.size();
  }
  for (const Wire& wire : all) alone += encode(wire).size();
  EXPECT_LT(together, alone);
}

TEST(WireCodec, AFullBlobTakesNoFurtherWire) {
  const Wire nearly = walk(kWireGroupPoints - 1, 3, 1), full = walk(kWireGroupPoints, 3, 1), next = line(5, {1, 2, 3});
  const std::vector<WireOfGroup> legal{{WireId(1), &nearly}, {WireId(2), &full}},
      too_many{{WireId(1), &full}, {WireId(2), &next}};
  EXPECT_EQ(WireGroup(encode_wires(legal)).ids().size(), 2U);
  EXPECT_THROW((void)encode_wires(too_many), Error);
  // What an encoder without that rule wrote for points that are all the same.
  const Buffer hostile{0x10, 0x40, 0x80, 0x38, 0x0f, 0xff, 0xff, 0x7f, 0xff, 0xa2};
  EXPECT_THROW((void)WireGroup(hostile), Error);
}

TEST(WireCodec, AWireStaysReadableWhenTheEndsOfOthersMove) {
  const Wire first = walk(20, 50, 1), second = walk(20, 50, 2);
  const std::vector<WireOfGroup> group{{WireId(1), &first}, {WireId(2), &second}};
  const WireGroup decoded(encode_wires(group));
  (void)decoded.wire(WireId(1), {5, 5, 5}, {-100, 7, 9}, 20);
  EXPECT_EQ(decoded.wire(WireId(2), second.points.front(), second.points.back(), 20), second);
}

TEST(WireCodec, OtherWiresAndOtherCountsAreRefused) {
  const Wire wire = walk(20, 50, 1);
  const WireGroup decoded(encode(wire));
  const auto refuses = [&](std::uint32_t id, std::uint32_t count) {
    try {
      (void)decoded.wire(WireId(id), wire.points.front(), wire.points.back(), count);
    } catch (const Error& e) {
      return e.code() == Errc::corrupt;
    }
    return false;
  };
  for (const std::uint32_t id : {0U, 6U, 8U, 0xffffffffU}) EXPECT_TRUE(refuses(id, 20));
  for (const std::uint32_t count : {0U, 1U, 19U, 21U, 1U << 20, 0xffffffffU}) EXPECT_TRUE(refuses(7, count));
  EXPECT_THROW((void)decoded.share_of(WireId(8), 100), Error);
}

TEST(WireCodec, SharesOfABlobAddUp) {
  const std::vector<Wire> all{line(200, {13, -4, 1}), walk(9, 40, 3), circle(60, 5000), extremes(40),
                              line(1, {0, 0, 0})};
  const std::vector<WireOfGroup> group = numbered(all);
  const WireGroup decoded(encode_wires(group));
  std::uint64_t sum = 0;
  for (const WireOfGroup& each : group) sum += decoded.share_of(each.id, 12345);
  EXPECT_EQ(sum, 12345U);
}

TEST(WireCodec, GroupsAreOfAboutOneSizeAndTakeEveryWireOnce) {
  std::vector<Wire> all;
  for (std::uint32_t i = 0; i < 300; ++i) all.push_back(walk(static_cast<int>(1 + i % 90), 9, i));
  const std::vector<WireOfGroup> wires = numbered(all);
  std::size_t next = 0;
  const std::vector<CodedWireGroup> groups = encode_in_groups(wires);
  for (const CodedWireGroup& group : groups) {
    EXPECT_EQ(group.first, next);
    next += group.count;
    std::vector<WireId> ids;
    std::size_t points = 0;
    for (std::size_t i = group.first; i < next; ++i) {
      ids.push_back(wires[i].id);
      points += inner_points(*wires[i].wire);
    }
    EXPECT_EQ(WireGroup(group.blob).ids(), ids);
    EXPECT_LT(points, kWireGroupPoints + 90);
    if (next < wires.size()) {
      EXPECT_GE(points, kWireGroupPoints);
    }
  }
  EXPECT_EQ(next, wires.size());
  EXPECT_TRUE(encode_in_groups({}).empty());
}

TEST(WireCodec, StraightWiresTakeHardlyAnyBits) {
  EXPECT_LE(encode(line(200, {13, -4, 1})).size(), 25u);
  EXPECT_LE(encode(circle(300, 20000)).size(), 300u * 3);
}

TEST(WireCodec, TheLargestWireComesBack) {
  const Wire wire = walk(1 << 20, 3, 5);
  EXPECT_EQ(decode(encode(wire), wire), wire);
  try {
    (void)encode(walk((1 << 20) + 1, 3, 5));
    ADD_FAILURE() << "took a wire of too many points";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::limit_exceeded);
  }
}

TEST(WireCodec, RefusesWhatIsNoWire) {
  const auto refuses_to_encode = [](std::span<const WireOfGroup> wires) {
    try {
      (void)encode_wires(wires);
    } catch (const Error& e) {
      return e.code() == Errc::invalid_argument;
    }
    return false;
  };
  EXPECT_TRUE(refuses_to_encode({}));
  const std::vector<Wire> bad{{},
                              {{{0, 0, 0}}},
                              {{{0, 0, 0}, {1, 0, 0}}},
                              {{{0, 0, 0}, {0, kFar + 1, 0}, {0, 0, 0}}},
                              {{{0, 0, 0}, {0, 0, -kFar - 1}, {0, 0, 0}}},
                              {{{0, 0, 0}, {std::numeric_limits<std::int32_t>::min(), 0, 0}, {0, 0, 0}}}};
  for (const Wire& wire : bad) {
    const WireOfGroup alone{WireId(1), &wire};
    EXPECT_TRUE(refuses_to_encode(std::span(&alone, 1)));
  }
  const Wire good = line(3, {1, 2, 3});
  const std::vector<WireOfGroup> twice{{WireId(4), &good}, {WireId(4), &good}},
      falling{{WireId(4), &good}, {WireId(3), &good}};
  EXPECT_TRUE(refuses_to_encode(twice));
  EXPECT_TRUE(refuses_to_encode(falling));
}

/// Decodes with the ends of `wire`, and looks at what comes.
auto decoder_of(const Wire& wire) {
  return [&wire](Bytes bytes) {
    const Wire other = decode(bytes, wire);
    ASSERT_EQ(other.points.size(), wire.points.size());
    EXPECT_EQ(other.points.front(), wire.points.front());
    EXPECT_EQ(other.points.back(), wire.points.back());
    for (const LatticePoint p : other.points)
      for (int a = 0; a < 3; ++a) ASSERT_LE(std::abs(p[a]), kFar);
  };
}

TEST(WireCodec, OtherLengthsGiveAWireOfTheLatticeOrAnError) {
  for (const Wire& wire : wires()) testing::expect_survives_other_lengths(decoder_of(wire), encode(wire));
}

TEST(WireCodec, DamagedBytesGiveAWireOfTheLatticeOrAnError) {
  int taken = 0;
  for (const Wire& wire : wires())
    if (wire.points.size() < 25) taken += testing::count_taken_when_damaged(decoder_of(wire), encode(wire));
  EXPECT_GT(taken, 0) << "otherwise nothing but refusals was tried";
}

TEST(WireCodec, UnknownFormatsAreRefused) {
  const Wire wire = line(4, {3, 2, 1});
  const auto code_with = [&](int head) {
    Buffer blob = encode(wire);
    blob[0] = static_cast<std::uint8_t>(head);
    try {
      (void)decode(blob, wire);
    } catch (const Error& e) {
      return e.code();
    }
    return Errc::cancelled;  // stands for "took it"
  };
  EXPECT_EQ(code_with(0x00), Errc::corrupt);
  EXPECT_EQ(code_with(0x12), Errc::corrupt);
  EXPECT_EQ(code_with(0x20), Errc::unsupported_version);
}

TEST(WireCodec, GoldenBytes) {
  // Bytes of format 1: never to change.
  EXPECT_EQ(testing::hex(encode(line(4, {3, 2, 1}))), "106021ffdc");
  EXPECT_EQ(testing::hex(encode(circle(7, 100))), "106421033eb249ccebde0533f3d09462c79c1b6fd16d");
  EXPECT_EQ(testing::hex(encode(extremes(3))), "107122000000009ff7cd3050555cfe443f8b3d6ec0b49f7a16f36c7e4986152727d9");
  const Wire first = walk(9, 40, 3), second = walk(2, 4000, 4);
  const std::vector<WireOfGroup> two{{WireId(1), &first}, {WireId(900), &second}};
  EXPECT_EQ(testing::hex(encode_wires(two)),
            "10448fc510fe0abfd11917c37f322dce485c2b93e83adce3f0847f83a8a31360f4fc8698c2e73caf38fe1e5451d3ba");
}

}  // namespace
}  // namespace ramcdb::codec
