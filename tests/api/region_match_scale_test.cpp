#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>

#include "tests/api/edited_region.h"

namespace ramcdb::test {
namespace {

/// A million faces come back in any way.
class RegionMatchScale : public ::testing::Test {
 protected:
  void expect_true(const char* what, const EditedRegion& edited, bool with_ids) {
    const detail::RegionFaces faces(region_);
    const std::clock_t start = std::clock();
    const detail::RegionMatch match = detail::match_region(region_, faces, edited.other(with_ids));
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    std::printf("%-40s %8zu faces %6.2f s of CPU\n", what, edited.face_count(), seconds);
    std::size_t wrong = 0;
    for (std::size_t g = 0; g < edited.face_count(); ++g) wrong += match.faces[g].face != edited.face_was[g];
    for (std::size_t w = 0; w < edited.points.size(); ++w)
      wrong += match.vertices[match.vertex[w]].region != edited.vertex_was[w];
    EXPECT_EQ(wrong, 0U) << what;
  }
  [[nodiscard]] EditedRegion reordered(EditedRegion edited) const {
    edited.shuffle(1);
    return edited;
  }

  RegionMesh region_ = region_of(irregular(scan(1'000'000)), 24);
};

TEST_F(RegionMatchScale, AMillionFacesAreFoundAgain) {
  const EditedRegion same(region_);
  expect_true("ids kept", reordered(same), true);
  expect_true("reordered", reordered(same), false);
  EditedRegion soup = same;
  soup.explode();
  expect_true("a soup", soup, false);

  EditedRegion inside = same;
  inside.move([&](std::uint32_t v) { return !region_.outer_border[v]; });
  expect_true("moved inside", inside, false);
  expect_true("moved inside, ids kept, reordered", reordered(inside), true);
  expect_true("moved inside, reordered", reordered(inside), false);
  EditedRegion moved_soup = reordered(inside);
  moved_soup.explode();
  expect_true("moved inside, reordered, a soup", moved_soup, false);

  EditedRegion remeshed = same;
  remeshed.remesh(0.01, 2);
  expect_true("1 % remeshed", remeshed, false);
  expect_true("1 % remeshed, ids kept", remeshed, true);
  expect_true("1 % remeshed, reordered", reordered(remeshed), false);

  EditedRegion all = same;
  all.move([](std::uint32_t) { return true; });
  expect_true("all moved, reordered", reordered(all), false);
}

}  // namespace
}  // namespace ramcdb::test
