#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "ramcdb/attributes.h"

/// Names of attributes, and the numbers that their types hold.
namespace ramcdb::mesh_file {

inline constexpr std::size_t kMostComponents = 16;
/// The number of a value that there is none of.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] inline std::size_t size_of(NumberType type) {
  constexpr std::size_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

/// The numbers of a type. NaN is in every range: it says that there is no value.
struct NumberRange {
  static constexpr double kMostFloat = std::numeric_limits<float>::max();
  double least = 0, most = 0;
  NumberType type = NumberType::float64;

  [[nodiscard]] bool holds(double value) const {
    if (value != value || type == NumberType::float64) return true;
    if (type == NumberType::float32) {
      const bool finite = value - value == 0;
      const bool fits = value >= -kMostFloat && value <= kMostFloat;
      return finite ? fits && static_cast<double>(static_cast<float>(value)) == value : true;
    }
    return value >= least && value <= most && static_cast<double>(static_cast<std::int64_t>(value)) == value;
  }
};

[[nodiscard]] NumberRange range_of(NumberType type);

/// The names that the components of an attribute have in a PLY file when none are given.
[[nodiscard]] std::vector<std::string> customary_fields(const AttributeInfo& info);

/// The name if no attribute has it; else with "face." or "corner." before it; else with a number behind it.
[[nodiscard]] std::string unique_name(const std::vector<Attribute>& attributes, AttributeOf of, std::string_view name);

}  // namespace ramcdb::mesh_file
