#include "api/region_mesh.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "ramcdb/error.h"

namespace ramcdb {

std::uint64_t VertexKey::packed() const {
  return (static_cast<std::uint64_t>(where) << 62) | (static_cast<std::uint64_t>(id) << 30) | index;
}

VertexKey VertexKey::unpack(std::uint64_t packed) {
  const auto where = static_cast<unsigned>(packed >> 62);
  const VertexKey key{static_cast<Where>(where), static_cast<std::uint32_t>(packed >> 30),
                      static_cast<std::uint32_t>(packed & ((1U << 30) - 1))};
  if (where == 0 || key.id == 0) throw Error(Errc::invalid_argument, "this is not a vertex key");
  return key;
}

namespace detail {
namespace {

/// Gives every key its vertex of the region. A wire that was cut between two versions has several names: where charts
/// of several versions meet, a vertex is known by its place as well.
class VertexTable {
 public:
  VertexTable(RegionMesh& region, bool mixed_versions) : region_(region), mixed_versions_(mixed_versions) {}

  /// \param v vertex of the chart
  /// \param part the part of the region that the chart is of
  std::uint32_t vertex(const LoadedChart& chart, std::size_t v, std::size_t part) {
    const VertexKey key = chart.keys[v];
    if (key.where == VertexKey::Where::chart) return add(chart, v);
    const auto [it, is_new] = shared_.try_emplace(key.packed(), 0);
    if (is_new) it->second = mixed_versions_ ? at_place(chart, v, part) : add(chart, v);
    if (mixed_versions_) named_.emplace(it->second, part);
    return it->second;
  }

 private:
  /// A vertex at the same place that the charts of this part have not named yet, or a new one.
  std::uint32_t at_place(const LoadedChart& chart, std::size_t v, std::size_t part) {
    std::vector<std::uint32_t>& here = at_place_[chart.chart.positions[v]];
    for (const std::uint32_t vertex : here)
      if (!named_.contains({vertex, part})) return vertex;
    here.push_back(add(chart, v));
    return here.back();
  }

  std::uint32_t add(const LoadedChart& chart, std::size_t v) {
    region_.keys.push_back(chart.keys[v]);
    region_.points.push_back(chart.chart.positions[v]);
    if (!chart.exact.empty()) region_.exact.push_back(chart.exact[v]);
    return static_cast<std::uint32_t>(region_.points.size() - 1);
  }

  RegionMesh& region_;
  bool mixed_versions_;
  std::unordered_map<std::uint64_t, std::uint32_t> shared_;
  std::map<LatticePoint, std::vector<std::uint32_t>> at_place_;
  std::set<std::pair<std::uint32_t, std::size_t>> named_;
};

struct Loaded {
  LoadedChart chart;
  std::size_t part;
};

std::vector<Loaded> load_parts(std::span<const RegionPart> parts, unsigned threads, ReadCost* cost, bool with_layers,
                               std::vector<std::unordered_map<WireId, PageWire>>& wires) {
  std::vector<Loaded> all;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    ChartLoader loader(*parts[p].at);
    for (LoadedChart& chart : loader.load(parts[p].charts, threads, cost, with_layers))
      all.push_back({std::move(chart), p});
    wires.emplace_back();
    for (const auto& [id, wire] : loader.wires()) wires.back().try_emplace(id, wire.entry);
  }
  std::ranges::sort(all, {}, [](const Loaded& loaded) { return loaded.chart.entry.id; });
  return all;
}

/// Gathers the values of charts for the vertices, corners and faces of a region.
class ValueJoiner {
 public:
  ValueJoiner(RegionMesh& region, const LayerTable& table) : region_(region), table_(table) {
    for (const Layer& layer : table.layers)
      if (layer.coding != LayerCoding::polygons) region.attributes.push_back({layer.info, {}});
  }

  /// \param vertex region vertices of the chart's, whose faces were added last
  void add(const LoadedChart& chart, const std::vector<std::uint32_t>& vertex) {
    std::size_t a = 0;
    for (std::size_t i = 0; i < table_.layers.size(); ++i)
      if (table_.layers[i].coding != LayerCoding::polygons)
        add(table_.layers[i], chart.layers[i], vertex, region_.attributes[a++].values);
    add(chart.polygons, region_.faces.size() - chart.chart.faces.size());
  }

  void finish() {
    if (region_.polygon_sizes.size() < region_.faces.size()) return;
    region_.polygon_of_face.clear();
    region_.polygon_sizes.clear();
    region_.polygon_corners.clear();
  }

