#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "tests/api/model.h"
#include "tests/api/oracle.h"
#include "tests/api/oracle_history.h"

/// What has to hold of a version that an edit made.
namespace ramcdb::test {

/// Tells where a version is not what it ought to be.
/// \param sides what was merged, if it was
inline void explain(const Model& expected, const Model& is, const std::string& what, const ThreeWay* sides) {
  std::cout << what << ": " << expected.points.size() << " vertices, " << expected.faces.size() << " faces expected, "
            << is.points.size() << ", " << is.faces.size() << " there\n";
  const auto wanted = expected.sorted_points(), have = is.sorted_points();
  std::vector<LatticePoint> missing, other;
  std::ranges::set_difference(wanted, have, std::back_inserter(missing));
  std::ranges::set_difference(have, wanted, std::back_inserter(other));
  const auto list = [&](const char* name, const std::vector<LatticePoint>& places) {
    for (std::size_t i = 0; i < std::min<std::size_t>(places.size(), 10); ++i) {
      std::cout << "  " << name << ' ' << places[i].x << ' ' << places[i].y << ' ' << places[i].z << '\n';
      if (sides) sides->tell(places[i]);
    }
  };
  list("missing", missing);
  list("instead", other);
  std::vector<std::pair<LatticePoint, Model::Color>> lost;
  std::ranges::set_difference(expected.known_colors(), is.known_colors(), std::back_inserter(lost));
  for (std::size_t i = 0; i < std::min<std::size_t>(lost.size(), 10); ++i) {
    const auto& [p, color] = lost[i];
    std::cout << "  missing colour " << color[0] << ' ' << color[1] << ' ' << color[2] << " at " << p.x << ' ' << p.y
              << ' ' << p.z << '\n';
    if (sides) sides->tell(p);
  }
  const FaceSet faces = face_set(expected.points, expected.faces), there = face_set(is.points, is.faces);
  const auto list_faces = [&](const char* name, const FaceSet& mine, const FaceSet& others) {
    FaceSet only;
    std::ranges::set_difference(mine, others, std::back_inserter(only));
    for (std::size_t i = 0; i < std::min<std::size_t>(only.size(), 10); ++i) {
      std::cout << "  face " << name << ':';
      for (const LatticePoint p : only[i]) std::cout << ' ' << p.x << ',' << p.y << ',' << p.z;
      std::cout << '\n';
      for (const LatticePoint p : only[i])
        if (sides) sides->tell(p);
    }
  };
  list_faces("missing", faces, there);
  list_faces("instead", there, faces);
}

/// What info and the index say is what the mesh has.
inline void expect_counts(const Snapshot& after, const Model& is, const Model& expected, const std::string& what) {
  const MeshInfo info = after.info();
  const PageCounts pages(after);
  const detail::Topology counted = is.topology(), wanted = expected.topology();
  EXPECT_EQ(info.vertices, is.points.size()) << what;
  EXPECT_EQ(info.faces, is.faces.size()) << what;
  EXPECT_EQ(info.charts, pages.charts.size()) << what;
  EXPECT_EQ(info.wires, pages.wires.size()) << what;
  EXPECT_EQ(info.corners, pages.corners.size()) << what;
  const auto same = [&](std::uint64_t detail::Topology::*count, std::uint64_t said, const char* name) {
    EXPECT_EQ(counted.*count, wanted.*count) << what << ": " << name << " of the mesh";
    EXPECT_EQ(said, counted.*count) << what << ": " << name << " of info";
  };
  same(&detail::Topology::isolated_vertices, info.isolated_vertices, "isolated vertices");
  same(&detail::Topology::degenerate_faces, info.degenerate_faces, "degenerate faces");
  same(&detail::Topology::duplicate_faces, info.duplicate_faces, "duplicate faces");
  same(&detail::Topology::nonmanifold_edges, info.nonmanifold_edges, "non-manifold edges");
  same(&detail::Topology::nonmanifold_vertices, info.nonmanifold_vertices, "non-manifold vertices");
  same(&detail::Topology::inconsistent_edges, info.inconsistent_edges, "inconsistent edges");
}

struct MadeCharts {
  std::size_t made = 0, small = 0;  ///< small: below a quarter of the target

  void add(const MadeCharts& more) {
    made += more.made;
    small += more.small;
  }
};

/// Charts away from the region keep their blobs; those that the edit made have the right size.
/// \param drawn_in how many of the former may change all the same: merges and reverts join a chart that became small to
/// one that lies near it, be it of another component
inline MadeCharts expect_charts(const Snapshot& before, const Snapshot& after, const std::set<ChartId>& edited,
                                std::size_t drawn_in, std::uint32_t target, const std::string& what) {
  MadeCharts counts;
  std::vector<std::uint32_t> changed;
  const PageCounts was(before), is(after);
  std::vector<ChartId> region;
  for (const ChartId id : edited)
    if (was.charts.contains(id)) region.push_back(id);
  std::vector<ChartId> near;
  if (!region.empty()) near = before.find({{OfCharts{region}}, 2});
  for (const auto& [id, chart] : was.charts) {
    if (std::ranges::binary_search(near, id)) continue;
    const auto now = is.charts.find(id);
    if (now == is.charts.end() || detail::state_of(now->second) != detail::state_of(chart)) changed.push_back(id.value);
  }
  EXPECT_LE(changed.size(), drawn_in) << what << ": charts far away are not what they were: "
                                      << ::testing::PrintToString(changed);
  for (const auto& [id, chart] : is.charts)
    if (!was.charts.contains(id) || was.charts.at(id).faces != chart.faces) {
      EXPECT_LE(chart.faces, 2 * target) << what;
      counts.small += 4 * chart.faces < target;
      ++counts.made;
    }
  return counts;
}

}  // namespace ramcdb::test
