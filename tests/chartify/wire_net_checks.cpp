#include "tests/chartify/wire_net_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace ramcdb::chartify::test {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge undirected(std::uint32_t u, std::uint32_t v) { return {std::min(u, v), std::max(u, v)}; }

/// Directed edges of a chart's faces; none may occur twice.
std::set<Edge> directed_edges(const Chart& chart) {
  std::set<Edge> edges;
  for (const Triangle& t : chart.faces)
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT(t[i], chart.positions.size());
      EXPECT_NE(t[i], t[(i + 1) % 3]);
      EXPECT_TRUE(edges.emplace(t[i], t[(i + 1) % 3]).second) << "two faces pass an edge in the same direction";
    }
  return edges;
}

/// The directed edges opposite a vertex in its faces: one open or one closed chain where the faces are one fan.
void check_fan(std::uint32_t v, const std::map<std::uint32_t, std::uint32_t>& link, bool on_border) {
  std::set<std::uint32_t> heads;
  for (const auto& [from, to] : link) heads.insert(to);
  std::vector<std::uint32_t> starts;
  for (const auto& [from, to] : link)
    if (!heads.contains(from)) starts.push_back(from);
  ASSERT_EQ(starts.size(), on_border ? 1U : 0U) << "vertex " << v;
  std::size_t length = 0;
  std::uint32_t at = on_border ? starts[0] : link.begin()->first;
  for (auto it = link.find(at); it != link.end() && length <= link.size(); it = link.find(it->second)) {
    ++length;
    if (!on_border && it->second == at) break;
  }
  ASSERT_EQ(length, link.size()) << "the faces around vertex " << v << " are more than one fan";
}

void check_fans(const Chart& chart) {
  std::vector<std::map<std::uint32_t, std::uint32_t>> links(chart.positions.size());
  for (const Triangle& t : chart.faces)
    for (std::size_t i = 0; i < 3; ++i) links[t[i]][t[(i + 1) % 3]] = t[(i + 2) % 3];
  for (std::uint32_t v = 0; v < links.size(); ++v) {
    const bool on_border = v < chart.border_count();
    if (links[v].empty()) {
      ASSERT_FALSE(on_border) << "an isolated vertex on a border";
      continue;
    }
    check_fan(v, links[v], on_border);
  }
}

std::set<Edge> loop_edges(const Chart& chart) {
  std::set<Edge> edges;
  std::uint32_t first = 0;
  for (const std::uint32_t size : chart.loop_sizes) {
    EXPECT_GE(size, 3U);
    for (std::uint32_t i = 0; i < size; ++i) edges.emplace(first + i, first + (i + 1) % size);
    first += size;
  }
  return edges;
}

/// Turned so that its smallest vertex comes first.
Triangle turned(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  // Of a degenerate face with its smallest vertex twice in a row, the turn that has both in front.
  if (t[0] == t[2]) t = {t[2], t[0], t[1]};
  return t;
}

void check_faces_and_vertices(const IndexedMesh& mesh, const Charts& charts, const WireNet& net) {
  ASSERT_EQ(net.charts.size(), charts.chart_count);
  std::vector<std::vector<Triangle>> expected(charts.chart_count), found(charts.chart_count);
  std::vector<std::uint8_t> has_face(mesh.positions.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    expected[charts.chart_of_face[f]].push_back(turned(mesh.faces[f]));
    for (const std::uint32_t v : mesh.faces[f]) has_face[v] = 1;
  }
  std::vector<std::vector<std::uint32_t>> expected_isolated(charts.chart_count);
  std::size_t next = 0;
  for (std::uint32_t v = 0; v < has_face.size(); ++v)
    if (!has_face[v]) expected_isolated[charts.chart_of_isolated_vertex.at(next++)].push_back(v);
  for (std::size_t c = 0; c < net.charts.size(); ++c) {
    const NetChart& chart = net.charts[c];
    ASSERT_EQ(chart.mesh_vertex.size(), chart.chart.positions.size());
    for (std::size_t v = 0; v < chart.mesh_vertex.size(); ++v)
      ASSERT_EQ(chart.chart.positions[v], mesh.positions.at(chart.mesh_vertex[v]));
    for (const Triangle& t : chart.chart.faces)
      found[c].push_back(turned({chart.mesh_vertex[t[0]], chart.mesh_vertex[t[1]], chart.mesh_vertex[t[2]]}));
    std::sort(found[c].begin(), found[c].end());
    std::sort(expected[c].begin(), expected[c].end());
    ASSERT_EQ(found[c], expected[c]) << "chart " << c << " has other faces than the mesh";
    std::vector<std::uint32_t> isolated;
    for (const std::uint32_t v : chart.mesh_vertex)
      if (!has_face[v]) isolated.push_back(v);
    ASSERT_EQ(isolated, expected_isolated[c]);
  }
}

