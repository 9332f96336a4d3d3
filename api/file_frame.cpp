#include "api/file_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "api/region_mesh.h"

namespace ramcdb::detail {
namespace {

/// Finds points near a place: they are sorted by a projection that hardly any two share.
class NearPoints {
 public:
  explicit NearPoints(std::span<const Point> points) : points_(points) {
    sorted_.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) sorted_.emplace_back(projected(points[i]), i);
    std::sort(sorted_.begin(), sorted_.end());
  }
  /// Whether `accept` takes a point no further than this along each axis.
  template <class Accept>
  [[nodiscard]] bool any(const Point& p, double distance, Accept&& accept) const {
    const double reach = 3 * distance + 1e-12 * std::abs(projected(p)), middle = projected(p);
    for (auto it = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{middle - reach, 0U});
         it != sorted_.end() && it->first <= middle + reach; ++it)
      if (accept(points_[it->second])) return true;
    return false;
  }

 private:
  static double projected(const Point& p) { return p.x + 0.7548776662466927 * p.y + 0.5698402909980532 * p.z; }

  std::span<const Point> points_;
  std::vector<std::pair<double, std::uint32_t>> sorted_;
};

/// Up to `most` of the vertices of a region, evenly, relative to the local origin.
template <class Takes>
std::vector<Point> sample(const RegionMesh& region, const Lattice& lattice, const Point& origin, std::size_t most,
                          Takes&& takes) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t v = 0; v < region.points.size(); ++v)
    if (takes(v)) all.push_back(v);
  std::vector<Point> points;
  for (std::size_t i = 0; i < all.size(); i += all.size() / most + 1) {
    Point p = position_in(region, lattice, all[i]);
    for (int a = 0; a < 3; ++a) p[a] -= origin[a];
    points.push_back(p);
  }
  return points;
}

class FrameSearch {
 public:
  FrameSearch(std::span<const Point> positions, double tolerance) : near_(positions), tolerance_(tolerance) {}

  /// The share of the targets that the file has in a frame; 0 as soon as it must be below `least`.
  [[nodiscard]] double share(const FileFrame& frame, std::span<const Point> targets, double least) const {
    const Point step = frame.undo({tolerance_, 0, 0});
    const double reach = std::abs(step.x + step.y + step.z);  // two of them are 0
    const auto count = static_cast<double>(targets.size());
    double missed = 0;
    for (const Point& target : targets) {
      const bool hit = near_.any(frame.undo(target), reach, [&](const Point& p) {
        const Point q = frame.apply(p);
        const auto is_near = [&](int a) { return std::abs(q[a] - target[a]) <= tolerance_; };
        return is_near(0) && is_near(1) && is_near(2);
      });
      missed += hit ? 0 : 1;
      if (missed > count * (1 - least)) return 0;
    }
    return 1 - missed / count;
  }

 private:
  NearPoints near_;
  double tolerance_;
};

std::vector<FileFrame> all_frames() {
  constexpr std::array<std::array<int, 3>, 6> kAxes{{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  constexpr std::array<std::pair<double, double>, 13> kScales{{{1, 1},
                                                               {10, 1},
                                                               {100, 1},
                                                               {1000, 1},
                                                               {1, 10},
                                                               {1, 100},
                                                               {1, 1000},
                                                               {25.4, 1},
                                                               {1, 25.4},
                                                               {0.0254, 1},
                                                               {1, 0.0254},
                                                               {0.3048, 1},
                                                               {1, 0.3048}}};
  std::vector<FileFrame> frames;
  for (const auto& [numerator, denominator] : kScales)
    for (std::size_t i = 0; i < kAxes.size(); ++i)
      for (int signs = 0; signs < 8; ++signs) {
        const std::array<int, 3> sign{signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1};
        const int parity = i < 3 ? 1 : -1;  // the first three permutations are even
        if (sign[0] * sign[1] * sign[2] == parity) frames.emplace_back(kAxes[i], sign, numerator, denominator);
      }
  return frames;
}

}  // namespace

Point FileFrame::apply(const Point& p) const {
  Point q;
  for (std::size_t a = 0; a < 3; ++a) q[static_cast<int>(a)] = sign_[a] * p[axis_[a]] * numerator_ / denominator_;
  return q;
}

Point FileFrame::undo(const Point& p) const {
  Point q;
  for (std::size_t a = 0; a < 3; ++a) q[axis_[a]] = sign_[a] * p[static_cast<int>(a)] * denominator_ / numerator_;
  return q;
}

bool FileFrame::changes_nothing() const { return apply({1, 2, 3}) == Point{1, 2, 3}; }

std::string FileFrame::describe() const {
  std::string text = "axes x,y,z <- ";
  for (std::size_t a = 0; a < 3; ++a)
    text += fmt::format("{}{}{}", a ? "," : "", sign_[a] < 0 ? "-" : "", "xyz"[axis_[a]]);
  return text + fmt::format("; scale {:.6g}", numerator_ / denominator_);
}

std::optional<FileFrame> find_frame(const RegionMesh& region, const Lattice& lattice, const Point& local_origin,
                                    std::span<const Point> positions, double tolerance) {
  constexpr std::size_t kSample = 200, kLargeSample = 5000, kFew = 8;
  constexpr double kNearlyAll = 0.9, kHalf = 0.5;
  const std::vector<Point> targets =
      sample(region, lattice, local_origin, kSample, [&](std::uint32_t v) { return bool{region.outer_border[v]}; });
  const FrameSearch search(positions, std::max(tolerance, lattice.step / 2));
  const FileFrame as_it_stands({0, 1, 2}, {1, 1, 1}, 1, 1);
  if (targets.size() < kFew || search.share(as_it_stands, targets, kHalf) > 0) return std::nullopt;

  std::vector<FileFrame> found;
  for (const FileFrame& frame : all_frames())
    if (!frame.changes_nothing() && search.share(frame, targets, kNearlyAll) > 0) found.push_back(frame);
  if (found.size() == 1) return found.front();
  // A symmetric border fits in several ways, but its inside as a rule does not.
  const std::vector<Point> vertices =
      sample(region, lattice, local_origin, kLargeSample, [](std::uint32_t) { return true; });
  std::erase_if(found, [&](const FileFrame& frame) { return search.share(frame, vertices, kNearlyAll) == 0; });
  return found.size() == 1 ? std::optional(found.front()) : std::nullopt;
}

}  // namespace ramcdb::detail
