#include "cli/chart_list.h"

namespace ramcdb::cli {

std::string chart_list(const std::vector<ChartId>& charts) {
  std::string text;
  for (std::size_t begin = 0; begin < charts.size();) {
    std::size_t last = begin;
    while (last + 1 < charts.size() && charts[last + 1].value == charts[last].value + 1) ++last;
    if (!text.empty()) text += ',';
    text += std::to_string(charts[begin].value);
    if (last > begin) text.append(last == begin + 1 ? "," : "-").append(std::to_string(charts[last].value));
    begin = last + 1;
  }
  return text;
}

}  // namespace ramcdb::cli
