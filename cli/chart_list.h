#pragma once

#include <string>
#include <vector>

#include "ramcdb/ids.h"

namespace ramcdb::cli {

/// Charts in the form that `--charts` takes: "5,9-12". REQUIRES: ascending. No charts give an empty text.
[[nodiscard]] std::string chart_list(const std::vector<ChartId>& charts);

}  // namespace ramcdb::cli
