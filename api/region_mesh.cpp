#include "api/region_mesh.h"

#include <algorithm>
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

  std::uint32_t vertex(VertexKey key, LatticePoint point) {
    if (key.where == VertexKey::Where::chart) return add(key, point);
    const auto [it, is_new] = shared_.try_emplace(key.packed(), 0);
    if (is_new) it->second = add(key, point);
    return it->second;
  }

 private:
  std::uint32_t add(VertexKey key, LatticePoint point) {
    region_.keys.push_back(key);
    region_.points.push_back(point);
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
                                    std::unordered_map<WireId, PageWire>& wires) {
  std::vector<LoadedChart> all;
  for (const RegionPart& part : parts) {
    ChartLoader loader(*part.at);
    auto loaded = loader.load(part.charts, threads, cost);
    std::move(loaded.begin(), loaded.end(), std::back_inserter(all));
    for (const auto& [id, wire] : loader.wires()) wires.try_emplace(id, wire.entry);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.entry.id < b.entry.id; });
  return all;
}

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

RegionMesh load_region(std::span<const RegionPart> parts, unsigned threads, ReadCost* cost) {
  std::unordered_map<WireId, PageWire> wires;
  const std::vector<LoadedChart> charts = load_parts(parts, threads, cost, wires);
  RegionMesh region;
  VertexTable table(region);
  for (const LoadedChart& c : charts) {
    const auto position = static_cast<std::uint32_t>(region.charts.size());
    region.charts.push_back(c.entry.id);
    std::vector<std::uint32_t> vertex(c.keys.size());
    for (std::size_t v = 0; v < c.keys.size(); ++v) vertex[v] = table.vertex(c.keys[v], c.chart.positions[v]);
    for (const Triangle& t : c.chart.faces) {
      region.faces.push_back({vertex[t[0]], vertex[t[1]], vertex[t[2]]});
      region.chart_of_face.push_back(position);
    }
  }
  mark_outer_border(region, wires);
  return region;
}

}  // namespace detail
}  // namespace ramcdb
