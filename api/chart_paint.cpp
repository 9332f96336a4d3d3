#include "api/chart_paint.h"

#include <algorithm>
#include <cmath>

namespace ramcdb::detail {

using mesh_file::FaceColor;

namespace {

/// A colour on a wheel, for things that only need to differ from their neighbours.
FaceColor hue(double turn) {
  const auto channel = [&](double shift) {
    const double t = turn + shift - std::floor(turn + shift);
    const double wave = t < 0.5 ? 4 * t - 1 : 3 - 4 * t;  // triangle wave, -1..1
    return static_cast<std::uint8_t>(std::clamp(150 + 90 * wave, 0.0, 255.0));
  };
  return {channel(0.25), channel(0.25 + 1.0 / 3), channel(0.25 + 2.0 / 3)};
}

/// Blue for the least, over white, to red for the most.
FaceColor heat(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  const auto level = [](double v) { return static_cast<std::uint8_t>(40 + 215 * std::clamp(v, 0.0, 1.0)); };
  return {level(2 * s), level(1 - std::abs(2 * s - 1)), level(2 - 2 * s)};
}

std::vector<FaceColor> shades(const std::vector<double>& values) {
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  std::vector<FaceColor> colors;
  for (const double v : values) colors.push_back(heat(*hi > *lo ? (v - *lo) / (*hi - *lo) : 0.0));
  return colors;
}

}  // namespace

std::vector<FaceColor> chart_colors(const Snapshot& snapshot, const std::vector<ChartId>& charts, Paint paint) {
  std::vector<FaceColor> colors;
  if (paint == Paint::chart) {
    // Steps of the golden angle keep the colours of successive ids far apart.
    for (const ChartId id : charts) colors.push_back(hue(static_cast<double>(id.value) * 0.61803398874989485));
    return colors;
  }
  std::vector<double> values;
  for (const ChartSummary& c : snapshot.describe(charts)) {
    const double vertices = std::max(1U, c.inner_vertices + c.border_vertices / 2);
    values.push_back(paint == Paint::bits ? 8.0 * static_cast<double>(c.bytes) / vertices : c.version.value);
  }
  return shades(values);
}

}  // namespace ramcdb::detail