/// Every copy of a mesh vertex that has several, in one chart or in many, is on a border.
void check_copies(const IndexedMesh& mesh, const WireNet& net) {
  std::vector<std::uint32_t> copies(mesh.positions.size(), 0);
  for (const NetChart& chart : net.charts)
    for (const std::uint32_t v : chart.mesh_vertex) ++copies[v];
  for (const std::uint32_t count : copies) ASSERT_GT(count, 0U) << "a vertex is lost";
  for (const NetChart& chart : net.charts)
    for (std::size_t local = chart.chart.border_count(); local < chart.mesh_vertex.size(); ++local)
      ASSERT_EQ(copies[chart.mesh_vertex[local]], 1U) << "an inner vertex stands in another place too";
}

/// Wires are numbered and directed by the first pass.
void check_order(const WireNet& net) {
  std::uint32_t seen = 0;
  for (const NetChart& chart : net.charts)
    for (const auto& loop : chart.loops)
      for (const NetLoopStep step : loop) {
        ASSERT_LE(step.wire, seen) << "wires are not numbered in the order of their first passes";
        if (step.wire < seen) continue;
        ASSERT_FALSE(step.reversed) << "the first pass of a wire is reversed";
        ++seen;
      }
}

/// Loops are the wires they name; wires list the charts that pass them.
void check_loops(const WireNet& net) {
  std::vector<std::vector<std::uint32_t>> passes(net.wires.size());
  for (std::uint32_t c = 0; c < net.charts.size(); ++c) {
    const NetChart& chart = net.charts[c];
    ASSERT_EQ(chart.loops.size(), chart.chart.loop_sizes.size());
    std::uint32_t first = 0;
    for (std::size_t l = 0; l < chart.loops.size(); ++l) {
      std::vector<std::uint32_t> along;
      for (const NetLoopStep step : chart.loops[l]) {
        passes.at(step.wire).push_back(c);
        const std::vector<std::uint32_t> vertices = vertices_along(net, step);
        along.insert(along.end(), vertices.begin(), vertices.end() - 1);
      }
      const auto begin = chart.mesh_vertex.begin() + first;
      ASSERT_EQ(along, std::vector<std::uint32_t>(begin, begin + chart.chart.loop_sizes[l])) << "chart " << c;
      first += chart.chart.loop_sizes[l];
    }
  }
  for (std::size_t w = 0; w < net.wires.size(); ++w) {
    ASSERT_FALSE(passes[w].empty()) << "a wire that no chart passes";
    ASSERT_EQ(net.wires[w].charts, passes[w]) << "wire " << w;
  }
}

/// The wires that end or pass at a vertex, one entry per edge of theirs there.
std::map<std::uint32_t, std::vector<std::uint32_t>> wires_at_vertices(const WireNet& net) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> wires;
  for (std::uint32_t w = 0; w < net.wires.size(); ++w) {
    const auto& vertices = net.wires[w].vertices;
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
      wires[vertices[i]].push_back(w);
      wires[vertices[i + 1]].push_back(w);
    }
  }
  return wires;
}

