#pragma once

#include <string>
#include <vector>

/// One small, whole file of every kind that is read.
namespace ramcdb::test {

struct Sample {
  std::string name;  ///< the extension is the format
  std::string bytes;
  std::size_t vertices = 0, faces = 0;
  bool counted = true;  ///< whether the file announces its counts, so that a shorter one is known to be cut off
};

/// A PLY of four vertices and two faces with all kinds of attributes and ids, and an unknown element: 0 text, 1 little,
/// 2 big endian.
[[nodiscard]] std::string sample_ply(int encoding);

/// A binary OFF of four vertices, a triangle and a quad, as Geomview writes it or without colours or little-endian.
[[nodiscard]] std::string sample_off(bool big_endian, bool colors);

[[nodiscard]] std::vector<Sample> samples();

}  // namespace ramcdb::test
