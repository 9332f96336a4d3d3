#pragma once

#include <string>
#include <vector>

#include "ramcdb/figures.h"

namespace ramcdb::cli {

/// "color of vertices (3 x uchar), without loss".
[[nodiscard]] std::string attribute_text(const MeshInfo::Layer& layer);

/// A line for each thing that a file's format could not hold.
[[nodiscard]] std::string left_out_text(const std::vector<ImportReport::Dropped>& left_out);

/// "vertex", "corner" or "face".
[[nodiscard]] std::string name_of(AttributeOf of);
/// As PLY calls it.
[[nodiscard]] std::string name_of(NumberType type);
[[nodiscard]] std::string name_of(Meaning meaning);

}  // namespace ramcdb::cli
