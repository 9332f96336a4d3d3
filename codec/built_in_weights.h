#pragma once

#include "codec/tables.h"

namespace ramcdb::codec {

inline constexpr std::array<FanWeights, kFanClasses> kBuiltInFanWeights = [] {
  std::array<FanWeights, kFanClasses> all{};
  for (FanWeights& weights : all) weights = {64, 64, 0, 0, 0, 0};
  return all;
}();
inline constexpr std::array<PlaneWeights, kPlaneClasses> kBuiltInPlaneWeights{};

}  // namespace ramcdb::codec
