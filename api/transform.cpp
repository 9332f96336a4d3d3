#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "api/repository_impl.h"
#include "api/same_values.h"
#include "api/snapshot_impl.h"
#include "api/streamed_edit.h"
#include "ramcdb/built_in_edits.h"

namespace ramcdb {
namespace {

using detail::VertexMove;

double distance_to(const InBox& box, const Point& p) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max({box.lo[a] - p[a], 0.0, p[a] - box.hi[a]});
    sum += d * d;
  }
  return std::sqrt(sum);
}

double distance_to(const RegionShape& shape, const Point& p) {
  if (const auto* box = std::get_if<InBox>(&shape)) return distance_to(*box, p);
  if (const auto* ball = std::get_if<InSphere>(&shape))
    return std::max(distance_to(InBox{ball->center, ball->center}, p) - ball->radius, 0.0);
  if (const auto* point = std::get_if<NearestTo>(&shape)) return distance_to(InBox{point->point, point->point}, p);
  return 0;  // the whole mesh
}

/// The point that distances from a shape are measured along: of a ball its center.
Point nearest_point(const RegionShape& shape, const Point& p) {
  if (const auto* ball = std::get_if<InSphere>(&shape)) return ball->center;
  if (const auto* point = std::get_if<NearestTo>(&shape)) return point->point;
  Point nearest = p;
  if (const auto* box = std::get_if<InBox>(&shape))
    for (int a = 0; a < 3; ++a) nearest[a] = std::clamp(p[a], box->lo[a], std::max(box->lo[a], box->hi[a]));
  return nearest;
}

/// The shape with all that is less than `by` away from it.
RegionShape widened(const RegionShape& shape, double by) {
  if (const auto* box = std::get_if<InBox>(&shape)) {
    InBox wide = *box;
    for (int a = 0; a < 3; ++a) {
      wide.lo[a] -= by;
      wide.hi[a] += by;
    }
    return wide;
  }
  if (const auto* ball = std::get_if<InSphere>(&shape)) return InSphere{ball->center, ball->radius + by};
  if (const auto* point = std::get_if<NearestTo>(&shape)) return InSphere{point->point, by};
  if (std::holds_alternative<WholeMesh>(shape)) return shape;
  throw Error(Errc::invalid_argument, "a falloff needs a shape to be measured from", {},
              "give the region as boxes, spheres or points");
}

/// How far vertices go along: 1 within the shapes, 0 from `falloff` on, smooth at both ends.
class Falloff {
 public:
  Falloff(const Region& region, double falloff) : shapes_(region.shapes), falloff_(falloff) {}

  [[nodiscard]] double weight(const Point& p) const {
    const double x = share_left(p);
    return x * x * (3 - 2 * x);
  }

  /// How the weight grows along the axes.
  [[nodiscard]] Point gradient(const Point& p) const {
    const double x = share_left(p);
    const double slope = -6 * x * (1 - x) / falloff_;
    const RegionShape& shape =
        *std::ranges::min_element(shapes_, {}, [&](const RegionShape& candidate) { return distance_to(candidate, p); });
    const Point from = nearest_point(shape, p);
    const double distance = distance_to(InBox{from, from}, p);
    if (slope == 0 || distance == 0) return {};
    return {slope * (p.x - from.x) / distance, slope * (p.y - from.y) / distance, slope * (p.z - from.z) / distance};
  }

 private:
  /// 1 within the shapes, 0 from `falloff` on.
  [[nodiscard]] double share_left(const Point& p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const RegionShape& shape : shapes_) nearest = std::min(nearest, distance_to(shape, p));
    return nearest >= falloff_ ? 0 : 1 - nearest / falloff_;
  }

  const std::vector<RegionShape>& shapes_;
  double falloff_;
};

/// The vertices of some charts, those on their borders included.
class VerticesOf {
 public:
  VerticesOf(const Snapshot::Impl& at, const std::vector<ChartId>& charts) : charts_(charts) {
    for (const ChartId id : charts) {
      const auto ref = at.pages().leaf_of(id);
      for (const WireLoop& loop : detail::find_chart(*ref->leaf, id)->loops)
        for (const DirectedWire step : loop) {
          const PageWire& wire = *detail::find_wire(*ref->leaf, step.wire);
          wires_.insert(wire.id);
          corners_.insert({wire.begin, wire.end});
        }
    }
  }

  [[nodiscard]] bool contains(const VertexKey& key) const {
    if (key.where == VertexKey::Where::wire) return wires_.contains(WireId(key.id));
    if (key.where == VertexKey::Where::corner) return corners_.contains(CornerId(key.id));
    return std::ranges::binary_search(charts_, ChartId(key.id));
  }

 private:
  const std::vector<ChartId>& charts_;
  std::unordered_set<WireId> wires_;
  std::unordered_set<CornerId> corners_;
};

Point mapped(const Matrix& m, const Point& p) {
  Point q;
  for (int row = 0; row < 3; ++row) {
    const auto at = static_cast<std::size_t>(4 * row);
    q[row] = m[at] * p.x + m[at + 1] * p.y + m[at + 2] * p.z + m[at + 3];
  }
  return q;
}

/// The move of a vertex to `target`; none where the mesh keeps it as it is.
std::optional<VertexMove> move_to(const detail::MeshRecord& record, const VertexKey& key, LatticePoint from,
                                  const Point& position, const Point& target) {
  VertexMove move{key, from, from, position, record.rounded(target)};
  move.to = record.lattice.snap(move.target);
  if (!record.exact) {
    if (move.to == from) return std::nullopt;
    move.target = record.lattice.position(move.to);
    return move;
  }
  if (!detail::same_bits(move.target, position)) return move;
  return std::nullopt;
}

