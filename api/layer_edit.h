#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "api/layers.h"
#include "ramcdb/snapshot.h"

namespace ramcdb::detail {

/// A value as its layer codes it.
struct CodedValue {
  bool absent = false;
  std::vector<std::uint64_t> numbers;

  friend bool operator==(const CodedValue&, const CodedValue&) = default;
};

/// New values of one layer.
struct LayerEdit {
  Layer layer;
  std::map<std::uint64_t, CodedValue> at_vertices;  ///< by VertexKey::packed()
  /// By chart, then by face or by corner (3 * face + 0..2) in decode order.
  std::map<ChartId, std::map<std::uint32_t, CodedValue>> in_charts;

  [[nodiscard]] std::uint64_t count() const;
};

/// The values of a region that `edited` has otherwise, as layers code them; layers without a change are left out.
/// `edited` is as `region.attributes`, or empty. Throws invalid_argument for numbers that a layer cannot hold.
[[nodiscard]] std::vector<LayerEdit> changed_values(const RegionMesh& region, const LayerTable& table,
                                                    const std::vector<Attribute>& edited);

}  // namespace ramcdb::detail
