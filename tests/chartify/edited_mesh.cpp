#include "tests/chartify/edited_mesh.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace ramcdb::chartify::test {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<std::uint8_t> vertices_with_faces(const IndexedMesh& mesh) {
  std::vector<std::uint8_t> used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.faces)
    for (const std::uint32_t v : t) used[v] = 1;
  return used;
}

/// Per vertex the chart of an isolated one, else kNone.
std::vector<std::uint32_t> isolated_charts(const IndexedMesh& mesh,
                                           const std::vector<std::uint32_t>& chart_of_isolated) {
  const auto used = vertices_with_faces(mesh);
  std::vector<std::uint32_t> charts(used.size(), kNone);
  std::size_t next = 0;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (!used[v]) charts[v] = chart_of_isolated.at(next++);
  return charts;
}

class Joiner {
 public:
  Joiner(const StoredMesh& stored, const Region& region, const Charts& charts, const WireNet& net)
      : stored_(stored), region_(region), in_region_(stored.charts.chart_count, 0) {
    for (const std::uint32_t c : region.charts) in_region_[c] = 1;
    out_ = {region.mesh, charts, net};
  }

  StoredMesh run() {
    for (std::uint32_t c = 0; c < in_region_.size(); ++c)
      new_chart_.push_back(in_region_[c] ? kNone : out_.charts.chart_count++);
    number_vertices();
    add_faces();
    add_wires();
    for (std::uint32_t c = 0; c < in_region_.size(); ++c)
      if (!in_region_[c]) add_chart(stored_.net.charts[c]);
    return std::move(out_);
  }

 private:
  void number_vertices() {
    new_vertex_.assign(stored_.mesh.positions.size(), kNone);
    for (std::uint32_t v = 0; v < region_.source_vertex.size(); ++v)
      if (region_.source_vertex[v] != kNone) new_vertex_[region_.source_vertex[v]] = v;
    std::vector<std::uint8_t> outside(stored_.mesh.positions.size(), 0);
    for (std::uint32_t c = 0; c < in_region_.size(); ++c)
      if (!in_region_[c])
        for (const std::uint32_t v : stored_.net.charts[c].mesh_vertex) outside[v] = 1;
    const auto isolated = isolated_charts(stored_.mesh, stored_.charts.chart_of_isolated_vertex);
    for (std::uint32_t v = 0; v < outside.size(); ++v) {
      if (!outside[v] || new_vertex_[v] != kNone) continue;
      new_vertex_[v] = static_cast<std::uint32_t>(out_.mesh.positions.size());
      out_.mesh.positions.push_back(stored_.mesh.positions[v]);
      if (isolated[v] != kNone) out_.charts.chart_of_isolated_vertex.push_back(new_chart_[isolated[v]]);
    }
  }

  void add_faces() {
    for (std::size_t f = 0; f < stored_.mesh.faces.size(); ++f) {
      if (in_region_[stored_.charts.chart_of_face[f]]) continue;
      const Triangle& t = stored_.mesh.faces[f];
      out_.mesh.faces.push_back({new_vertex_[t[0]], new_vertex_[t[1]], new_vertex_[t[2]]});
      out_.charts.chart_of_face.push_back(new_chart_[stored_.charts.chart_of_face[f]]);
      if (!stored_.mesh.polygon_of_face.empty())
        out_.mesh.polygon_of_face.push_back(1'000'000 + stored_.mesh.polygon_of_face[f]);
    }
    number_polygons();
  }

  void number_polygons() {
    std::map<std::uint32_t, std::uint32_t> to;
    for (std::uint32_t& p : out_.mesh.polygon_of_face)
      p = to.emplace(p, static_cast<std::uint32_t>(to.size())).first->second;
  }

