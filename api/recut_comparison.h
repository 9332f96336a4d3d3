#pragma once

#include "api/recut_surface.h"
#include "chartify/wire_net_builder.h"

namespace ramcdb::detail {

/// Tells which of the charts that were cut anew are what they were, so that they keep their blobs.
class RecutComparison {
 public:
  /// All must outlive this.
  RecutComparison(const RegionMesh& region, const EditedRegion& edited, const RecutSurface& surface,
                  const chartify::WireNet& net)
      : region_(region), edited_(edited), surface_(surface), net_(net) {}

  /// Whether a chart has the very faces, borders, places, polygons and values that `old` had. Then `entry`, which has
  /// its loops as they are now, becomes what the old entry was, with these loops begun where the old ones begin.
  [[nodiscard]] bool keep(const LoadedChart& old, const chartify::NetChart& now, PageChart& entry) const;

 private:
  struct Turn {
    std::size_t step, vertex;  ///< of the new loop, where the old one begins
  };
  [[nodiscard]] bool match_loops(const LoadedChart& old, const chartify::NetChart& now, const PageChart& entry,
                                 PageChart& same, std::vector<std::uint32_t>& local) const;
  [[nodiscard]] std::optional<Turn> turn_of(const std::vector<std::uint32_t>& path, std::span<const std::uint32_t> loop,
                                            const std::vector<chartify::NetLoopStep>& steps) const;
  [[nodiscard]] bool match_faces(const LoadedChart& old, const chartify::NetChart& now,
                                 std::vector<std::uint32_t>& local) const;
  using ByKey = std::unordered_map<std::uint64_t, std::uint32_t>;
  [[nodiscard]] ByKey isolated_vertices(const chartify::NetChart& now) const;
  [[nodiscard]] std::uint32_t first_face(ChartId id) const;
  [[nodiscard]] bool same_values(const chartify::NetChart& now) const;
  [[nodiscard]] bool same_exact(std::uint32_t vertex) const;
  [[nodiscard]] bool same_at(AttributeOf of, std::size_t now, std::size_t was) const;

  const RegionMesh& region_;
  const EditedRegion& edited_;
  const RecutSurface& surface_;
  const chartify::WireNet& net_;
};

}  // namespace ramcdb::detail
