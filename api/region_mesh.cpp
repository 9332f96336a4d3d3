#include "api/region_mesh.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <unordered_set>

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

/// Gives every key its vertex of the region.
class VertexTable {
 public:
  explicit VertexTable(RegionMesh& region) : region_(region) {}

  /// \param v vertex of the chart
  std::uint32_t vertex(const LoadedChart& chart, std::size_t v) {
    const VertexKey key = chart.keys[v];
    if (key.where == VertexKey::Where::chart) return add(chart, v);
    const auto [it, is_new] = shared_.try_emplace(key.packed(), 0);
    if (is_new) it->second = add(chart, v);
    return it->second;
  }

 private:
  std::uint32_t add(const LoadedChart& chart, std::size_t v) {
    region_.keys.push_back(chart.keys[v]);
    region_.points.push_back(chart.chart.positions[v]);
    if (!chart.exact.empty()) region_.exact.push_back(chart.exact[v]);
    return static_cast<std::uint32_t>(region_.points.size() - 1);
  }

  RegionMesh& region_;
  std::unordered_map<std::uint64_t, std::uint32_t> shared_;
};

struct Loaded {
  LoadedChart chart;
  std::vector<PageWire> wires;
};

std::vector<LoadedChart> load_parts(std::span<const RegionPart> parts, unsigned threads, ReadCost* cost,
                                    bool with_layers, std::unordered_map<WireId, PageWire>& wires) {
  std::vector<LoadedChart> all;
  for (const RegionPart& part : parts) {
    ChartLoader loader(*part.at);
    auto loaded = loader.load(part.charts, threads, cost, with_layers);
    std::move(loaded.begin(), loaded.end(), std::back_inserter(all));
    for (const auto& [id, wire] : loader.wires()) wires.try_emplace(id, wire.entry);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.entry.id < b.entry.id; });
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

/// Marks the vertices of wires that charts outside the region pass, and the corners where such wires end.
void mark_outer_border(RegionMesh& region, const std::unordered_map<WireId, PageWire>& wires) {
  std::unordered_set<std::uint32_t> outer_wires, outer_corners;
  for (const auto& [id, wire] : wires) {
    const bool outer = std::any_of(wire.charts.begin(), wire.charts.end(), [&](ChartId c) {
      return !std::binary_search(region.charts.begin(), region.charts.end(), c);
    });
    if (!outer) continue;
    outer_wires.insert(id.value);
    outer_corners.insert(wire.begin.value);
    outer_corners.insert(wire.end.value);
  }
  region.outer_border.assign(region.points.size(), false);
  for (std::size_t v = 0; v < region.keys.size(); ++v) {
    const VertexKey key = region.keys[v];
    region.outer_border[v] = (key.where == VertexKey::Where::wire && outer_wires.contains(key.id)) ||
                             (key.where == VertexKey::Where::corner && outer_corners.contains(key.id));
  }
}

}  // namespace

RegionMesh load_region(std::span<const RegionPart> parts, unsigned threads, ReadCost* cost, bool with_layers) {
  std::unordered_map<WireId, PageWire> wires;
  const std::vector<LoadedChart> charts = load_parts(parts, threads, cost, with_layers, wires);
  RegionMesh region;
  std::optional<ValueJoiner> values;
  if (with_layers) values.emplace(region, parts.front().at->layers());
  VertexTable table(region);
  for (const LoadedChart& c : charts) {
    const auto position = static_cast<std::uint32_t>(region.charts.size());
    region.charts.push_back(c.entry.id);
    std::vector<std::uint32_t> vertex(c.keys.size());
    for (std::size_t v = 0; v < c.keys.size(); ++v) vertex[v] = table.vertex(c, v);
    for (const Triangle& t : c.chart.faces) {
      region.faces.push_back({vertex[t[0]], vertex[t[1]], vertex[t[2]]});
      region.chart_of_face.push_back(position);
    }
    if (values) values->add(c, vertex);
  }
  if (values) values->finish();
  mark_outer_border(region, wires);
  return region;
}

}  // namespace detail
}  // namespace ramcdb
