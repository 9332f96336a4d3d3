#include "api/point_file.h"

#include <algorithm>
#include <vector>

namespace ramcdb::detail {

void PointFile::add(std::span<const Point> points) {
  if (!wide_ && type_of(points) != NumberType::float32) widen();
  if (wide_)
    wide_->add(points);
  else
    for (const Point& p : points)
      narrow_->add({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
}

void PointFile::widen() {
  narrow_->flush();
  wide_.emplace(folder_);
  narrow_->for_each_piece([&](std::span<const Narrow> piece, std::uint64_t) {
    for (const Narrow& p : piece) wide_->add(Point{p[0], p[1], p[2]});
  });
  narrow_.reset();
}

void PointFile::finish() {
  if (wide_)
    wide_->flush();
  else
    narrow_->flush();
  view_.emplace(wide_ ? wide_->view() : narrow_->view());
}

PositionSource PointFile::source() const {
  return {size(), [this](const std::function<bool(std::span<const Point>)>& take) {
            constexpr std::uint64_t kSome = 1 << 14;
            std::vector<Point> some;
            for (std::uint64_t first = 0; first < size(); first += kSome) {
              some.clear();
              for (std::uint64_t i = first; i < std::min(first + kSome, size()); ++i) some.push_back(at(i));
              if (!take(some)) return;
            }
          }};
}

}  // namespace ramcdb::detail
