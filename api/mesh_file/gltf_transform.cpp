#include "api/mesh_file/gltf_transform.h"

#include <algorithm>
#include <cmath>

namespace ramcdb::mesh_file::gltf {
namespace {

constexpr std::size_t at(std::size_t row, std::size_t column) { return 4 * column + row; }

bool has_identity_axes(const Matrix& m) {
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < 3; ++r)
      if (m[at(r, c)] != (r == c ? 1 : 0)) return false;
  return true;
}

}  // namespace

Matrix identity() { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }

Matrix compose(const std::optional<std::array<double, 3>>& translation,
               const std::optional<std::array<double, 4>>& rotation,
               const std::optional<std::array<double, 3>>& scale) {
  Matrix m = identity();
  if (rotation) {
    const auto [x, y, z, w] = *rotation;
    const double axes[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w),     2 * (x * z - y * w),
                            2 * (x * y - z * w),     1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
                            2 * (x * z + y * w),     2 * (y * z - x * w),     1 - 2 * (x * x + y * y)};
    for (std::size_t i = 0; i < 9; ++i) m[at(i % 3, i / 3)] = axes[i];
  }
  for (std::size_t i = 0; scale && i < 9; ++i) m[at(i % 3, i / 3)] *= (*scale)[i / 3];
  for (std::size_t r = 0; translation && r < 3; ++r) m[at(r, 3)] = (*translation)[r];
  return m;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
  if (a == identity()) return b;
  if (b == identity()) return a;
  Matrix product{};
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t k = 0; k < 4; ++k) product[at(r, c)] += a[at(r, k)] * b[at(k, c)];
  return product;
}

Transform::Transform(const Matrix& matrix) : m_(matrix), linear_is_identity_(has_identity_axes(matrix)) {
  moves_ = matrix[at(0, 3)] != 0 || matrix[at(1, 3)] != 0 || matrix[at(2, 3)] != 0;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      cofactors_[at(r, c)] = m_[at(r1, c1)] * m_[at(r2, c2)] - m_[at(r1, c2)] * m_[at(r2, c1)];
    }
  determinant_ = m_[0] * cofactors_[0] + m_[1] * cofactors_[1] + m_[2] * cofactors_[2];
}

Point Transform::point(const Point& p) const {
  Point moved = linear_is_identity_ ? p : direction(p);
  for (std::size_t r = 0; r < 3; ++r)
    if (m_[at(r, 3)] != 0) moved[static_cast<int>(r)] += m_[at(r, 3)];  // -0 stays
  return moved;
}

Point Transform::direction(const Point& d) const {
  Point q;
  for (std::size_t r = 0; r < 3; ++r)
    q[static_cast<int>(r)] = m_[at(r, 0)] * d.x + m_[at(r, 1)] * d.y + m_[at(r, 2)] * d.z;
  return q;
}

Point Transform::normal(const Point& n) const {
  // The inverse's transpose, up to its length, which is gone after `unit`.
  const double sign = mirrors() ? -1 : 1;
  Point q;
  for (std::size_t r = 0; r < 3; ++r)
    q[static_cast<int>(r)] =
        sign * (cofactors_[at(r, 0)] * n.x + cofactors_[at(r, 1)] * n.y + cofactors_[at(r, 2)] * n.z);
  return unit(q);
}

Point unit(const Point& d) {
  // Divided first, so that no square is too large or too small for a double.
  const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return {0, 0, 0};
  const Point s{d.x / largest, d.y / largest, d.z / largest};
  const double length = std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
  return {s.x / length, s.y / length, s.z / length};
}

}  // namespace ramcdb::mesh_file::gltf
