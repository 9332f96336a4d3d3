#include "codec/wire_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

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

Wire decode(const Buffer& blob, const Wire& like) {
  return decode_wire(blob, like.points.front(), like.points.back(), static_cast<std::uint32_t>(like.points.size() - 2));
}

TEST(WireCodec, WiresComeBack) {
  for (const Wire& wire : wires()) {
    const Buffer blob = encode_wire(wire);
    EXPECT_FALSE(blob.empty());
    EXPECT_EQ(decode(blob, wire), wire);
    EXPECT_EQ(encode_wire(wire), blob);
  }
}

TEST(WireCodec, WiresWithoutInnerPointsTakeNoBytes) {
  const Wire wire{{{1, 2, 3}, {-4, 5, 6}}};
  EXPECT_TRUE(encode_wire(wire).empty());
  EXPECT_EQ(decode_wire({}, {1, 2, 3}, {-4, 5, 6}, 0), wire);
  EXPECT_THROW((void)decode_wire(Buffer{16}, {1, 2, 3}, {-4, 5, 6}, 0), Error);
  EXPECT_THROW((void)decode_wire({}, {1, 2, 3}, {-4, 5, 6}, 1), Error);
}

TEST(WireCodec, StraightWiresTakeHardlyAnyBits) {
  EXPECT_LE(encode_wire(line(200, {13, -4, 1})).size(), 20u);
  EXPECT_LE(encode_wire(circle(300, 20000)).size(), 300u * 3);
}

TEST(WireCodec, TheLargestWireComesBack) {
  const Wire wire = walk(1 << 20, 3, 5);
  EXPECT_EQ(decode(encode_wire(wire), wire), wire);
  try {
    (void)encode_wire(walk((1 << 20) + 1, 3, 5));
    ADD_FAILURE() << "took a wire of too many points";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::limit_exceeded);
  }
}

TEST(WireCodec, RefusesWhatIsNoWire) {
  const auto refuses_to_encode = [](const Wire& wire) {
    try {
      (void)encode_wire(wire);
    } catch (const Error& e) {
      return e.code() == Errc::invalid_argument;
    }
    return false;
  };
  EXPECT_TRUE(refuses_to_encode({}));
  EXPECT_TRUE(refuses_to_encode({{{0, 0, 0}}}));
  EXPECT_TRUE(refuses_to_encode({{{0, 0, 0}, {0, kFar + 1, 0}}}));
  EXPECT_TRUE(refuses_to_encode({{{0, 0, 0}, {0, 0, -kFar - 1}, {0, 0, 0}}}));
  EXPECT_TRUE(refuses_to_encode({{{0, 0, 0}, {std::numeric_limits<std::int32_t>::min(), 0, 0}}}));
}

/// Decodes with the ends of `wire`, and looks at what comes.
auto decoder_of(const Wire& wire) {
  return [&wire](Bytes bytes) {
    const Wire other =
        decode_wire(bytes, wire.points.front(), wire.points.back(), static_cast<std::uint32_t>(wire.points.size() - 2));
    ASSERT_EQ(other.points.size(), wire.points.size());
    EXPECT_EQ(other.points.front(), wire.points.front());
    EXPECT_EQ(other.points.back(), wire.points.back());
    for (const LatticePoint p : other.points)
      for (int a = 0; a < 3; ++a) ASSERT_LE(std::abs(p[a]), kFar);
  };
}

TEST(WireCodec, OtherLengthsGiveAWireOfTheLatticeOrAnError) {
  for (const Wire& wire : wires()) testing::expect_survives_other_lengths(decoder_of(wire), encode_wire(wire));
}

TEST(WireCodec, DamagedBytesGiveAWireOfTheLatticeOrAnError) {
  int taken = 0;
  for (const Wire& wire : wires())
    if (wire.points.size() < 25) taken += testing::count_taken_when_damaged(decoder_of(wire), encode_wire(wire));
  EXPECT_GT(taken, 0) << "otherwise nothing but refusals was tried";
}

TEST(WireCodec, AnotherNumberOfPointsIsMostlyRefusedAndNeverHarmful) {
  int taken = 0, tried = 0;
  for (const Wire& wire : wires()) {
    const Buffer blob = encode_wire(wire);
    for (const std::uint32_t count : {1u, 2u, 1000u, 1u << 20, (1u << 20) + 1, 0xffffffffu}) {
      if (count == wire.points.size() - 2) continue;
      ++tried;
      taken += !testing::refuses(
          [&](Bytes bytes) { (void)decode_wire(bytes, wire.points.front(), wire.points.back(), count); }, blob);
    }
  }
  EXPECT_LT(taken, tried / 20);
}

TEST(WireCodec, UnknownFormatsAndPredictorsAreRefused) {
  const Wire wire = line(4, {3, 2, 1});
  const auto code_with = [&](int head) {
    Buffer blob = encode_wire(wire);
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
  EXPECT_EQ(testing::hex(encode_wire(line(4, {3, 2, 1}))), "10ffffffa8");
  EXPECT_EQ(testing::hex(encode_wire(circle(7, 100))), "100034ed03e22a18806577d9f96d3038df2fb80b3a");
  EXPECT_EQ(testing::hex(encode_wire(extremes(3))), "1121cce6011fe1c6cd4069d749624554f778e98a412adc17");
  EXPECT_EQ(testing::hex(encode_wire(walk(9, 40, 3))), "108e475ecc52b29de13af89d2d7ec1009269f1d33141afcd00e26f");
}

}  // namespace
}  // namespace ramcdb::codec