/// Whether a loop enters a vertex and leaves it along one edge: a wire must end there.
std::set<std::uint32_t> turning_points(const WireNet& net) {
  std::set<std::uint32_t> points;
  for (const NetChart& chart : net.charts)
    for (const auto& loop : chart.loops)
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const auto before = vertices_along(net, loop[i]), after = vertices_along(net, loop[(i + 1) % loop.size()]);
        if (before[before.size() - 2] == after[1]) points.insert(after[0]);
      }
  return points;
}

/// Wires end at corners and pass none.
void check_ends(const WireNet& net) {
  const std::set<std::uint32_t> corners(net.corners.begin(), net.corners.end());
  ASSERT_EQ(corners.size(), net.corners.size()) << "two corners at one vertex";
  const auto wires_at = wires_at_vertices(net);
  for (const NetWire& wire : net.wires) {
    ASSERT_GE(wire.vertices.size(), 2U);
    ASSERT_EQ(net.corners.at(wire.begin_corner), wire.vertices.front());
    ASSERT_EQ(net.corners.at(wire.end_corner), wire.vertices.back());
    for (std::size_t i = 1; i + 1 < wire.vertices.size(); ++i) {
      ASSERT_FALSE(corners.contains(wire.vertices[i])) << "a wire runs through a corner";
      ASSERT_EQ(wires_at.at(wire.vertices[i]).size(), 2U);
    }
  }
  for (const std::uint32_t v : corners) ASSERT_TRUE(wires_at.contains(v)) << "a corner without a wire";
}

/// Wires end nowhere without need.
void check_need_of_corners(const IndexedMesh& mesh, const WireNet& net) {
  const auto wires_at = wires_at_vertices(net);
  const auto turns = turning_points(net);
  for (const std::uint32_t v : net.corners) {
    const std::vector<std::uint32_t>& wires = wires_at.at(v);
    if (wires.size() != 2 || turns.contains(v)) continue;
    const NetWire& wire = net.wires[wires[0]];
    ASSERT_EQ(wires[0], wires[1]) << "two wires meet at vertex " << v << " that could be one";
    for (const std::uint32_t u : wire.vertices)
      ASSERT_LE(mesh.positions[v], mesh.positions[u]) << "a closed wire begins at its smallest position";
  }
}

/// Every edge that the mesh or the charts cut lies on a wire, and no edge lies on two. Inside polygons that stand
/// several times edges may be whole.
void check_cut_edges(const IndexedMesh& mesh, const Charts& charts, const WireNet& net) {
  std::set<Edge> on_wire;
  for (const NetWire& wire : net.wires)
    for (std::size_t i = 0; i + 1 < wire.vertices.size(); ++i)
      ASSERT_TRUE(on_wire.insert(undirected(wire.vertices[i], wire.vertices[i + 1])).second) << "an edge on two wires";
  struct Side {
    std::size_t face;
    bool forward;
  };
  std::map<Edge, std::vector<Side>> sides;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t u = mesh.faces[f][i], v = mesh.faces[f][(i + 1) % 3];
      sides[undirected(u, v)].push_back({f, u < v});
    }
  for (const auto& [edge, of_edge] : sides) {
    std::map<std::uint32_t, int> of_polygon;
    for (const Side& side : of_edge)
      if (!mesh.polygon_of_face.empty()) ++of_polygon[mesh.polygon_of_face[side.face]];
    const bool inside_polygons = !of_polygon.empty() && std::all_of(of_polygon.begin(), of_polygon.end(),
                                                                    [](const auto& p) { return p.second == 2; });
    if (inside_polygons) {
      on_wire.erase(edge);
      continue;
    }
    const bool joins = of_edge.size() == 2 && of_edge[0].face != of_edge[1].face &&
                       of_edge[0].forward != of_edge[1].forward &&
                       charts.chart_of_face[of_edge[0].face] == charts.chart_of_face[of_edge[1].face];
    ASSERT_TRUE(joins || on_wire.contains(edge)) << "a cut edge on no wire";
    on_wire.erase(edge);
  }
  ASSERT_TRUE(on_wire.empty()) << "a wire along something that is no edge of the mesh";
}

}  // namespace

