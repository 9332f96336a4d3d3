#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ramcdb/bytes.h"
#include "ramcdb/chart.h"
#include "ramcdb/ids.h"

namespace ramcdb::codec {

/// A group of wires that share a blob is closed once it has so many inner points: about 1 KB, which a chart's reader
/// decodes in a fraction of the time that the chart takes. Decoders take no further wire then.
inline constexpr std::size_t kWireGroupPoints = 512;

struct WireOfGroup {
  WireId id;
  const Wire* wire;
};

/// Codes the inner points of wires into one blob; their ends are corners, known from the wire-net. Ids ascend, every
/// wire has inner points, and all but the last have fewer than kWireGroupPoints. Equal input gives equal bytes on every
/// machine. Throws invalid_argument and limit_exceeded.
[[nodiscard]] Buffer encode_wires(std::span<const WireOfGroup> wires);

/// The blob of a group of wires, some that follow one another in a list.
struct CodedWireGroup {
  std::size_t first = 0, count = 0;
  Buffer blob;
};

/// Codes wires in groups that share a blob. REQUIRES and throws as encode_wires; no wires give no groups.
[[nodiscard]] std::vector<CodedWireGroup> encode_in_groups(std::span<const WireOfGroup> wires);

/// A decoded wire blob. What it holds are differences from predictions, so a wire comes out of it with nothing but its
/// own ends, whatever became of the others since.
class WireGroup {
 public:
  /// Throws corrupt for bytes that no encoder wrote, unsupported_version for another format.
  explicit WireGroup(Bytes blob);

  /// A wire between its ends. Throws corrupt unless the blob holds it, with `inner_points` points on the lattice.
  [[nodiscard]] Wire wire(WireId id, LatticePoint begin, LatticePoint end, std::uint32_t inner_points) const;

  /// What a wire takes of `bytes`, by points; the shares of all wires add up to it. Throws corrupt as wire() does.
  [[nodiscard]] std::uint64_t share_of(WireId id, std::uint64_t bytes) const;

  /// Ids of the wires that it holds, ascending.
  [[nodiscard]] std::vector<WireId> ids() const;

 private:
  struct Member {
    WireId id;
    bool linear;                 ///< the predictor
    std::uint32_t first, count;  ///< its residuals

    friend bool operator==(const Member&, const Member&) = default;
  };

  WireGroup() = default;
  template <class Coder>
  friend class WireGroupCoder;
  friend Buffer encode_wires(std::span<const WireOfGroup> wires);
  [[nodiscard]] const Member& member(WireId id) const;

  std::vector<Member> members_;
  std::vector<std::array<std::int32_t, 3>> residuals_;
};

}  // namespace ramcdb::codec
