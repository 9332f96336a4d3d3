#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chartify/recut.h"

namespace ramcdb::chartify {

struct Numbering {
  std::vector<std::uint32_t> number_of_chart;  ///< kNone for charts that hold nothing
  std::vector<std::uint32_t> continues;        ///< per number the old chart that goes on in it, or kNone
};

/// Which new charts old charts go on in, when all faces have their charts.
class Succession {
 public:
  Succession(std::span<const std::uint32_t> old_of_face, std::span<const std::uint32_t> chart_of_face,
             std::uint32_t old_charts);

  /// Per isolated vertex the chart that it is to go to: where most of its old chart's faces are, or, if that had none,
  /// a chart of isolated vertices only, which is made if there are enough of them. kNone: anywhere.
  [[nodiscard]] std::vector<std::uint32_t> wishes(std::span<const std::uint32_t> old_of_isolated, Recut& cut) const;

  /// Charts that go on by old number, then the others in the order of their first faces, then of isolated vertices.
  [[nodiscard]] Numbering number(std::span<const std::uint32_t> chart_of_face,
                                 std::span<const std::uint32_t> old_of_isolated,
                                 std::span<const std::uint32_t> chart_of_isolated);

 private:
  struct Heir {
    std::uint32_t chart = kNone, most = 0;
  };
  /// Old charts without an heir get the chart with most of them among those that `may_inherit`; the first of equal
  /// ones.
  template <class MayInherit>
  void settle(std::span<const std::uint32_t> old_of, std::span<const std::uint32_t> chart_of, MayInherit&& may_inherit);

  std::vector<Heir> heirs_;  ///< per old chart
};

}  // namespace ramcdb::chartify
