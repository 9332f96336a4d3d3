#include "api/file_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "api/border_snap.h"
#include "tests/api/edited_region.h"

namespace ramcdb::test {
namespace {

using detail::FileFrame;
using detail::find_frame;

class ReturnedCoordinates : public ::testing::Test {
 protected:
  /// What a program writes that turns and scales.
  template <class Change>
  [[nodiscard]] std::vector<Point> changed(Change&& change, bool as_floats = true) const {
    std::vector<Point> points;
    for (const LatticePoint p : region_.points) {
      Point q = lattice_.position(p);
      for (int a = 0; a < 3; ++a) q[a] -= origin_[a];
      q = change(q);
      for (int a = 0; as_floats && a < 3; ++a) q[a] = static_cast<float>(q[a]);
      points.push_back(q);
    }
    return points;
  }
  [[nodiscard]] std::optional<FileFrame> frame_of(const std::vector<Point>& positions) const {
    return find_frame(region_, lattice_, origin_, positions);
  }

  RegionMesh region_ = region_of(terrain(30, 20), 16);
  Lattice lattice_{{500, 10, -3}, 0.001};
  Point origin_{520, 0, 0};
};

TEST_F(ReturnedCoordinates, AxesAndUnitsAreFound) {
  const auto up = frame_of(changed([](Point p) { return Point{p.x, p.z, -p.y}; }));
  ASSERT_TRUE(up);
  EXPECT_EQ(up->describe(), "axes x,y,z <- x,-z,y; scale 1");
  const auto metres = frame_of(changed([](Point p) { return Point{p.x / 1000, p.y / 1000, p.z / 1000}; }));
  ASSERT_TRUE(metres);
  EXPECT_EQ(metres->describe(), "axes x,y,z <- x,y,z; scale 1000");
  const auto both = frame_of(changed([](Point p) { return Point{-25.4 * p.y, 25.4 * p.x, 25.4 * p.z}; }));
  ASSERT_TRUE(both);
  EXPECT_EQ(both->describe(), "axes x,y,z <- y,-x,z; scale 0.0393701");
  EXPECT_NEAR(both->apply({-50.8, 25.4, 76.2}).x, 1, 1e-12);
  EXPECT_NEAR(both->apply({-50.8, 25.4, 76.2}).y, 2, 1e-12);
}

TEST_F(ReturnedCoordinates, WhatIsNoFrameIsLeftAlone) {
  const auto same = [](Point p) { return p; };
  EXPECT_FALSE(frame_of(changed(same)));
  EXPECT_FALSE(frame_of(changed([](Point p) { return Point{p.x * 1.1, p.y, p.z}; })));
  EXPECT_FALSE(frame_of(changed([](Point p) { return Point{-p.x, p.y, p.z}; }))) << "a mirror is an edit";
  // A part moved: the border tells that nothing else did.
  std::vector<Point> moved = changed(same);
  for (std::size_t v = 0; v < moved.size(); ++v)
    if (!region_.outer_border[v]) moved[v].z += 5;
  EXPECT_FALSE(frame_of(moved));
}

TEST_F(ReturnedCoordinates, AnEditInAnotherFrameIsFoundByItsBorder) {
  std::vector<Point> edited = changed([](Point p) { return Point{p.z / 10, p.x / 10, p.y / 10}; });
  for (std::size_t v = 0; v < edited.size(); ++v)
    if (!region_.outer_border[v]) edited[v].x += 0.5;
  ASSERT_TRUE(frame_of(edited));
  EXPECT_EQ(frame_of(edited)->describe(), "axes x,y,z <- y,z,x; scale 10");
}

TEST(FileFrameOfClosedMeshes, AMeshWithoutBorderMayHaveBeenTurnedOnPurpose) {
  RegionMesh blob = region_of(scan(2000), 14);
  blob.outer_border.assign(blob.outer_border.size(), false);
  const Lattice lattice{{0, 0, 0}, 0.5};
  std::vector<Point> turned;
  for (const LatticePoint p : blob.points) {
    const Point q = lattice.position(p);
    turned.push_back({q.y, -q.x, q.z});
  }
  EXPECT_FALSE(find_frame(blob, lattice, {}, turned));
}

TEST(BorderSnap, LossesOfNumberFormats) {
  EXPECT_DOUBLE_EQ(detail::float32_loss(1), std::ldexp(1.0, -23));
  EXPECT_DOUBLE_EQ(detail::float32_loss(1000), std::ldexp(1.0, -14));
  EXPECT_NEAR(detail::decimal_loss(6, 1234.57), 0.01, 1e-9);
  EXPECT_NEAR(detail::decimal_loss(6, 0.5), 1e-6, 1e-12);
  const std::vector<Point> fine{{1234.56789, 0.1, 7}, {3.25, 99.0001, 1000.125}};
  EXPECT_NEAR(detail::coordinate_loss(fine, std::vector<Point>{{1234.57, 0.1, 7}, {3.25, 99.0001, 1000.12}}), 0.01,
              1e-9);
  EXPECT_EQ(detail::coordinate_loss(fine, fine), 0);
  std::vector<Point> floats = fine;
  for (Point& p : floats)
    for (int a = 0; a < 3; ++a) p[a] = static_cast<float>(p[a]);
  EXPECT_DOUBLE_EQ(detail::coordinate_loss(fine, floats), std::ldexp(1.0, -13));
  const std::vector<Point> whole{{1, 2, 3}, {4, 50, 6}};
  EXPECT_EQ(detail::coordinate_loss(whole, std::vector<Point>{{1, 2, 3}, {4, 51, 6}}), 0) << "nothing to lose";
}

TEST(BorderSnap, RoundedBorderVerticesGoBackAndMovedOnesStay) {
  const RegionMesh region = region_of(terrain(20, 10), 16);
  const Lattice lattice{{0, 0, 0}, 0.001};
  EditedRegion edited(region);
  edited.shuffle(3);
  std::vector<Point> positions;
  std::uint32_t moved = ~0U, inner = ~0U;
  for (std::uint32_t w = 0; w < edited.points.size(); ++w) {
    edited.points[w].x += 2;
    if (region.outer_border[edited.vertex_was[w]] ? moved == ~0U : inner == ~0U) {
      edited.points[w].x += 60;
      (region.outer_border[edited.vertex_was[w]] ? moved : inner) = w;
    }
    positions.push_back(lattice.position(edited.points[w]));
  }
  const detail::RegionMatch match = detail::match_region(region, detail::RegionFaces(region), edited.other(true));
  const std::vector<LatticePoint> before = edited.points;
  const auto snapped = detail::snap_back_border(region, lattice, match, 0.0025, positions, edited.points);
  std::uint64_t expected = 0;
  for (std::uint32_t w = 0; w < edited.points.size(); ++w) {
    const std::uint32_t v = edited.vertex_was[w];
    const bool back = region.outer_border[v] && w != moved;
    expected += back;
    EXPECT_EQ(edited.points[w], back ? region.points[v] : before[w]);
    EXPECT_EQ(positions[w], lattice.position(edited.points[w]));
  }
  EXPECT_EQ(snapped.vertices, expected);
  EXPECT_NEAR(snapped.largest, 0.002, 1e-9);
}

}  // namespace
}  // namespace ramcdb::test
