#include "chartify/seams.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "chartify/block.h"
#include "chartify/wire_net_builder.h"
#include "ramcdb/error.h"
#include "tests/chartify/lattice_mesh.h"
#include "tests/chartify/mesh_families.h"

namespace ramcdb::chartify::test {
namespace {

/// Some charts of a mesh as a mesh of their own.
struct Part {
  IndexedMesh mesh;
  Charts charts;
  std::vector<std::uint32_t> number;
  std::vector<std::uint8_t> shared;

  [[nodiscard]] MeshPart view() const { return {mesh, charts, number, shared}; }
};

/// Charts by turns to `count` parts.
std::vector<Part> parts_of(const IndexedMesh& mesh, const Charts& charts, std::uint32_t count) {
  std::vector<Part> parts(count);
  std::vector<std::uint32_t> parts_at(mesh.positions.size(), 0);
  for (std::uint32_t p = 0; p < count; ++p) {
    Part& part = parts[p];
    std::vector<std::uint32_t> own(mesh.positions.size(), kNone);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      if (charts.chart_of_face[f] % count != p) continue;
      Triangle t{};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = mesh.faces[f][i];
        if (own[v] == kNone) {
          own[v] = static_cast<std::uint32_t>(part.number.size());
          part.number.push_back(v);
          part.mesh.positions.push_back(mesh.positions[v]);
          ++parts_at[v];
        }
        t[i] = own[v];
      }
      part.mesh.faces.push_back(t);
      part.charts.chart_of_face.push_back(charts.chart_of_face[f] / count);
    }
    part.charts.chart_count = (charts.chart_count + count - 1 - p) / count;
  }
  for (Part& part : parts)
    for (const std::uint32_t v : part.number) part.shared.push_back(parts_at[v] > 1);
  return parts;
}

SeamNet join(const IndexedMesh& mesh, const std::vector<Part>& parts) {
  std::map<NumberedEdge, std::vector<std::uint32_t>> edges;
  for (std::uint32_t p = 0; p < parts.size(); ++p)
    for (const NumberedEdge& edge : edges_between_shared(parts[p].view())) edges[edge].push_back(p);
  std::vector<Seam> seams;
  for (const auto& [edge, of] : edges)
    if (of.size() > 1) seams.push_back({edge, of});
  SharedEnds all;
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    std::vector<NumberedEdge> own;
    for (const Seam& seam : seams)
      if (std::ranges::count(seam.parts, p) > 0) own.push_back(seam.edge);
    const SharedEnds ends = find_shared_ends(parts[p].view(), own);
    all.cut_edges.insert(all.cut_edges.end(), ends.cut_edges.begin(), ends.cut_edges.end());
    all.corners.insert(all.corners.end(), ends.corners.begin(), ends.corners.end());
  }
  return join_seams(seams, all, [&](std::uint32_t v) { return mesh.positions[v]; });
}

using Paths = std::multiset<std::vector<std::uint32_t>>;

/// A path whichever way it runs; a ring wherever it begins keeps its corner.
std::vector<std::uint32_t> either_way(std::vector<std::uint32_t> path) {
  std::vector<std::uint32_t> back(path.rbegin(), path.rend());
  return std::min(path, back);
}

TEST(Seams, GiveThePartsOfAMeshTheWiresOfTheWhole) {
  for (const Family& family : all_families()) {
    SCOPED_TRACE(family.name);
    const IndexedMesh mesh = canonical_order(on_lattice(family.make())).mesh;
    Options options;
    options.target_faces = 60;
    const Charts charts = chartify(mesh, options);
    Paths expected, found;
    for (const NetWire& wire : build_wire_net(mesh, charts).wires) expected.insert(either_way(wire.vertices));
    for (const std::uint32_t count : {2U, 3U}) {
      const std::vector<Part> parts = parts_of(mesh, charts, count);
      const SeamNet net = join(mesh, parts);
      found.clear();
      for (const SeamWire& wire : net.wires) found.insert(either_way(wire.vertices));
      for (std::uint32_t p = 0; p < count; ++p) {
        std::vector<std::uint32_t> own;
        for (std::uint32_t w = 0; w < net.wires.size(); ++w)
          if (std::ranges::count(net.wires[w].parts, p) > 0) own.push_back(w);
        const PartSeams seams = seams_of(parts[p].view(), net, own);
        const WireNet part = build_wire_net(parts[p].mesh, parts[p].charts, seams.wires, seams.corners);
        std::size_t on_seams = 0;
        for (std::size_t w = 0; w < part.wires.size(); ++w) {
          std::vector<std::uint32_t> path;
          for (const std::uint32_t v : part.wires[w].vertices) path.push_back(parts[p].number[v]);
          if (part.origin[w].fixed == kNone) {
            found.insert(either_way(path));
            continue;
          }
          ++on_seams;
          EXPECT_EQ(path, net.wires[own[part.origin[w].fixed]].vertices) << "a wire on a seam is the whole of it";
        }
        EXPECT_EQ(on_seams, own.size());
      }
      EXPECT_EQ(found, expected) << count << " parts";
    }
  }
}

TEST(Block, TellsWhichChartsWaitForLaterBlocks) {
  const IndexedMesh mesh = canonical_order(on_lattice(ramcdb::test::sphere(3000))).mesh;
  Options options;
  options.target_faces = 60;
  std::vector<std::uint32_t> later(mesh.positions.size(), kNone);
  later[mesh.faces.front()[0]] = 7;
  later[mesh.faces.front()[1]] = 5;
  const BlockCharts cut = cut_block(mesh, later, options);
  std::set<std::uint32_t> touching;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t v : mesh.faces[f])
      if (later[v] != kNone) touching.insert(cut.charts.chart_of_face[f]);
  for (std::uint32_t c = 0; c < cut.charts.chart_count; ++c)
    EXPECT_EQ(cut.waits_for[c] != kNone, touching.contains(c)) << c;
  EXPECT_EQ(cut.waits_for[cut.charts.chart_of_face.front()], 5U) << "the first of them";
  later.pop_back();
  EXPECT_THROW((void)cut_block(mesh, later, options), Error);
}

TEST(Block, KeepsSmallPiecesApartThatGoOnInLaterBlocks) {
  IndexedMesh mesh;  // three strips of two faces
  for (std::int32_t i = 0; i < 3; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)})
      mesh.positions.push_back({10 * i + x, y, 0});
    mesh.faces.push_back({first, first + 1, first + 3});
    mesh.faces.push_back({first, first + 3, first + 2});
  }
  mesh = canonical_order(mesh).mesh;
  Options options;
  options.target_faces = 100;
  std::vector<std::uint32_t> later(mesh.positions.size(), kNone);
  EXPECT_EQ(cut_block(mesh, later, options).charts.chart_count, 1U);
  later[mesh.faces[2][0]] = 1;
  const BlockCharts cut = cut_block(mesh, later, options);
  EXPECT_EQ(cut.charts.chart_count, 2U);
  EXPECT_EQ(std::ranges::count(cut.charts.chart_of_face, cut.charts.chart_of_face[2]), 2);
  EXPECT_EQ(cut.waits_for[cut.charts.chart_of_face[2]], 1U);
}

}  // namespace
}  // namespace ramcdb::chartify::test
