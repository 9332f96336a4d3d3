#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "codec/dense_surface.h"
#include "ramcdb/chart.h"

namespace ramcdb::codec {

/// The half-edges of a chart: number 3 f + c runs from corner c of face f to the next corner.
class HalfEdges {
 public:
  /// Nothing when the faces are not an oriented manifold surface that ends just at the chart's loops.
  /// REQUIRES: indices in range. `chart` must outlive the result.
  static std::optional<HalfEdges> of(const Chart& chart);

  [[nodiscard]] static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  [[nodiscard]] static std::uint32_t prev(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  [[nodiscard]] std::uint32_t origin(std::uint32_t h) const { return chart_->faces[h / 3][h % 3]; }
  /// The half-edge on the other side; kNone on the border.
  [[nodiscard]] std::uint32_t twin(std::uint32_t h) const { return twins_[h]; }
  /// The half-edge from border vertex v to the next one of its loop.
  [[nodiscard]] std::uint32_t at_border(std::uint32_t v) const { return border_[v]; }
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(twins_.size()); }

 private:
  explicit HalfEdges(const Chart& chart) : chart_(&chart) {}
  bool match_twins();
  bool match_border();
  [[nodiscard]] bool fans_are_single() const;

  const Chart* chart_;
  std::vector<std::uint32_t> twins_;
  std::vector<std::uint32_t> border_;
};

}  // namespace ramcdb::codec
