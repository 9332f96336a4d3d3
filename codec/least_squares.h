#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace ramcdb::codec {

/// A linear least-squares problem of few unknowns, x = argmin sum w (value - regressors . x)^2, gathered sample by
/// sample. Plain loops, so that every machine gets the same numbers.
template <std::size_t N>
class LeastSquares {
 public:
  using Vector = std::array<double, N>;

  void add(const Vector& regressors, double value, double weight) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j <= i; ++j) normal_[i][j] += weight * regressors[i] * regressors[j];
      right_[i] += weight * regressors[i] * value;
    }
  }

  /// The solution that also stays near `x0`, as if `strength` times the mean of the samples' weight spoke for it.
  /// Cholesky's decomposition; `x0` itself when the samples do not determine a solution.
  [[nodiscard]] Vector solve(const Vector& x0, double strength) const {
    std::array<Vector, N> l{};
    double trace = 0;
    for (std::size_t i = 0; i < N; ++i) trace += normal_[i][i];
    const double pull = strength * trace / N;
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = normal_[i][j] + (i == j ? pull : 0);
        for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
        if (i == j) {
          if (!(sum > pull * 1e-9)) return x0;
          l[i][i] = std::sqrt(sum);
        } else {
          l[i][j] = sum / l[j][j];
        }
      }
    Vector x{};
    for (std::size_t i = 0; i < N; ++i) {
      x[i] = right_[i] + pull * x0[i];
      for (std::size_t k = 0; k < i; ++k) x[i] -= l[i][k] * x[k];
      x[i] /= l[i][i];
    }
    for (std::size_t i = N; i-- > 0;) {
      for (std::size_t k = i + 1; k < N; ++k) x[i] -= l[k][i] * x[k];
      x[i] /= l[i][i];
    }
    return x;
  }

 private:
  std::array<Vector, N> normal_{};  ///< lower half
  Vector right_{};
};

}  // namespace ramcdb::codec
