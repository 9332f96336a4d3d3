#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "chartify/chartify.h"

namespace draco {
class Mesh;
}

namespace ramcdb::benchmark {

/// A whole mesh for Google's Draco, given the very lattice points as integers, so that both code the same numbers.
class DracoMesh {
 public:
  explicit DracoMesh(const chartify::IndexedMesh& mesh);
  ~DracoMesh();

  /// `level` is Draco's compression level: 10 packs best, 7 is its tools' default.
  [[nodiscard]] std::vector<char> encode(int level) const;

 private:
  std::unique_ptr<draco::Mesh> mesh_;
};

/// Decodes to the end and returns the number of faces.
std::size_t draco_decode(const std::vector<char>& bytes);

}  // namespace ramcdb::benchmark
