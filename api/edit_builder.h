#pragma once

#include <map>

#include "api/chart_recoder.h"
#include "api/edit_encoder.h"

namespace ramcdb::detail {

/// Puts an EncodedEdit together: what is added goes to its blobs, pages and record alike.
class EditBuilder {
 public:
  explicit EditBuilder(const Snapshot::Impl& at) : at_(at) { edit_.record = at.record(); }

  [[nodiscard]] EncodedEdit& edit() { return edit_; }
  [[nodiscard]] MeshRecord& record() { return edit_.record; }

  /// Its layers and geometry that were coded anew.
  void add_chart(RecodedChart chart);
  void add_blob(db::Kind kind, std::uint32_t id, Buffer bytes, std::uint16_t layer = 0);
  /// A wire with other points than before; those with inner points are coded by finish().
  /// \param bytes_before its share of the blob that it was in, checksum included; 0 for a new one
  void add_wire(const PageWire& entry, Wire points, std::uint64_t bytes_before);
  /// Codes the wires and returns all.
  [[nodiscard]] EncodedEdit finish();

 private:
  const Snapshot::Impl& at_;
  EncodedEdit edit_;
  std::map<WireId, Wire> wires_;
};

}  // namespace ramcdb::detail