std::vector<std::uint32_t> vertices_along(const WireNet& net, NetLoopStep step) {
  std::vector<std::uint32_t> vertices = net.wires.at(step.wire).vertices;
  if (step.reversed) std::reverse(vertices.begin(), vertices.end());
  return vertices;
}

void check_chart(const Chart& chart) {
  ASSERT_LE(chart.border_count(), chart.positions.size());
  const std::set<Edge> edges = directed_edges(chart);
  std::set<Edge> open;
  for (const auto& [u, v] : edges)
    if (!edges.contains({v, u})) open.emplace(u, v);
  ASSERT_EQ(loop_edges(chart), open) << "loops are not the edges that one face has";
  check_fans(chart);
}

void check_edited_net(const IndexedMesh& mesh, const Charts& charts, const WireNet& net) {
  for (const NetChart& chart : net.charts) ASSERT_NO_FATAL_FAILURE(check_chart(chart.chart));
  ASSERT_NO_FATAL_FAILURE(check_faces_and_vertices(mesh, charts, net));
  ASSERT_NO_FATAL_FAILURE(check_copies(mesh, net));
  ASSERT_NO_FATAL_FAILURE(check_loops(net));
  ASSERT_NO_FATAL_FAILURE(check_ends(net));
  ASSERT_NO_FATAL_FAILURE(check_cut_edges(mesh, charts, net));
}

void check_wire_net(const IndexedMesh& mesh, const Charts& charts, const WireNet& net) {
  ASSERT_NO_FATAL_FAILURE(check_edited_net(mesh, charts, net));
  ASSERT_NO_FATAL_FAILURE(check_order(net));
  ASSERT_NO_FATAL_FAILURE(check_need_of_corners(mesh, net));
}

void check_origins(const WireNet& net, std::span<const FixedWire> fixed) {
  ASSERT_EQ(net.origin.size(), net.wires.size());
  std::vector<std::vector<std::uint32_t>> parts(fixed.size());
  std::set<Edge> fixed_edges;
  for (const FixedWire& wire : fixed)
    for (std::size_t i = 1; i < wire.vertices.size(); ++i)
      fixed_edges.insert(undirected(wire.vertices[i - 1], wire.vertices[i]));
  for (std::uint32_t w = 0; w < net.wires.size(); ++w) {
    const auto& vertices = net.wires[w].vertices;
    const auto [on, first] = net.origin[w];
    if (on != kNone) {
      const auto& whole = fixed[on].vertices;
      ASSERT_LE(first + vertices.size(), whole.size());
      ASSERT_TRUE(std::equal(vertices.begin(), vertices.end(), whole.begin() + first)) << "wire " << w;
      parts[on].push_back(w);
      continue;
    }
    for (std::size_t i = 1; i < vertices.size(); ++i)
      ASSERT_FALSE(fixed_edges.contains(undirected(vertices[i - 1], vertices[i]))) << "another wire on a fixed edge";
  }
  for (std::size_t on = 0; on < fixed.size(); ++on) {
    std::ranges::sort(parts[on], {}, [&](std::uint32_t w) { return net.origin[w].first; });
    std::uint32_t at = 0;
    for (const std::uint32_t w : parts[on]) {
      ASSERT_EQ(net.origin[w].first, at) << "a gap in fixed wire " << on;
      at += static_cast<std::uint32_t>(net.wires[w].vertices.size()) - 1;
    }
    ASSERT_EQ(at + 1, fixed[on].vertices.size()) << "fixed wire " << on << " is not covered to its end";
  }
}

}  // namespace ramcdb::chartify::test