  /// The parts that now stand for each stored wire, first to last.
  void add_wires() {
    parts_.resize(stored_.net.wires.size());
    std::map<std::uint32_t, std::uint32_t> corner_at;
    for (std::uint32_t c = 0; c < out_.net.corners.size(); ++c) corner_at[out_.net.corners[c]] = c;
    const auto corner = [&](std::uint32_t v) {
      const auto [it, fresh] = corner_at.emplace(v, static_cast<std::uint32_t>(out_.net.corners.size()));
      if (fresh) out_.net.corners.push_back(v);
      return it->second;
    };
    for (std::uint32_t w = 0; w < out_.net.wires.size(); ++w)
      if (const WireOrigin origin = out_.net.origin[w]; origin.fixed != kNone)
        parts_[region_.fixed_wires[origin.fixed]].push_back(w);
    for (auto& parts : parts_) std::ranges::sort(parts, {}, [&](std::uint32_t w) { return out_.net.origin[w].first; });
    for (std::uint32_t w = 0; w < parts_.size(); ++w) {
      const NetWire& old = stored_.net.wires[w];
      if (!parts_[w].empty() || std::ranges::all_of(old.charts, [&](std::uint32_t c) { return in_region_[c]; }))
        continue;
      NetWire wire;
      for (const std::uint32_t v : old.vertices) wire.vertices.push_back(new_vertex_[v]);
      wire.begin_corner = corner(wire.vertices.front());
      wire.end_corner = corner(wire.vertices.back());
      parts_[w].push_back(static_cast<std::uint32_t>(out_.net.wires.size()));
      out_.net.wires.push_back(std::move(wire));
    }
    out_.net.origin.assign(out_.net.wires.size(), {});
  }

  void add_chart(const NetChart& old) {
    NetChart chart = old;
    for (std::uint32_t& v : chart.mesh_vertex) v = new_vertex_[v];
    for (auto& loop : chart.loops) {
      std::vector<NetLoopStep> steps;
      for (const NetLoopStep step : loop) {
        std::vector<std::uint32_t> parts = parts_[step.wire];
        if (step.reversed) std::ranges::reverse(parts);
        for (const std::uint32_t w : parts) {
          steps.push_back({w, step.reversed});
          out_.net.wires[w].charts.push_back(static_cast<std::uint32_t>(out_.net.charts.size()));
        }
      }
      loop = std::move(steps);
    }
    out_.net.charts.push_back(std::move(chart));
  }

  const StoredMesh& stored_;
  const Region& region_;
  std::vector<std::uint8_t> in_region_;
  std::vector<std::uint32_t> new_chart_, new_vertex_;
  std::vector<std::vector<std::uint32_t>> parts_;
  StoredMesh out_;
};

}  // namespace

StoredMesh store(IndexedMesh mesh, const Options& options) {
  StoredMesh out;
  out.mesh = std::move(mesh);
  out.charts = chartify(out.mesh, options);
  out.net = build_wire_net(out.mesh, out.charts);
  return out;
}

Region take_out(const StoredMesh& stored, std::vector<std::uint32_t> charts) {
  std::ranges::sort(charts);
  Region out;
  std::vector<std::uint32_t> place(stored.charts.chart_count, kNone), new_vertex(stored.mesh.positions.size(), kNone);
  for (std::uint32_t i = 0; i < charts.size(); ++i) place[charts[i]] = i;
  std::vector<std::uint8_t> inside(new_vertex.size(), 0), outside(new_vertex.size(), 0);
  for (std::uint32_t c = 0; c < place.size(); ++c)
    for (const std::uint32_t v : stored.net.charts[c].mesh_vertex) (place[c] != kNone ? inside : outside)[v] = 1;
  const auto isolated = isolated_charts(stored.mesh, stored.charts.chart_of_isolated_vertex);
  for (std::uint32_t v = 0; v < inside.size(); ++v) {
    if (!inside[v]) continue;
    new_vertex[v] = static_cast<std::uint32_t>(out.mesh.positions.size());
    out.source_vertex.push_back(v);
    out.mesh.positions.push_back(stored.mesh.positions[v]);
    if (isolated[v] != kNone) out.chart_of_isolated.push_back(place[isolated[v]]);
  }
  for (std::size_t f = 0; f < stored.mesh.faces.size(); ++f) {
    if (place[stored.charts.chart_of_face[f]] == kNone) continue;
    const Triangle& t = stored.mesh.faces[f];
    out.mesh.faces.push_back({new_vertex[t[0]], new_vertex[t[1]], new_vertex[t[2]]});
    out.chart_of_face.push_back(place[stored.charts.chart_of_face[f]]);
    if (!stored.mesh.polygon_of_face.empty()) out.mesh.polygon_of_face.push_back(stored.mesh.polygon_of_face[f]);
  }
  for (std::uint32_t w = 0; w < stored.net.wires.size(); ++w) {
    const NetWire& wire = stored.net.wires[w];
    const auto here = std::ranges::count_if(wire.charts, [&](std::uint32_t c) { return place[c] != kNone; });
    if (here == 0 || here == static_cast<std::ptrdiff_t>(wire.charts.size())) continue;
    FixedWire fixed;
    for (const std::uint32_t v : wire.vertices) fixed.vertices.push_back(new_vertex[v]);
    out.fixed.push_back(std::move(fixed));
    out.fixed_wires.push_back(w);
  }
  for (const std::uint32_t v : stored.net.corners)
    if (inside[v] && outside[v]) out.corners.push_back(new_vertex[v]);
  out.charts = std::move(charts);
  return out;
}

