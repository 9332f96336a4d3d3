#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "chartify/parallel.h"

namespace ramcdb::chartify {

/// Splits work on pairs of charts, `left` and `right` of an item, into turns: items of one turn have no chart in
/// common, and each comes behind those before it that have one in common with it.
template <class Item>
[[nodiscard]] std::vector<std::vector<Item>> in_turns(std::vector<Item> items, std::size_t charts) {
  std::vector<std::vector<Item>> turns;
  std::vector<std::size_t> next_of_chart(charts, 0);
  for (Item& item : items) {
    const std::size_t turn = std::max(next_of_chart[item.left], next_of_chart[item.right]);
    next_of_chart[item.left] = next_of_chart[item.right] = turn + 1;
    turns.resize(std::max(turns.size(), turn + 1));
    turns[turn].push_back(std::move(item));
  }
  return turns;
}

/// Calls work(worker, item) for all items, with one thread per worker. What looks at and changes faces of the item's
/// two charts only finds the same as if one item were done after the other.
template <class Item, class Worker, class Work>
void work_in_turns(std::vector<Item> items, std::size_t charts, std::vector<Worker>& workers, Work&& work) {
  for (const std::vector<Item>& turn : in_turns(std::move(items), charts))
    parallel_for(std::min(workers.size(), turn.size()), static_cast<unsigned>(workers.size()), [&](std::size_t w) {
      for (std::size_t i = w; i < turn.size(); i += workers.size()) work(workers[w], turn[i]);
    });
}

}  // namespace ramcdb::chartify
