#pragma once

#include <optional>
#include <span>
#include <unordered_map>

#include "api/chart_loader.h"
#include "api/edit_encoder.h"
#include "api/layer_edit.h"

namespace ramcdb::detail {

/// Moves by VertexKey::packed() of their vertex.
using MoveTable = std::unordered_map<std::uint64_t, const VertexMove*>;

/// Applies the moves of those points whose keys have one.
void move_points(std::span<LatticePoint> points, std::span<const VertexKey> keys, const MoveTable& moves);

/// How charts are coded anew.
struct ChartCoder {
  codec::Profile profile;
  const codec::CoderTables& tables;
  TableId table;
  bool unmoved_too = false;  ///< code charts anew whose vertices stay where they are
};

/// As the mesh's charts are coded.
[[nodiscard]] ChartCoder coder_of(const Snapshot::Impl& at);

/// Codes charts anew after their vertices moved or their values changed. All that it was made with must outlive it.
/// Thread-safe.
class ChartRecoder {
 public:
  ChartRecoder(const Snapshot::Impl& at, const ChartCoder& coder, const MoveTable& moves,
               std::span<const LayerEdit> layers)
      : at_(at), coder_(coder), moves_(moves), layers_(layers) {}

  /// \param loaded with layers when `values_changed`. Without a blob in what comes back the geometry stays.
  [[nodiscard]] RecodedChart run(LoadedChart loaded, bool moved, bool values_changed) const;

 private:
  [[nodiscard]] std::optional<codec::EncodedChart> recode_geometry(const LoadedChart& loaded,
                                                                   RecodedChart& recoded) const;
  void recode_exact(const LoadedChart& loaded, const std::optional<codec::EncodedChart>& encoded,
                    RecodedChart& recoded) const;
  void put_layer(const PageChart& entry, std::uint16_t layer, Buffer blob, RecodedChart& recoded) const;
  [[nodiscard]] LoadedChart with_layers(ChartId id) const;
  void recode_layers(LoadedChart& loaded, const std::optional<codec::EncodedChart>& encoded, bool all,
                     RecodedChart& recoded) const;
  bool apply_edits(const LoadedChart& loaded, const Layer& layer, codec::LayerValues& values) const;

  const Snapshot::Impl& at_;
  ChartCoder coder_;
  const MoveTable& moves_;
  std::span<const LayerEdit> layers_;
};

}  // namespace ramcdb::detail
