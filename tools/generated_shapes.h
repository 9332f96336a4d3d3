#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "ramcdb/geometry.h"

/// Meshes by formula: every vertex and every face by its number, so that meshes of any size take no memory.
namespace ramcdb::tools {

using Face = std::array<std::uint64_t, 3>;

class Shape {
 public:
  virtual ~Shape() = default;
  [[nodiscard]] virtual std::uint64_t vertices() const = 0;
  [[nodiscard]] virtual std::uint64_t faces() const = 0;
  [[nodiscard]] virtual Point vertex(std::uint64_t number) const = 0;
  [[nodiscard]] virtual Face face(std::uint64_t number) const = 0;
};

struct ShapeKind {
  std::string_view name, what;
  /// Of about so many faces.
  std::unique_ptr<Shape> (*make)(std::uint64_t faces);
};
[[nodiscard]] const std::vector<ShapeKind>& shape_kinds();

/// A permutation of 0 .. size - 1 that takes no memory: a Feistel network over the next larger power of four, walked
/// until it is inside.
class Shuffle {
 public:
  Shuffle(std::uint64_t size, std::uint64_t seed);
  [[nodiscard]] std::uint64_t place_of(std::uint64_t number) const;  ///< where a number goes
  [[nodiscard]] std::uint64_t number_at(std::uint64_t place) const;  ///< and the way back

 private:
  [[nodiscard]] std::uint64_t round(int round, std::uint64_t half) const;
  [[nodiscard]] std::uint64_t forwards(std::uint64_t x) const;
  [[nodiscard]] std::uint64_t backwards(std::uint64_t x) const;

  std::uint64_t size_, seed_;
  int half_bits_ = 1;
};

}  // namespace ramcdb::tools
