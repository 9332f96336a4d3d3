#pragma once

#include <string>
#include <vector>

#include "ramcdb/wire_net.h"

namespace ramcdb::codec::testing {

struct NamedPage {
  std::string name;
  Page page;
};

/// Part of a net of quadrilateral charts on a torus of side * side cells: `charts` of them, some wires shared with
/// charts elsewhere, ids and figures as `seed` draws them.
[[nodiscard]] LeafPage quad_page(int side, int charts, std::uint32_t seed);

/// Leaf pages with everything that may happen: closed wires, a wire passed twice, wires of one or three charts, several
/// loops, none, crowded corners, layers, extreme values; and inner pages.
[[nodiscard]] std::vector<NamedPage> pages();

}  // namespace ramcdb::codec::testing
