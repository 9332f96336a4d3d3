#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "ramcdb/error.h"
#include "ramcdb/geometry.h"

namespace ramcdb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Lattice, PointsAreWithinHalfAStepOfTheirPlaces) {
  std::mt19937_64 random(1);
  for (int run = 0; run < 20000; ++run) {
    const double step =
        std::ldexp(1 + static_cast<double>(random() % 1000) / 1000, static_cast<int>(random() % 40) - 30);
    const auto anywhere = [&] { return (static_cast<double>(random() % 2000001) / 1000000 - 1) * 1e6 * step; };
    const Lattice lattice{{anywhere(), anywhere(), anywhere()}, step};
    const Point p{anywhere(), anywhere(), anywhere()};
    const Point back = lattice.position(lattice.snap(p));
    for (int a = 0; a < 3; ++a) EXPECT_LE(std::abs(back[a] - p[a]), step * 0.5 * (1 + 1e-9)) << "run " << run;
  }
}

TEST(Lattice, SnappingTwiceIsSnappingOnce) {
  std::mt19937_64 random(2);
  for (int run = 0; run < 20000; ++run) {
    const Lattice lattice{
        {std::ldexp(static_cast<double>(random() % 1000), -5), -3.7e4, 1e-3 * static_cast<double>(run)},
        std::ldexp(1.37, static_cast<int>(random() % 20) - 12)};
    LatticePoint i;
    for (int a = 0; a < 3; ++a)
      i[a] = static_cast<std::int32_t>(random() % (2u * kMaxLatticeCoordinate)) - kMaxLatticeCoordinate;
    EXPECT_EQ(lattice.snap(lattice.position(i)), i);
  }
}

TEST(Lattice, StepsPerUnitGiveTheDoublesThatDecimalsReadAs) {
  std::mt19937_64 random(5);
  for (const double per_unit : {10.0, 50.0, 200.0, 1000.0, 1e6}) {
    const Lattice lattice{{-12.5, 449'320, 0}, 1 / per_unit, per_unit};
    for (int run = 0; run < 20000; ++run) {
      const auto i = static_cast<std::int32_t>(random() % (1U << 28));
      const Point p = lattice.position({i, i, -i});
      const auto expect_reads_as = [&](double number, double steps) {
        char text[64];
        (void)std::snprintf(text, sizeof text, "%.6f", number);
        EXPECT_EQ(number, std::strtod(text, nullptr)) << text;
        EXPECT_NEAR(number, steps / per_unit, 1e-9);
      };
      expect_reads_as(p.x, i - 12.5 * per_unit);
      expect_reads_as(p.y, i + 449'320 * per_unit);
      EXPECT_EQ(lattice.snap(p), (LatticePoint{i, i, -i}));
    }
  }
}

TEST(Lattice, HalvesRoundUpAndNothingElseDoes) {
  const Lattice unit{{0, 0, 0}, 1};
  EXPECT_EQ(unit.snap({0.5, -0.5, 1.5}), (LatticePoint{1, 0, 2}));
  const double below_half = std::nextafter(0.5, 0.0);
  EXPECT_EQ(unit.snap({below_half, -below_half, -0.5 - 1e-9}), (LatticePoint{0, 0, -1}));
  EXPECT_EQ(unit.snap({-0.0, 0.0, -1.5}), (LatticePoint{0, 0, -1}));
}

TEST(Lattice, TheLastPointsOfTheLatticeAreReached) {
  const Lattice lattice{{10, 0, -10}, 0.25};
  const LatticePoint last{kMaxLatticeCoordinate, -kMaxLatticeCoordinate, kMaxLatticeCoordinate};
  EXPECT_EQ(lattice.snap(lattice.position(last)), last);
}

Errc code_of(const Lattice& lattice, const Point& p) {
  try {
    (void)lattice.snap(p);
  } catch (const Error& e) {
    return e.code();
  }
  return Errc::cancelled;  // stands for "took it"
}

TEST(Lattice, RefusesWhatLiesBeyond) {
  const Lattice unit{{0, 0, 0}, 1};
  EXPECT_EQ(code_of(unit, {0, double(kMaxLatticeCoordinate) + 0.4, 0}), Errc::cancelled);
  EXPECT_EQ(code_of(unit, {0, double(kMaxLatticeCoordinate) + 0.5, 0}), Errc::limit_exceeded);
  EXPECT_EQ(code_of(unit, {0, 0, -double(kMaxLatticeCoordinate) - 1}), Errc::limit_exceeded);
  EXPECT_EQ(code_of(unit, {1e300, 0, 0}), Errc::limit_exceeded);
  EXPECT_EQ(code_of({{-1e308, 0, 0}, 1e-300}, {1e308, 0, 0}), Errc::limit_exceeded);
  EXPECT_EQ(code_of({{0, 0, 0}, 0}, {1, 0, 0}), Errc::limit_exceeded);
  for (const double bad : {kInfinity, -kInfinity, std::nan("")})
    for (int a = 0; a < 3; ++a) {
      Point p;
      p[a] = bad;
      EXPECT_EQ(code_of(unit, p), Errc::invalid_argument);
    }
}

TEST(Lattice, ErrorsSayWhereAndHowToGoOn) {
  try {
    (void)Lattice{{0, 0, 0}, 1}.snap({0, 2.5e12, 0});
    ADD_FAILURE() << "took a point that lies beyond";
  } catch (const Error& e) {
    EXPECT_STREQ(
        e.what(),
        "a coordinate is too far away for the mesh's lattice (y = 2.5e+12): stay within 2^30 steps of its origin");
  }
}

}  // namespace
}  // namespace ramcdb