std::vector<std::uint8_t> faces_that_stay(const Region& region) {
  std::set<Edge> edges;
  for (const FixedWire& wire : region.fixed)
    for (std::size_t i = 1; i < wire.vertices.size(); ++i)
      edges.insert(std::minmax(wire.vertices[i - 1], wire.vertices[i]));
  std::vector<std::uint8_t> stays;
  for (const Triangle& t : region.mesh.faces) {
    bool passes = false;
    for (std::size_t i = 0; i < 3; ++i) passes = passes || edges.contains(std::minmax(t[i], t[(i + 1) % 3]));
    stays.push_back(passes);
  }
  return stays;
}

void remove_faces(Region& region, const std::vector<std::uint8_t>& removed) {
  const auto isolated = isolated_charts(region.mesh, region.chart_of_isolated);
  const auto used_before = vertices_with_faces(region.mesh);
  Region out = region;
  out.mesh = {};
  out.chart_of_face.clear();
  out.chart_of_isolated.clear();
  out.source_vertex.clear();
  out.corners.clear();
  for (std::size_t f = 0; f < removed.size(); ++f) {
    if (removed[f]) continue;
    out.mesh.faces.push_back(region.mesh.faces[f]);
    out.chart_of_face.push_back(region.chart_of_face[f]);
    if (!region.mesh.polygon_of_face.empty()) out.mesh.polygon_of_face.push_back(region.mesh.polygon_of_face[f]);
  }
  std::map<std::uint32_t, std::uint32_t> polygons;
  for (std::uint32_t& p : out.mesh.polygon_of_face)
    p = polygons.emplace(p, static_cast<std::uint32_t>(polygons.size())).first->second;
  std::vector<std::uint8_t> used(region.mesh.positions.size(), 0);
  for (const Triangle& t : out.mesh.faces)
    for (const std::uint32_t v : t) used[v] = 1;
  std::vector<std::uint32_t> to(used.size(), kNone);
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    if (used_before[v] && !used[v]) continue;
    to[v] = static_cast<std::uint32_t>(out.mesh.positions.size());
    out.mesh.positions.push_back(region.mesh.positions[v]);
    out.source_vertex.push_back(region.source_vertex[v]);
    if (!used_before[v]) out.chart_of_isolated.push_back(isolated[v]);
  }
  for (Triangle& t : out.mesh.faces)
    for (std::uint32_t& v : t) v = to[v];
  for (FixedWire& wire : out.fixed)
    for (std::uint32_t& v : wire.vertices) v = to[v];
  for (const std::uint32_t v : region.corners)
    if (to[v] != kNone) out.corners.push_back(to[v]);
  region = std::move(out);
}

std::uint32_t add_vertex(Region& region, LatticePoint at) {
  region.mesh.positions.push_back(at);
  region.source_vertex.push_back(kNone);
  return static_cast<std::uint32_t>(region.mesh.positions.size() - 1);
}

void add_face(Region& region, const Triangle& face) {
  region.mesh.faces.push_back(face);
  region.chart_of_face.push_back(kNone);
  if (!region.mesh.polygon_of_face.empty())
    region.mesh.polygon_of_face.push_back(std::ranges::max(region.mesh.polygon_of_face) + 1);
}

StoredMesh put_back(const StoredMesh& stored, const Region& region, const Charts& charts, const WireNet& net) {
  return Joiner(stored, region, charts, net).run();
}

}  // namespace ramcdb::chartify::test
