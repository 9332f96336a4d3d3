#include "chartify/succession.h"

#include <algorithm>
#include <tuple>

namespace ramcdb::chartify {
namespace {

/// Charts in the order in which items first name them.
std::vector<std::uint32_t> places_of_charts(std::span<const std::uint32_t> of_face,
                                            std::span<const std::uint32_t> of_isolated) {
  std::uint32_t charts = 0, next = 0;
  for (const auto& items : {of_face, of_isolated})
    for (const std::uint32_t c : items) charts = std::max(charts, c + 1);
  std::vector<std::uint32_t> places(charts, kNone);
  for (const auto& items : {of_face, of_isolated})
    for (const std::uint32_t c : items)
      if (places[c] == kNone) places[c] = next++;
  return places;
}

}  // namespace

template <class MayInherit>
void Succession::settle(std::span<const std::uint32_t> old_of, std::span<const std::uint32_t> chart_of,
                        MayInherit&& may_inherit) {
  const std::vector<std::uint32_t> places = places_of_charts(chart_of, {});
  struct Item {
    std::uint32_t old, place, chart;
  };
  std::vector<Item> items;
  for (std::size_t i = 0; i < old_of.size(); ++i)
    if (old_of[i] != kNone && may_inherit(old_of[i], chart_of[i]))
      items.push_back({old_of[i], places[chart_of[i]], chart_of[i]});
  const auto key = [](const Item& item) { return std::pair(item.old, item.place); };
  std::ranges::sort(items, {}, key);
  for (std::size_t i = 0, end; i < items.size(); i = end) {
    for (end = i; end < items.size() && key(items[end]) == key(items[i]);) ++end;
    Heir& heir = heirs_[items[i].old];
    if (end - i > heir.most) heir = {items[i].chart, static_cast<std::uint32_t>(end - i)};
  }
}

Succession::Succession(std::span<const std::uint32_t> old_of_face, std::span<const std::uint32_t> chart_of_face,
                       std::uint32_t old_charts)
    : heirs_(old_charts) {
  settle(old_of_face, chart_of_face, [](std::uint32_t, std::uint32_t) { return true; });
}

std::vector<std::uint32_t> Succession::wishes(std::span<const std::uint32_t> old_of_isolated, Recut& cut) const {
  std::vector<std::uint32_t> count(heirs_.size(), 0), own(heirs_.size(), kNone), wishes;
  for (const std::uint32_t old : old_of_isolated)
    if (old != kNone) ++count[old];
  for (const std::uint32_t old : old_of_isolated) {
    std::uint32_t chart = old == kNone ? kNone : heirs_[old].chart;
    if (old != kNone && chart == kNone && (cut.mesh.faces.empty() || !cut.is_small(count[old]))) {
      if (own[old] == kNone) own[old] = cut.add_chart();
      chart = own[old];
    }
    wishes.push_back(chart);
  }
  return wishes;
}

Numbering Succession::number(std::span<const std::uint32_t> chart_of_face,
                             std::span<const std::uint32_t> old_of_isolated,
                             std::span<const std::uint32_t> chart_of_isolated) {
  std::vector<std::uint32_t> places = places_of_charts(chart_of_face, chart_of_isolated);
  std::vector<std::uint8_t> has_faces(places.size(), 0), has_heir(heirs_.size(), 0);
  for (const std::uint32_t c : chart_of_face) has_faces[c] = 1;
  for (std::size_t old = 0; old < heirs_.size(); ++old) has_heir[old] = heirs_[old].chart != kNone;
  settle(old_of_isolated, chart_of_isolated,
         [&](std::uint32_t old, std::uint32_t chart) { return !has_heir[old] && !has_faces[chart]; });

  std::vector<std::uint32_t> predecessor(places.size(), kNone);
  for (std::uint32_t old = 0; old < heirs_.size(); ++old) {
    if (heirs_[old].chart == kNone) continue;
    std::uint32_t& best = predecessor[heirs_[old].chart];
    if (best == kNone || heirs_[old].most > heirs_[best].most) best = old;
  }
  std::vector<std::uint32_t> order;
  for (std::uint32_t c = 0; c < places.size(); ++c)
    if (places[c] != kNone) order.push_back(c);
  std::ranges::sort(order, {}, [&](std::uint32_t c) { return std::pair(predecessor[c], places[c]); });
  Numbering out{std::vector<std::uint32_t>(places.size(), kNone), {}};
  for (const std::uint32_t c : order) {
    out.number_of_chart[c] = static_cast<std::uint32_t>(out.continues.size());
    out.continues.push_back(predecessor[c]);
  }
  return out;
}

}  // namespace ramcdb::chartify
