#include "api/edit_builder.h"

#include <algorithm>

#include "api/store_format.h"
#include "codec/wire_codec.h"

namespace ramcdb::detail {

void EditBuilder::add_blob(db::Kind kind, std::uint32_t id, Buffer bytes, std::uint16_t layer) {
  edit_.blobs.push_back({{kind, at_.root().mesh, id, {}, layer}, std::move(bytes)});
}

void EditBuilder::add_chart(RecodedChart chart) {
  if (!chart.any()) return;
  const ChartId id = chart.entry.id;
  edit_.changed.push_back(id);
  edit_.layers_reencoded += chart.layers.size();
  for (RecodedLayer& layer : chart.layers) {
    record().bytes_of_layer(layer.layer) += layer.blob.size() + kBlobOverhead - layer.bytes_before;
    add_blob(db::Kind::attribute, id.value, std::move(layer.blob), layer.layer);
  }
  if (!chart.blob.empty()) {
    ++edit_.charts_reencoded;
    edit_.ranges_expanded += chart.expanded_range;
    codec::ChartCost& cost = record().chart_cost;
    cost.header += chart.cost.header - chart.cost_before.header;
    cost.connectivity += chart.cost.connectivity - chart.cost_before.connectivity;
    cost.geometry += chart.cost.geometry - chart.cost_before.geometry;
    add_blob(db::Kind::chart, id.value, std::move(chart.blob));
  }
  edit_.pages.charts[id] = std::move(chart.entry);
}

void EditBuilder::add_wire(const PageWire& entry, Wire points, std::uint64_t bytes_before) {
  record().wire_bytes -= bytes_before;
  PageWire& put = edit_.pages.wires[entry.id] = entry;
  put.version = VersionId();
  put.group = entry.id;
  if (!entry.inner_points) return;
  ++edit_.wires_reencoded;
  wires_.emplace(entry.id, std::move(points));
}

EncodedEdit EditBuilder::finish() {
  std::vector<codec::WireOfGroup> wires;
  for (const auto& [id, points] : wires_) wires.push_back({id, &points});
  for (codec::CodedWireGroup& group : codec::encode_in_groups(wires)) {
    const WireId first = wires[group.first].id;
    for (std::size_t i = 0; i < group.count; ++i) edit_.pages.wires.at(wires[group.first + i].id).group = first;
    record().wire_bytes += group.blob.size() + kBlobOverhead;
    add_blob(db::Kind::wire, first.value, std::move(group.blob));
  }
  std::ranges::sort(edit_.changed);
  return std::move(edit_);
}

}  // namespace ramcdb::detail
