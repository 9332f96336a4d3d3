#pragma once

#include <string>
#include <vector>

#include "codec/chart_codec.h"

namespace ramcdb::codec::testing {

struct NamedChart {
  std::string name;
  Chart chart;
};

/// Charts of every kind that the dense coder takes: manifold, oriented, ending at their loops.
[[nodiscard]] std::vector<NamedChart> manifold_charts();

/// Charts that only raw coding takes: repeated and degenerate faces, loops that are no border, two fans at a vertex.
[[nodiscard]] std::vector<NamedChart> broken_charts();

/// Any faces at all over few vertices.
[[nodiscard]] Chart triangle_soup(std::uint32_t seed);

// Single ones.
/// Closed boxes along the axes: an aligned chart.
[[nodiscard]] Chart boxes(std::size_t count);
[[nodiscard]] Chart one_triangle();
/// One vertex among `rim` others, in the middle of them or, with `open`, on the border itself.
[[nodiscard]] Chart wheel(std::uint32_t rim, bool open);

}  // namespace ramcdb::codec::testing
