#pragma once

#include <filesystem>

namespace ramcdb::benchmark {

/// What a program does to a checked-out file of triangles (PLY): positions and ids are kept, nothing else, and the
/// border stays.
enum class FileEdit {
  move,    ///< every inner vertex
  remesh,  ///< one face in ten split in three; around one vertex in thirty faces deleted, the holes filled otherwise
};

void edit_file(const std::filesystem::path& file, FileEdit edit);

}  // namespace ramcdb::benchmark
