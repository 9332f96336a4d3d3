#pragma once

#include <algorithm>
#include <limits>
#include <string_view>

namespace ramcdb::mesh_file {

/// Whether the float32 nearest to a number written in text is that number to the last digit given: so it is for what
/// was printed from a float32 with up to twelve digits or at least seventeen. It is not for a double that is no float32
/// printed with seventeen digits, and for few with seven to twelve.
/// `value` is the finite double nearest to `text`.
[[nodiscard]] bool float_holds(std::string_view text, double value);

/// The float32 nearest to `value`, of which float_holds was true.
[[nodiscard]] inline double nearest_float(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<double>(static_cast<float>(std::clamp(value, -kLargest, kLargest)));
}

}  // namespace ramcdb::mesh_file
