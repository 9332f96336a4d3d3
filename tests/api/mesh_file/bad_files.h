#pragma once

#include <string>
#include <vector>

#include "ramcdb/error.h"

/// Hand-made mesh files, nearly all of them broken in one way each: what a reader says to them, or reads nevertheless.
/// They are also what fuzzing begins with.
namespace ramcdb::test {

struct BadFile {
  std::string name;    ///< of letters, digits and dashes
  std::string bytes;   ///< the file
  std::string expect;  ///< a piece of the error's text, with the place; or "reads V F" and what is dropped: see below
  Errc code = Errc::invalid_argument;
};

/// `expect` of a file that is read: "reads 3 1" with the numbers of vertices and faces, then "; WHAT xN" for each thing
/// that is named as dropped, in their order.
[[nodiscard]] inline bool is_read(const BadFile& file) { return file.expect.starts_with("reads "); }

[[nodiscard]] std::vector<BadFile> bad_ply_files();
[[nodiscard]] std::vector<BadFile> bad_obj_files();
[[nodiscard]] std::vector<BadFile> bad_off_files();
[[nodiscard]] std::vector<BadFile> bad_stl_files();

}  // namespace ramcdb::test
