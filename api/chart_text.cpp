#include "api/chart_text.h"

#include <fmt/format.h>

namespace ramcdb::detail {

std::string chart_text(std::span<const ChartId> charts) {
  std::string text;
  for (std::size_t i = 0, end; i < charts.size(); i = end) {
    for (end = i + 1; end < charts.size() && charts[end].value == charts[end - 1].value + 1;) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ",", charts[i].value);
    if (end - i > 1) text += fmt::format("-{}", charts[end - 1].value);
  }
  return text;
}

}  // namespace ramcdb::detail
