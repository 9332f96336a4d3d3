#include "codec/exact_codec.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "tests/codec/hostile_bytes.h"

namespace ramcdb::codec {
namespace {

using testing::bytes_of;
using testing::hex;
using testing::refuses;

const Lattice kBinary{{-4, 0, 512}, 1.0 / 64};
const Lattice kDecimal{{-4, 0, 512.125}, 0.001, 1000};

std::vector<LatticePoint> snapped(const Lattice& lattice, const std::vector<Point>& positions) {
  std::vector<LatticePoint> points;
  for (const Point& p : positions) points.push_back(lattice.snap(p));
  return points;
}

bool same_bits(const std::vector<Point>& a, const std::vector<Point>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (std::bit_cast<std::uint64_t>(a[i][axis]) != std::bit_cast<std::uint64_t>(b[i][axis])) return false;
  return true;
}

/// Random coordinates made by `number` from a random one in -4 .. 4.
template <class Number>
std::vector<Point> positions_of(std::size_t count, Number&& number) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> near_zero(-4, 4);
  std::vector<Point> positions(count);
  for (Point& p : positions)
    for (int axis = 0; axis < 3; ++axis) p[axis] = number(near_zero(random));
  return positions;
}

double as_float(double x) { return static_cast<double>(static_cast<float>(x)); }
double as_decimal(double x, const char* format) {
  char text[64];
  (void)std::snprintf(text, sizeof text, format, x);
  return std::strtod(text, nullptr);
}

std::size_t coded_size(const std::vector<Point>& positions, const Lattice& lattice, NumberType type) {
  const auto points = snapped(lattice, positions);
  const Buffer blob = encode_exact(positions, points, lattice, type);
  EXPECT_TRUE(same_bits(decode_exact(blob, points, lattice, type), positions));
  return blob.size();
}

TEST(Exact, KeepsEveryBitOfFloatsAndDoubles) {
  for (const Lattice& lattice : {kBinary, kDecimal}) {
    (void)coded_size(positions_of(2000, as_float), lattice, NumberType::float32);
    (void)coded_size(positions_of(2000, as_float), lattice, NumberType::float64);
    (void)coded_size(positions_of(2000, [](double x) { return x; }), lattice, NumberType::float64);
    (void)coded_size(positions_of(2000, [](double x) { return as_decimal(x, "%.5g"); }), lattice, NumberType::float64);
    (void)coded_size({}, lattice, NumberType::float32);
  }
}

TEST(Exact, KeepsSignedZerosAndTheSmallestNumbers) {
  const double tiny = std::numeric_limits<float>::denorm_min(), least = std::numeric_limits<double>::denorm_min();
  for (const Lattice& lattice : {Lattice{{0, 0, 0}, 1.0}, Lattice{{0, 0, 0}, 0.1, 10}, Lattice{{-7, 0, 0}, 0.25}}) {
    (void)coded_size({{0.0, -0.0, 0.0}, {-0.0, 0.0, -0.0}, {tiny, -tiny, 1e-20F}}, lattice, NumberType::float32);
    (void)coded_size({{least, -least, -0.0}, {1e-300, -1e-300, 0.0}}, lattice, NumberType::float64);
  }
}

TEST(Exact, CostsNothingWhereLatticePointsAreAll) {
  const auto on_binary = positions_of(5000, [](double x) { return std::floor(x * 64) / 64; });
  EXPECT_LT(coded_size(on_binary, kBinary, NumberType::float32), 60U);
  const auto on_decimal = positions_of(5000, [](double x) { return as_decimal(x, "%.3f"); });
  EXPECT_LT(coded_size(on_decimal, kDecimal, NumberType::float64), 60U);
  const auto as_floats = positions_of(5000, [](double x) { return as_float(as_decimal(x, "%.3f")); });
  EXPECT_LT(coded_size(as_floats, kDecimal, NumberType::float32), 60U);
}

TEST(Exact, DecimalFractionsCostTheirDecimals) {
  const auto positions = positions_of(5000, [](double x) { return as_decimal(x, "%.5f"); });
  const auto bits = 8.0 * static_cast<double>(coded_size(positions, kDecimal, NumberType::float64)) / 15000;
  EXPECT_LT(bits, 7.6) << "two decimals are 6.6 bits";
}

TEST(Exact, NoiseCostsItsBits) {
  const auto positions = positions_of(5000, as_float);
  const auto bits = 8.0 * static_cast<double>(coded_size(positions, kBinary, NumberType::float32)) / 15000;
  // Numbers of 2 .. 4 have 2^22 of their own to a unit, so 2^16 to a step; half as large ones twice as many.
  EXPECT_LT(bits, 17.6);
  EXPECT_GT(bits, 16.4);
}

TEST(Exact, SaysAboutWhatItCosts) {
  EXPECT_EQ(exact_bits({1, 2, 3}, kBinary, NumberType::float64), 0U);
  EXPECT_EQ(exact_bits({1.001, 2, 3.5}, kDecimal, NumberType::float64), 0U);
  EXPECT_EQ(exact_bits({1.00102, 2, 3.5}, kDecimal, NumberType::float64), 8U);
  EXPECT_GT(exact_bits({1.0 / 3, 2, 3}, kBinary, NumberType::float64), 45U);
}

TEST(Exact, RefusesWhatDoesNotBelong) {
  const std::vector<LatticePoint> points{kBinary.snap({1, 1, 1})};
  const auto encode = [&](const Point& p, NumberType type) { return encode_exact({{p}}, points, kBinary, type); };
  EXPECT_NO_THROW((void)encode({1.001, 1, 1}, NumberType::float64));
  EXPECT_THROW((void)encode({1.001, 1, 1}, NumberType::float32), Error) << "no float32";
  EXPECT_THROW((void)encode({1, 1, 1}, NumberType::int32), Error);
  EXPECT_THROW((void)encode({1.01, 1, 1}, NumberType::float64), Error) << "the next lattice point";
  EXPECT_THROW((void)encode({1, 1, std::nan("")}, NumberType::float64), Error);
  EXPECT_THROW((void)encode_exact({}, points, kBinary, NumberType::float32), Error);
}

TEST(Exact, DamagedBlobsAreRefused) {
  for (const Lattice& lattice : {kBinary, kDecimal}) {
    const auto positions = positions_of(40, [](double x) { return as_decimal(x, "%.4g"); });
    auto points = snapped(lattice, positions);
    const Buffer blob = encode_exact(positions, points, lattice, NumberType::float64);
    const auto decode = [&](Bytes bytes) { (void)decode_exact(bytes, points, lattice, NumberType::float64); };
    testing::expect_refuses_other_lengths(decode, blob);
    EXPECT_EQ(testing::count_taken_when_damaged(decode, blob), 0);
    ++points[20].y;
    EXPECT_TRUE(refuses(decode, blob)) << "of a vertex elsewhere";
    std::mt19937 random(3);
    for (int run = 0; run < 2000; ++run) {
      Buffer noise(random() % 100);
      for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
      if (!noise.empty()) noise[0] = 1;
      EXPECT_TRUE(refuses(decode, noise));
    }
  }
}

TEST(Exact, BytesStayTheSame) {
  const std::vector<Point> positions{{0.5, -0.25, 512}, {1.0 / 3, as_decimal(0.1, "%g"), 600}, {-0.0, 2, 513.25}};
  const auto coded = [&](const Lattice& lattice) {
    return hex(encode_exact(positions, snapped(lattice, positions), lattice, NumberType::float64));
  };
  EXPECT_EQ(coded(kBinary), "012053d7d0ff9f3a9de41392d5529d83c93db677cc068b");
  EXPECT_EQ(coded(kDecimal), "012053d7d0a42406cf37819f734817");
}

}  // namespace
}  // namespace ramcdb::codec
