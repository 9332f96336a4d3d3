#pragma once

#include <span>
#include <string>

#include "ramcdb/ids.h"

namespace ramcdb::detail {

/// 1,2,3,7 as "1-3,7". REQUIRES: ascending.
[[nodiscard]] std::string chart_text(std::span<const ChartId> charts);

}  // namespace ramcdb::detail
