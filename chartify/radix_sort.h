#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

namespace ramcdb::chartify {

/// Stable, by a whole number, byte by byte from the lowest on; bytes that all have alike cost nothing.
/// \param key a member of items, or what tells their number
template <class Item, class Key>
void radix_sort(std::vector<Item>& items, Key key) {
  using Number = std::remove_cvref_t<std::invoke_result_t<Key, const Item&>>;
  static_assert(std::is_unsigned_v<Number>);
  constexpr std::size_t kBytes = sizeof(Number);
  std::array<std::array<std::size_t, 256>, kBytes> begins{};
  const auto byte_of = [&](const Item& item, std::size_t b) { return std::invoke(key, item) >> 8 * b & 0xff; };
  for (const Item& item : items)
    for (std::size_t b = 0; b < kBytes; ++b) ++begins[b][byte_of(item, b)];
  std::vector<Item> sorted(items.size());
  for (std::size_t b = 0; b < kBytes && !items.empty(); ++b) {
    if (begins[b][byte_of(items.front(), b)] == items.size()) continue;
    std::size_t at = 0;
    for (std::size_t& begin : begins[b]) at += std::exchange(begin, at);
    for (const Item& item : items) sorted[begins[b][byte_of(item, b)]++] = item;
    items.swap(sorted);
  }
}

}  // namespace ramcdb::chartify
