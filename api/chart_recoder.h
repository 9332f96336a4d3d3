#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "api/change_set.h"
#include "api/chart_loader.h"

namespace ramcdb::detail {

/// Moves by VertexKey::packed().
using MoveTable = std::unordered_map<std::uint64_t, const VertexMove*>;

void move_points(std::span<LatticePoint> points, std::span<const VertexKey> keys, const MoveTable& moves);

struct RecodedLayer {
  std::uint16_t layer = 0;
  Buffer blob;
  std::uint64_t bytes_before = 0;  ///< checksum included
};

/// A chart of which something was coded anew; its connectivity is what it was.
struct RecodedChart {
  PageChart entry;  ///< with version 0 where a blob is new
  Buffer blob;      ///< empty when its geometry stays
  codec::ChartCost cost_before, cost;
  bool expanded_range = false;
  std::vector<RecodedLayer> layers;

  [[nodiscard]] bool any() const { return !blob.empty() || !layers.empty(); }
};

/// How charts are coded anew.
struct ChartCoder {
  codec::Profile profile;
  const codec::CoderTables& tables;
  TableId table;
  bool unmoved_too = false;  ///< code charts anew whose vertices stay where they are
};

/// The way that the charts of a mesh are coded.
[[nodiscard]] ChartCoder coder_of(const Snapshot::Impl& at);

/// Codes charts anew whose vertices move or whose values change. Layers follow connectivity, so they stay when vertices
/// move; only where a component has no border to begin at may another order of its faces make them new.
class ChartRecoder {
 public:
  /// All must outlive the recoder.
  ChartRecoder(const Snapshot::Impl& at, const ChartCoder& coder, const MoveTable& moves,
               std::span<const LayerEdit> layers)
      : at_(at), coder_(coder), moves_(moves), layers_(layers) {}

  /// \param values_changed whether layers of the chart may change; it was loaded with them
  [[nodiscard]] RecodedChart run(LoadedChart loaded, bool moved, bool values_changed) const;

 private:
  [[nodiscard]] std::optional<codec::EncodedChart> recode_geometry(const LoadedChart& loaded,
                                                                   RecodedChart& recoded) const;
  void recode_exact(const LoadedChart& loaded, const std::optional<codec::EncodedChart>& encoded,
                    RecodedChart& recoded) const;
  void recode_layers(LoadedChart& loaded, const std::optional<codec::EncodedChart>& encoded, bool all,
                     RecodedChart& recoded) const;
  [[nodiscard]] bool apply_edits(const LoadedChart& loaded, const Layer& layer, codec::LayerValues& values) const;
  void put_layer(std::uint16_t layer, Buffer blob, RecodedChart& recoded) const;
  [[nodiscard]] LoadedChart with_layers(ChartId id) const;

  const Snapshot::Impl& at_;
  ChartCoder coder_;
  const MoveTable& moves_;
  std::span<const LayerEdit> layers_;
};

}  // namespace ramcdb::detail
