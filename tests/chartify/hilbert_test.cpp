#include "chartify/hilbert.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace ramcdb::chartify::test {
namespace {

using Cell = std::array<std::uint32_t, 3>;

TEST(Hilbert, TheCurveGoesFromCellToCellBesideItThroughTheWholeCube) {
  for (const int bits : {1, 2, 3, 5}) {
    const std::uint32_t side = 1U << bits;
    std::vector<Cell> cells(std::size_t{side} * side * side);
    std::vector<bool> seen(cells.size(), false);
    for (std::uint32_t x = 0; x < side; ++x)
      for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t z = 0; z < side; ++z) {
          const std::uint64_t key = hilbert_key({x, y, z}, bits);
          ASSERT_LT(key, cells.size());
          EXPECT_FALSE(seen[key]);
          seen[key] = true;
          cells[key] = {x, y, z};
        }
    for (std::size_t i = 1; i < cells.size(); ++i) {
      int steps = 0;
      for (std::size_t a = 0; a < 3; ++a)
        steps += std::abs(static_cast<int>(cells[i][a]) - static_cast<int>(cells[i - 1][a]));
      ASSERT_EQ(steps, 1) << "before key " << i << " of " << bits << " bits";
    }
  }
}

/// Charts of a mesh depend on it: keys as Skilling's own loop gives them, never to change.
TEST(Hilbert, KeysAreSkillings) {
  EXPECT_EQ(hilbert_key({1, 2, 3}, 2), 22U);
  EXPECT_EQ(hilbert_key({5, 0, 7}, 3), 430U);
  EXPECT_EQ(hilbert_key({65535, 1, 40000}, 16), 246035208919914U);
  EXPECT_EQ(hilbert_key({12345, 54321, 777}, 16), 131844176086295U);
  EXPECT_EQ(hilbert_key({2097151, 0, 1048576}, 21), 8070450532247928831U);
  EXPECT_EQ(hilbert_key({0, 0, 2097151}, 21), 1317624576693539401U);
}

}  // namespace
}  // namespace ramcdb::chartify::test