 private:
  void add(const Layer& layer, const codec::LayerValues& values, const std::vector<std::uint32_t>& vertex,
           std::vector<double>& to) {
    const std::size_t components = layer.info.components, numbers = layer.shape().components;
    const std::size_t count = values.numbers.size() / numbers;
    const bool of_vertices = layer.info.of == AttributeOf::vertex;
    const std::size_t first = to.size();
    to.resize(of_vertices ? region_.points.size() * components : first + count * components);
    for (std::size_t i = 0; i < count; ++i) {
      const std::span value =
          std::span(to).subspan(of_vertices ? vertex[i] * components : first + i * components, components);
      if (!values.absent.empty() && values.absent[i])
        std::fill(value.begin(), value.end(), std::numeric_limits<double>::quiet_NaN());
      else
        from_numbers(layer, std::span(values.numbers).subspan(i * numbers, numbers), value);
    }
  }

  void add(const codec::Polygons& polygons, std::size_t first_face) {
    const auto first_polygon = static_cast<std::uint32_t>(region_.polygon_sizes.size());
    for (const std::uint32_t polygon : polygons.of_face) region_.polygon_of_face.push_back(first_polygon + polygon);
    region_.polygon_sizes.insert(region_.polygon_sizes.end(), polygons.sizes.begin(), polygons.sizes.end());
    for (const std::uint32_t corner : polygons.corners)
      region_.polygon_corners.push_back(static_cast<std::uint32_t>(3 * first_face) + corner);
  }

  RegionMesh& region_;
  const LayerTable& table_;
};

/// The edges of a chart's border that charts outside the region share.
/// \param vertex region vertices of the chart's
void add_outer_edges(RegionMesh& region, const LoadedChart& chart, const std::vector<std::uint32_t>& vertex,
                     const std::function<bool(WireId)>& is_outer, const std::unordered_map<WireId, PageWire>& wires) {
  std::uint32_t first = 0;
  for (std::size_t l = 0; l < chart.entry.loops.size(); first += chart.chart.loop_sizes[l++]) {
    const std::uint32_t size = chart.chart.loop_sizes[l];
    std::uint32_t at = 0;
    for (const DirectedWire step : chart.entry.loops[l]) {
      const std::uint32_t end = at + wires.at(step.wire).inner_points + 1;
      for (; at < end; ++at) {
        if (!is_outer(step.wire)) continue;
        const std::uint32_t u = vertex[first + at], v = vertex[first + (at + 1) % size];
        region.outer_edges.push_back({std::min(u, v), std::max(u, v)});
      }
    }
  }
}

void mark_outer_border(RegionMesh& region) {
  std::ranges::sort(region.outer_edges);
  region.outer_edges.erase(std::unique(region.outer_edges.begin(), region.outer_edges.end()), region.outer_edges.end());
  region.outer_border.assign(region.points.size(), false);
  for (const auto& edge : region.outer_edges)
    for (const std::uint32_t v : edge) region.outer_border[v] = true;
}

}  // namespace

std::vector<Point> positions_in(const RegionMesh& mesh, const Lattice& lattice) {
  std::vector<Point> positions;
  positions.reserve(mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) positions.push_back(position_in(mesh, lattice, v));
  return positions;
}

Point middle_of(std::span<const Point> points) {
  if (points.empty()) return {};
  Point lo = points.front(), hi = lo;
  for (const Point& p : points)
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], p[a]);
      hi[a] = std::max(hi[a], p[a]);
    }
  return {lo.x + (hi.x - lo.x) / 2, lo.y + (hi.y - lo.y) / 2, lo.z + (hi.z - lo.z) / 2};
}

RegionMesh load_region(std::span<const RegionPart> parts, unsigned threads, ReadCost* cost, bool with_layers) {
  std::vector<std::unordered_map<WireId, PageWire>> wires;
  const std::vector<Loaded> charts = load_parts(parts, threads, cost, with_layers, wires);
  RegionMesh region;
  for (const Loaded& loaded : charts) region.charts.push_back(loaded.chart.entry.id);
  std::optional<ValueJoiner> values;
  if (with_layers) values.emplace(region, parts.front().at->layers());
  VertexTable table(region, parts.size() > 1);
  std::uint32_t position = 0;
  for (const auto& [c, part] : charts) {
    std::vector<std::uint32_t> vertex(c.keys.size());
    for (std::size_t v = 0; v < c.keys.size(); ++v) vertex[v] = table.vertex(c, v, part);
    for (const Triangle& t : c.chart.faces) {
      region.faces.push_back({vertex[t[0]], vertex[t[1]], vertex[t[2]]});
      region.chart_of_face.push_back(position);
    }
    ++position;
    const auto& wires_here = wires[part];
    const auto is_outer = [&](WireId id) {
      return !std::ranges::all_of(wires_here.at(id).charts,
                                  [&](ChartId other) { return std::ranges::binary_search(region.charts, other); });
    };
    add_outer_edges(region, c, vertex, is_outer, wires_here);
    if (values) values->add(c, vertex);
  }
  if (values) values->finish();
  mark_outer_border(region);
  return region;
}

}  // namespace detail
}  // namespace ramcdb
