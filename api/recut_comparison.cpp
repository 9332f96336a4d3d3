#include "api/recut_comparison.h"

#include <algorithm>
#include <cstring>

#include "api/same_values.h"

namespace ramcdb::detail {

using chartify::NetChart;
using chartify::NetLoopStep;

namespace {

std::uint32_t polygon_size(const RegionMesh& mesh, std::uint32_t face) {
  return mesh.polygon_of_face.empty() ? 3 : mesh.polygon_sizes[mesh.polygon_of_face[face]];
}

}  // namespace

bool RecutComparison::keep(const LoadedChart& old, const NetChart& now, PageChart& entry) const {
  if (old.chart.faces.size() != now.chart.faces.size() || old.chart.positions.size() != now.chart.positions.size() ||
      old.chart.loop_sizes.size() != now.chart.loop_sizes.size())
    return false;
  PageChart same = old.entry;
  std::vector<std::uint32_t> local(old.chart.positions.size(), kNew);  // old vertices -> new ones
  if (!match_loops(old, now, entry, same, local) || !match_faces(old, now, local) || !same_values(now)) return false;
  entry = std::move(same);
  return true;
}

/// Finds each loop of the old chart among those of the new one, begun at the same vertex.
bool RecutComparison::match_loops(const LoadedChart& old, const NetChart& now, const PageChart& entry, PageChart& same,
                                  std::vector<std::uint32_t>& local) const {
  std::vector<bool> taken(now.loops.size(), false);
  std::uint32_t first = 0;
  for (std::size_t l = 0; l < old.chart.loop_sizes.size(); first += old.chart.loop_sizes[l++]) {
    std::vector<std::uint32_t> path;
    for (std::uint32_t i = first; i < first + old.chart.loop_sizes[l]; ++i) {
      const auto v = surface_.vertex_of_key.find(old.keys[i].packed());
      if (v == surface_.vertex_of_key.end()) return false;
      path.push_back(v->second);
    }
    std::uint32_t now_first = 0;
    bool found = false;
    for (std::size_t m = 0; m < now.loops.size() && !found; now_first += now.chart.loop_sizes[m++]) {
      if (taken[m] || now.chart.loop_sizes[m] != path.size()) continue;
      const auto turned = turn_of(path, std::span(now.mesh_vertex).subspan(now_first, path.size()), now.loops[m]);
      if (!turned) continue;
      found = taken[m] = true;
      same.loops[l] = entry.loops[m];
      std::rotate(same.loops[l].begin(), same.loops[l].begin() + static_cast<std::ptrdiff_t>(turned->step),
                  same.loops[l].end());
      for (std::uint32_t i = 0; i < path.size(); ++i)
        local[first + i] = now_first + static_cast<std::uint32_t>((i + turned->vertex) % path.size());
    }
    if (!found) return false;
  }
  return true;
}

/// Where a new loop begins with the first vertex of an old one, at the start of a wire, and then is the same.
std::optional<RecutComparison::Turn> RecutComparison::turn_of(const std::vector<std::uint32_t>& path,
                                                              std::span<const std::uint32_t> loop,
                                                              const std::vector<NetLoopStep>& steps) const {
  std::size_t vertex = 0;
  for (std::size_t s = 0; s < steps.size(); vertex += net_.wires[steps[s++].wire].vertices.size() - 1) {
    std::size_t i = 0;
    while (i < path.size() && path[i] == loop[(vertex + i) % loop.size()]) ++i;
    if (i == path.size()) return Turn{s, vertex};
  }
  return std::nullopt;
}

/// Whether the faces are the same over vertices that are the same, at the same places.
bool RecutComparison::match_faces(const LoadedChart& old, const NetChart& now,
                                  std::vector<std::uint32_t>& local) const {
  std::unordered_map<std::uint32_t, std::uint32_t> face_now;  // old faces, counted in their chart -> new
  const std::uint32_t first = first_face(old.entry.id);
  for (std::uint32_t f = 0; f < now.mesh_face.size(); ++f) {
    const std::uint32_t source = edited_.face_source[surface_.face[now.mesh_face[f]]];
    if (source == kNew || source < first || source - first >= old.chart.faces.size()) return false;
    face_now.emplace(source - first, f);
  }
  std::vector<bool> hit(local.size(), false);
  for (std::uint32_t f = 0; f < old.chart.faces.size(); ++f) {
    const auto it = face_now.find(f);
    if (it == face_now.end()) return false;
    for (int i = 0; i < 3; ++i) {
      std::uint32_t& known = local[old.chart.faces[f][i]];
      const std::uint32_t vertex = now.chart.faces[it->second][i];
      if (known == kNew) known = vertex;
      if (known != vertex) return false;
    }
  }
  const ByKey isolated = isolated_vertices(now);
  for (std::uint32_t v = 0; v < local.size(); ++v) {
    if (local[v] == kNew) {
      const auto found = isolated.find(old.keys[v].packed());
      if (found == isolated.end()) return false;
      local[v] = found->second;
    }
    if (hit[local[v]] || old.chart.positions[v] != now.chart.positions[local[v]]) return false;
    hit[local[v]] = true;
  }
  return true;
}

/// The isolated vertices of a chart by what they were.
RecutComparison::ByKey RecutComparison::isolated_vertices(const NetChart& now) const {
  ByKey isolated;
  std::vector<bool> used(now.mesh_vertex.size(), false);
  for (const Triangle& t : now.chart.faces)
    for (const std::uint32_t v : t) used[v] = true;
  for (std::uint32_t v = now.chart.border_count(); v < used.size(); ++v) {
    const std::uint32_t source = edited_.vertex_source[surface_.vertex[now.mesh_vertex[v]]];
    if (!used[v] && source != kNew) isolated.emplace(region_.keys[source].packed(), v);
  }
  return isolated;
}

/// The region's first face of a chart.
std::uint32_t RecutComparison::first_face(ChartId id) const {
  const auto position = std::ranges::lower_bound(region_.charts, id) - region_.charts.begin();
  return static_cast<std::uint32_t>(
      std::ranges::lower_bound(region_.chart_of_face, static_cast<std::uint32_t>(position)) -
      region_.chart_of_face.begin());
}

/// Whether nothing of a chart's values and exact positions changes, and no polygon of it.
bool RecutComparison::same_values(const NetChart& now) const {
  for (const std::uint32_t v : now.mesh_vertex)
    if (!same_at(AttributeOf::vertex, surface_.vertex[v], edited_.vertex_source[surface_.vertex[v]]) ||
        !same_exact(surface_.vertex[v]))
      return false;
  for (const std::uint32_t f : now.mesh_face) {
    const std::uint32_t face = surface_.face[f], source = edited_.face_source[face];
    if (!same_at(AttributeOf::face, face, source) || polygon_size(edited_.mesh, face) != polygon_size(region_, source))
      return false;
    for (std::uint32_t i = 0; i < 3; ++i)
      if (!same_at(AttributeOf::corner, 3 * face + i, 3 * source + i)) return false;
  }
  return true;
}

bool RecutComparison::same_exact(std::uint32_t vertex) const {
  if (region_.exact.empty()) return true;
  const Point &now = edited_.mesh.exact[vertex], &was = region_.exact[edited_.vertex_source[vertex]];
  return std::memcmp(&now, &was, sizeof now) == 0;
}

bool RecutComparison::same_at(AttributeOf of, std::size_t now, std::size_t was) const {
  return detail::same_values(of, edited_.mesh.attributes, now, region_.attributes, was);
}

}  // namespace ramcdb::detail
