#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "ramcdb/geometry.h"
#include "ramcdb/ids.h"

namespace ramcdb {

/// The charts whose exact bounding box meets the closed box lo..hi (model units).
struct InBox {
  Point lo, hi;
};

/// The charts whose exact bounding box meets the closed ball.
struct InSphere {
  Point center;
  double radius = 0;
};

/// The charts whose exact bounding box is not wholly outside one of the six clip planes of a row-major clip matrix
/// (OpenGL convention: a point is inside when -w <= x, y, z <= w).
struct InFrustum {
  std::array<double, 16> clip{};
};

/// The one chart with the vertex closest to a point (ties: smallest id).
struct NearestTo {
  Point point;
};

struct OfCharts {
  std::vector<ChartId> charts;
};

struct WholeMesh {};

using RegionShape = std::variant<InBox, InSphere, InFrustum, NearestTo, OfCharts, WholeMesh>;

/// A region: whole charts, those that any of the shapes names, then `grow` rings of charts that share a wire or a
/// corner with them.
struct Region {
  std::vector<RegionShape> shapes;
  unsigned grow = 0;
};

/// Parsers of the command line's region texts: `X0,Y0,Z0,X1,Y1,Z1`, `X,Y,Z,R`, `X,Y,Z`, 16 numbers, `5,9-12`.
/// Without locale. Throw invalid_argument showing the form that is expected.
[[nodiscard]] InBox parse_box(std::string_view text);
[[nodiscard]] InSphere parse_sphere(std::string_view text);
[[nodiscard]] NearestTo parse_nearest(std::string_view text);
[[nodiscard]] InFrustum parse_frustum(std::string_view text);
[[nodiscard]] OfCharts parse_charts(std::string_view text);

}  // namespace ramcdb
