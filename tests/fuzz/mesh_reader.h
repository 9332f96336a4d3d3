#pragma once

#include <string_view>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "tests/api/mesh_file/bad_files.h"
#include "tests/fuzz/target.h"

/// What the targets of all mesh files do.
namespace ramcdb::fuzz {

/// Reads the bytes. A mesh that is read must be sound, must be cut into triangles, and must come back from a file that
/// is written of it; else there must be an Error.
void read_and_check(std::string_view bytes, mesh_file::Format format);

/// The whole files of this extension, and these.
[[nodiscard]] std::vector<Seed> mesh_seeds(std::string_view extension, const std::vector<test::BadFile>& files);

}  // namespace ramcdb::fuzz
