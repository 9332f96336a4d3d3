#pragma once

#include <array>
#include <optional>

#include "api/mesh_file/gltf_document.h"
#include "ramcdb/geometry.h"

/// Affine maps of nodes, in double.
namespace ramcdb::mesh_file::gltf {

[[nodiscard]] Matrix identity();

/// Translation, rotation (quaternion x, y, z, w; taken as of length 1) and scale, as nodes have them.
[[nodiscard]] Matrix compose(const std::optional<std::array<double, 3>>& translation,
                             const std::optional<std::array<double, 4>>& rotation,
                             const std::optional<std::array<double, 3>>& scale);

/// First `b`, then `a`. Where one is the identity, exactly the other.
[[nodiscard]] Matrix operator*(const Matrix& a, const Matrix& b);

/// A map as vertices need it. What does not turn or scale does not round either: coordinates stay, or get one sum each.
class Transform {
 public:
  explicit Transform(const Matrix& matrix);

  [[nodiscard]] bool is_identity() const { return linear_is_identity_ && !moves_; }
  /// Nothing but a translation: directions stay as they are.
  [[nodiscard]] bool keeps_directions() const { return linear_is_identity_; }
  /// Turns the outside of faces inside, unless their corners are taken backwards.
  [[nodiscard]] bool mirrors() const { return determinant_ < 0; }

  [[nodiscard]] Point point(const Point& p) const;
  /// The direction along a surface, of the length that it has then.
  [[nodiscard]] Point direction(const Point& d) const;
  /// The normal of the mapped surface, of length 1; zero where there is none.
  [[nodiscard]] Point normal(const Point& n) const;

 private:
  Matrix m_;
  Matrix cofactors_{};
  double determinant_ = 1;
  bool linear_is_identity_ = false, moves_ = false;
};

/// Of length 1; zero where it has none.
[[nodiscard]] Point unit(const Point& d);

}  // namespace ramcdb::mesh_file::gltf