void require_transform(const TransformOptions& options) {
  const Matrix& m = options.matrix;
  if (!std::ranges::all_of(m, [](double x) { return std::isfinite(x); }))
    throw Error(Errc::invalid_argument, "the matrix holds a number that is not finite");
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    throw Error(Errc::invalid_argument, "the matrix is not affine", "last row",
                "give it by rows, with 0,0,0,1 as the last");
  if (!(options.falloff >= 0 && std::isfinite(options.falloff)))
    throw Error(Errc::invalid_argument, fmt::format("a falloff of {} cannot be", options.falloff), {},
                "give a distance in model units");
}

/// All vertices of the region by the same map; charts around follow with what they share.
detail::Mover rigid_mover(const Snapshot::Impl& at, const std::vector<ChartId>& charts, const Matrix& matrix) {
  return [&at, matrix, inside = std::make_shared<VerticesOf>(at, charts)](
             const VertexKey& key, LatticePoint from, const Point& position) -> std::optional<VertexMove> {
    if (!inside->contains(key)) return std::nullopt;
    return move_to(at.record(), key, from, position, mapped(matrix, position));
  };
}

detail::Mover fading_mover(const Snapshot::Impl& at, const Region& region, const TransformOptions& options) {
  return [&at, matrix = options.matrix, falloff = Falloff(region, options.falloff)](
             const VertexKey& key, LatticePoint from, const Point& position) -> std::optional<VertexMove> {
    const double weight = falloff.weight(position);
    if (weight == 0) return std::nullopt;
    Point target = mapped(matrix, position);
    for (int a = 0; weight < 1 && a < 3; ++a) target[a] = position[a] + weight * (target[a] - position[a]);
    return move_to(at.record(), key, from, position, target);
  };
}

detail::Derivative linear_part(const Matrix& m) { return {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}; }

/// None where normals stay: for translations.
detail::NormalTurner rigid_turner(const Snapshot::Impl& at, const std::vector<ChartId>& charts, const Matrix& matrix) {
  if (linear_part(matrix) == linear_part(translation({}))) return {};
  return [map = detail::normal_map(linear_part(matrix)), inside = std::make_shared<VerticesOf>(at, charts)](
             const VertexKey& key, const Point&) -> std::optional<detail::Derivative> {
    if (!inside->contains(key)) return std::nullopt;
    return map;
  };
}

/// The derivative of p + weight(p) * (m * p - p).
detail::NormalTurner fading_turner(const Region& region, const TransformOptions& options) {
  return [matrix = options.matrix, falloff = Falloff(region, options.falloff)](
             const VertexKey&, const Point& position) -> std::optional<detail::Derivative> {
    const double weight = falloff.weight(position);
    if (weight == 0) return std::nullopt;
    const Point target = mapped(matrix, position), gradient = falloff.gradient(position);
    detail::Derivative derivative = linear_part(matrix);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) {
        const double unit = row == column;
        double& x = derivative[static_cast<std::size_t>(3 * row + column)];
        x = unit + weight * (x - unit) + (target[row] - position[row]) * gradient[column];
      }
    return detail::normal_map(derivative);
  };
}

}  // namespace

Matrix translation(const Point& by) { return {1, 0, 0, by.x, 0, 1, 0, by.y, 0, 0, 1, by.z, 0, 0, 0, 1}; }

Matrix scaling(const Point& by, const Point& center) {
  Matrix m{by.x, 0, 0, 0, 0, by.y, 0, 0, 0, 0, by.z, 0, 0, 0, 0, 1};
  for (int a = 0; a < 3; ++a) m[static_cast<std::size_t>(4 * a + 3)] = center[a] - by[a] * center[a];
  return m;
}

Matrix rotation(const Point& axis, double degrees, const Point& center) {
  const double length = std::sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
  if (!(length > 0 && std::isfinite(length)))
    throw Error(Errc::invalid_argument, "the axis of a rotation has no direction", {}, "give X,Y,Z not all 0");
  const double x = axis.x / length, y = axis.y / length, z = axis.z / length;
  const double radians = degrees / 180 * 3.14159265358979323846;
  const double c = std::cos(radians), s = std::sin(radians), k = 1 - c;
  Matrix m{c + k * x * x,
           k * x * y - s * z,
           k * x * z + s * y,
           0,
           k * x * y + s * z,
           c + k * y * y,
           k * y * z - s * x,
           0,
           k * x * z - s * y,
           k * y * z + s * x,
           c + k * z * z,
           0,
           0,
           0,
           0,
           1};
  const Point moved = mapped(m, center);
  for (int a = 0; a < 3; ++a) m[static_cast<std::size_t>(4 * a + 3)] = center[a] - moved[a];
  return m;
}

CommitReport Repository::transform(std::string_view mesh, const Region& region, const TransformOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  require_transform(options);
  (void)impl_->store_for_writing();
  detail::sweep_scratch(folder());
  const Snapshot base = snapshot(mesh, options.commit.branch);
  Region wide = region;
  if (options.falloff > 0)
    for (RegionShape& shape : wide.shapes) shape = widened(shape, options.falloff);
  const std::vector<ChartId> charts = base.find(wide);
  detail::StreamedMoves moves{.region = charts,
                              .border_moves = options.falloff == 0,
                              .mover = {},
                              .turner = {},
                              .memory = options.memory,
                              .scratch_folder = folder()};
  moves.mover = options.falloff > 0 ? fading_mover(base.impl(), region, options)
                                    : rigid_mover(base.impl(), moves.region, options.matrix);
  moves.turner =
      options.falloff > 0 ? fading_turner(region, options) : rigid_turner(base.impl(), moves.region, options.matrix);
  moves.normals_still_fit = !moves.turner;
  CommitReport report = detail::commit_streamed(base.impl(), moves, options.commit, "transform");
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb
