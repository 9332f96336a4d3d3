#include "api/border_links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "api/surface.h"
#include "api/topology.h"

namespace ramcdb::test {
namespace {

using detail::kNowhere;

/// Vertices 0..4 are shared: a row that faces outside lie along. Behind it, vertices of the surface's own.
constexpr std::uint32_t kShared = 5;

std::vector<std::uint32_t> changed(const std::vector<Triangle>& before, const std::vector<Triangle>& after) {
  std::vector<std::uint32_t> shared(20, kNowhere);
  for (std::uint32_t v = 0; v < kShared; ++v) shared[v] = v;
  const std::vector<bool> found = detail::changed_links({before, shared}, {after, shared}, kShared);
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t v = 0; v < kShared; ++v)
    if (found[v]) vertices.push_back(v);
  return vertices;
}

using Vertices = std::vector<std::uint32_t>;

/// A strip along the row.
const std::vector<Triangle> kStrip{{0, 1, 5}, {1, 6, 5}, {1, 2, 6}, {2, 7, 6}, {2, 3, 7}, {3, 8, 7}, {3, 4, 8}};

TEST(BorderLinks, FacesThatAreCutAtTheBorderChangeNothingForOthers) {
  EXPECT_EQ(changed(kStrip, kStrip), Vertices{});
  std::vector<Triangle> split = kStrip;
  split[2] = {1, 2, 9};
  split.insert(split.end(), {{2, 6, 9}, {6, 1, 9}});
  EXPECT_EQ(changed(kStrip, split), Vertices{});
  std::vector<Triangle> flipped = kStrip;
  flipped[3] = {2, 3, 6};
  flipped[4] = {3, 7, 6};
  EXPECT_EQ(changed(kStrip, flipped), Vertices{});
}

TEST(BorderLinks, FansThatComeApartOrGetMoreAreSeen) {
  std::vector<Triangle> torn = kStrip;
  torn.erase(torn.begin() + 3);  // {2, 7, 6}: the faces at 2 are two fans now
  EXPECT_EQ(changed(kStrip, torn), Vertices{2});
  EXPECT_EQ(changed(torn, kStrip), Vertices{2});
  std::vector<Triangle> more = kStrip;
  more.push_back({2, 10, 11});
  EXPECT_EQ(changed(kStrip, more), Vertices{2});
}

TEST(BorderLinks, EdgesAndFacesOfSharedVerticesAreSeen) {
  std::vector<Triangle> gone(kStrip.begin() + 1, kStrip.end());
  EXPECT_EQ(changed(kStrip, gone), (Vertices{0, 1}));
  std::vector<Triangle> chord = kStrip;
  chord.push_back({1, 3, 9});
  EXPECT_EQ(changed(kStrip, chord), (Vertices{1, 3}));
  std::vector<Triangle> turned = kStrip;
  std::swap(turned[2][0], turned[2][1]);
  EXPECT_EQ(changed(kStrip, turned), (Vertices{1, 2}));
  std::vector<Triangle> crowded = kStrip;
  crowded.push_back({1, 6, 12});  // a third face at an edge from 1
  EXPECT_EQ(changed(kStrip, crowded), Vertices{1});
  std::vector<Triangle> degenerate = kStrip;
  degenerate.push_back({4, 4, 8});
  EXPECT_EQ(changed(kStrip, degenerate), Vertices{4});
}

/// The counts of both surfaces with faces outside.
std::array<std::uint64_t, 4> counts(std::vector<Triangle> faces, const std::vector<Triangle>& outside) {
  faces.insert(faces.end(), outside.begin(), outside.end());
  chartify::IndexedMesh mesh;
  mesh.positions.resize(20);
  mesh.faces = std::move(faces);
  const detail::Topology t = detail::analyze(mesh);
  return {t.nonmanifold_edges, t.nonmanifold_vertices, t.inconsistent_edges, t.duplicate_faces};
}

TEST(BorderLinks, WhatIsNotSeenCountsTheSameWhateverIsOutside) {
  std::mt19937 random(5);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  const auto faces = [&](std::uint32_t count, std::uint32_t first_inner, std::uint32_t inner) {
    std::vector<Triangle> all;
    const auto vertex = [&] { return below(2) ? below(kShared) : first_inner + below(inner); };
    while (all.size() < count) {
      const Triangle t{vertex(), vertex(), vertex()};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) all.push_back(t);
    }
    return all;
  };
  int unseen = 0;
  for (int round = 0; round < 4'000; ++round) {
    const std::vector<Triangle> before = faces(1 + below(6), kShared, 4);
    std::vector<Triangle> after = before;
    for (std::uint32_t i = below(3); i > 0; --i)
      after[below(static_cast<std::uint32_t>(after.size()))] = faces(1, kShared, 4)[0];
    const std::vector<std::uint32_t> seen = changed(before, after);
    std::vector<Triangle> outside = faces(below(6), 12, 4);
    const auto is_seen = [&](std::uint32_t v) { return std::ranges::find(seen, v) != seen.end(); };
    std::vector<Triangle> looked_at;  // the faces at vertices that are seen
    std::ranges::copy_if(outside, std::back_inserter(looked_at),
                         [&](const Triangle& t) { return std::ranges::any_of(t, is_seen); });
    unseen += looked_at.size() < outside.size();
    const auto all_before = counts(before, outside), all_after = counts(after, outside);
    const auto some_before = counts(before, looked_at), some_after = counts(after, looked_at);
    for (std::size_t i = 0; i < 4; ++i)
      ASSERT_EQ(all_after[i] - all_before[i], some_after[i] - some_before[i]) << "round " << round << ", count " << i;
  }
  EXPECT_GT(unseen, 200);
}

}  // namespace
}  // namespace ramcdb::test
