#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "api/mesh_file/file_bytes.h"

/// What is checked of a JSON text before a parser takes memory for it.
namespace ramcdb::mesh_file::gltf {

inline constexpr std::size_t kDeepestJson = 128, kMostJsonValues = 1 << 24;

/// Throws invalid_argument where the text nests deeper than kDeepestJson, and limit_exceeded where it has more than
/// kMostJsonValues values: a parser takes some tens of bytes for each, whatever its length. `offset` is where the text
/// begins in the file.
void check_json_size(const FileBytes& file, std::string_view json, std::size_t offset);

}  // namespace ramcdb::mesh_file::gltf
