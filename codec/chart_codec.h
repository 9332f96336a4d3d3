#pragma once

#include <cstdint>
#include <span>

#include "codec/tables.h"
#include "ramcdb/bytes.h"
#include "ramcdb/chart.h"

namespace ramcdb::codec {

/// What a chart is coded with unless it does not pay: `dense` for size, `fast` for decoding speed.
enum class Profile : std::uint8_t { dense = 1, fast = 2 };

/// How a chart blob was coded: the second byte of the blob.
enum class ChartCoding : std::uint8_t { raw = 1, dense = 2, fast = 3 };

/// Where the bits of a chart blob went, in 1/256 bit, so that sums over charts stay exact. Encoder and decoder count
/// the same. header + connectivity + geometry = 8 * 256 * blob size.
struct ChartCost {
  std::uint64_t header = 0;
  std::uint64_t connectivity = 0;
  std::uint64_t geometry = 0;

  friend bool operator==(const ChartCost&, const ChartCost&) = default;
};

struct EncodedChart {
  Buffer blob;
  ChartCoding coding = ChartCoding::dense;
  ChartCost cost;
  bool expanded_range = false;  ///< inner vertices left `range`, so the blob carries a box of its own
  /// What decode_chart will return: the same chart with inner vertices and faces in decode order.
  Chart decoded;
  /// decoded vertex -> vertex of the chart passed in; the identity on border vertices.
  std::vector<std::uint32_t> source_vertex;
  /// decoded face -> the corner (3 * face + 0..2) of the chart passed in that became its first one.
  std::vector<std::uint32_t> source_corner;
};

/// Codes a chart: its inner vertices and its faces. Border positions and loop sizes are context, known from the wires;
/// they are not stored, but the blob's check covers them. Any chart is taken (docs of Chart say what a chart is); what
/// the profile cannot take or makes larger is coded raw. The blob is decoded again and compared before it is returned.
/// Equal input gives equal bytes on every machine; encoding `decoded` again gives the same bytes.
/// \param range the mesh's shared quantization range: the box that inner vertices are expected in.
/// Throws invalid_argument when `chart` is not a chart (index out of range, loop of two vertices).
[[nodiscard]] EncodedChart encode_chart(const Chart& chart, Profile profile, const CoderTables& tables,
                                        const LatticeBox& range);

struct DecodedChart {
  Chart chart;
  ChartCoding coding = ChartCoding::dense;
  ChartCost cost;
};

/// Decodes a chart blob. `border` and `loop_sizes` as in Chart; `range` and `tables` as at encoding. Bytes may be
/// hostile: every index and count is checked, work and memory are bounded by counts that are checked first.
/// Throws corrupt, also when border, tables or range are not those that the blob was coded with.
[[nodiscard]] DecodedChart decode_chart(Bytes blob, std::span<const LatticePoint> border,
                                        std::span<const std::uint32_t> loop_sizes, const CoderTables& tables,
                                        const LatticeBox& range);

}  // namespace ramcdb::codec
