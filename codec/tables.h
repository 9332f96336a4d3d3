#pragma once

#include "ramcdb/bytes.h"

namespace ramcdb::codec {

/// Coder tables of one mesh: predictor weights that the dense chart coder starts from. They are trained once, at
/// import, stored as a blob of their own, and named by every chart that was coded with them.
struct CoderTables;

}  // namespace ramcdb::codec
