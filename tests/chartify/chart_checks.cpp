#include "tests/chartify/chart_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace ramcdb::chartify::test {
namespace {

std::size_t count_isolated(const IndexedMesh& mesh) {
  std::set<std::uint32_t> used;
  for (const Triangle& t : mesh.faces)
    for (const std::uint32_t v : t) used.insert(v);
  return mesh.positions.size() - used.size();
}

}  // namespace

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t f) {
  while (parent[f] != f) f = parent[f] = parent[parent[f]];
  return f;
}

IndexedMesh canonical(const ramcdb::test::TestMesh& mesh) {
  return canonical_order({ramcdb::test::snap_to_bits(mesh, 16), mesh.faces}).mesh;
}

std::vector<std::uint32_t> faces_of_charts(const Charts& charts) {
  std::vector<std::uint32_t> sizes(charts.chart_count, 0);
  for (const std::uint32_t c : charts.chart_of_face) ++sizes.at(c);
  return sizes;
}

std::vector<std::uint32_t> pieces(const IndexedMesh& mesh, const std::vector<std::uint32_t>& chart_of_face) {
  struct Side {
    std::uint32_t face;
    bool forward;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Side>> edges;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t u = mesh.faces[f][i], v = mesh.faces[f][(i + 1) % 3];
      edges[{std::min(u, v), std::max(u, v)}].push_back({f, u < v});
    }
  std::vector<std::uint32_t> parent(mesh.faces.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (const auto& [vertices, sides] : edges)
    if (sides.size() == 2 && sides[0].forward != sides[1].forward &&
        chart_of_face[sides[0].face] == chart_of_face[sides[1].face])
      parent[root_of(parent, sides[0].face)] = root_of(parent, sides[1].face);
  std::vector<std::uint32_t> piece(parent.size());
  for (std::uint32_t f = 0; f < parent.size(); ++f) piece[f] = root_of(parent, f);
  return piece;
}

void check_charts(const IndexedMesh& mesh, const Charts& charts) {
  ASSERT_EQ(charts.chart_of_face.size(), mesh.faces.size());
  ASSERT_EQ(charts.chart_of_isolated_vertex.size(), count_isolated(mesh));
  std::uint32_t seen = 0;
  for (const std::uint32_t c : charts.chart_of_face) {
    ASSERT_LE(c, seen);
    seen = std::max(seen, c + 1);
  }
  std::set<std::uint32_t> used(charts.chart_of_face.begin(), charts.chart_of_face.end());
  used.insert(charts.chart_of_isolated_vertex.begin(), charts.chart_of_isolated_vertex.end());
  ASSERT_EQ(used.size(), charts.chart_count);
  for (const std::uint32_t c : used) ASSERT_LT(c, charts.chart_count);

  const auto piece = pieces(mesh, charts.chart_of_face);
  const auto component = pieces(mesh, std::vector<std::uint32_t>(mesh.faces.size(), 0));
  std::map<std::uint32_t, std::set<std::uint32_t>> pieces_of_chart, charts_of_component, components_of_chart;
  for (std::size_t f = 0; f < piece.size(); ++f) {
    pieces_of_chart[charts.chart_of_face[f]].insert(piece[f]);
    components_of_chart[charts.chart_of_face[f]].insert(component[f]);
    charts_of_component[component[f]].insert(charts.chart_of_face[f]);
  }
  for (const auto& [chart, own] : pieces_of_chart) {
    ASSERT_EQ(own.size(), components_of_chart[chart].size()) << "chart " << chart << " is torn";
    if (own.size() == 1) continue;
    for (const std::uint32_t c : components_of_chart[chart])
      ASSERT_EQ(charts_of_component[c].size(), 1U) << "chart " << chart << " holds part of another component";
  }
}

}  // namespace ramcdb::chartify::test
