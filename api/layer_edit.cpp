#include "api/layer_edit.h"

#include <span>

#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

CodedValue coded(const Layer& layer, const Attribute& attribute, std::size_t at) {
  CodedValue value;
  value.numbers.resize(layer.shape().components);
  value.absent = !to_numbers(
      layer, std::span(attribute.values).subspan(at * layer.info.components, layer.info.components), value.numbers);
  return value;
}

/// The first face of each chart of a region, and the end of the last.
std::vector<std::uint32_t> first_faces(const RegionMesh& region) {
  std::vector<std::uint32_t> firsts(region.charts.size() + 1, 0);
  for (const std::uint32_t chart : region.chart_of_face) ++firsts[chart + 1];
  for (std::size_t c = 1; c < firsts.size(); ++c) firsts[c] += firsts[c - 1];
  return firsts;
}

}  // namespace

std::uint64_t LayerEdit::count() const {
  std::uint64_t count = at_vertices.size();
  for (const auto& [chart, values] : in_charts) count += values.size();
  return count;
}

std::vector<LayerEdit> changed_values(const RegionMesh& region, const LayerTable& table,
                                      const std::vector<Attribute>& edited) {
  std::vector<LayerEdit> edits;
  if (edited.empty()) return edits;
  if (edited.size() != region.attributes.size())
    throw Error(Errc::invalid_argument, "the region has other attributes", {}, "change values, not the attributes");
  const std::vector<std::uint32_t> firsts = first_faces(region);
  std::size_t a = 0;
  for (const Layer& layer : table.layers) {
    if (layer.coding == LayerCoding::polygons) continue;
    const Attribute &before = region.attributes[a], &after = edited[a];
    ++a;
    if (after.values.size() != before.values.size())
      throw Error(Errc::invalid_argument, "attribute '" + layer.info.name + "' has another number of values");
    LayerEdit edit;
    edit.layer = layer;
    for (std::size_t at = 0; at < before.count(); ++at) {
      CodedValue value = coded(layer, after, at);
      if (value == coded(layer, before, at)) continue;
      if (layer.info.of == AttributeOf::vertex) {
        edit.at_vertices.emplace(region.keys[at].packed(), std::move(value));
        continue;
      }
      const std::uint32_t per_face = layer.info.of == AttributeOf::corner ? 3 : 1;
      const std::uint32_t chart = region.chart_of_face[at / per_face];
      edit.in_charts[region.charts[chart]].emplace(static_cast<std::uint32_t>(at) - per_face * firsts[chart],
                                                   std::move(value));
    }
    if (edit.count()) edits.push_back(std::move(edit));
  }
  return edits;
}

}  // namespace ramcdb::detail
