#include "api/border_snap.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "api/region_mesh.h"

namespace ramcdb::detail {
namespace {

/// Of the shortest decimal number that reads as this double.
int significant_digits(double number) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), std::abs(number), std::chars_format::scientific);
  int digits = 0;
  for (const char* c = text.data(); c != end.ptr && *c != 'e'; ++c) digits += *c != '.';
  return digits;
}

bool is_float32(double number) {
  return std::abs(number) <= double{std::numeric_limits<float>::max()} && double{static_cast<float>(number)} == number;
}

/// What a sample of numbers tells of the format that they were written in.
struct NumberFormat {
  int digits = 0;
  bool float32 = true;
  double largest = 0;

  explicit NumberFormat(std::span<const Point> points) {
    constexpr std::size_t kSample = 5000;
    const std::size_t stride = points.size() / kSample + 1;
    for (std::size_t i = 0; i < points.size(); ++i)
      for (int a = 0; a < 3; ++a) {
        largest = std::max(largest, std::abs(points[i][a]));
        if (i % stride) continue;
        digits = std::max(digits, significant_digits(points[i][a]));
        float32 = float32 && is_float32(points[i][a]);
      }
  }
};

}  // namespace

double float32_loss(double largest) {
  if (!(largest < double{std::numeric_limits<float>::max()})) return 0;
  const auto number = static_cast<float>(largest);
  return double{std::nextafter(number, std::numeric_limits<float>::infinity())} - double{number};
}

double decimal_loss(int digits, double largest) {
  double unit = 1;  // of the last digit; the number has as many digits as `unit` fits into it
  int whole = 0;
  for (; whole < 400 && unit <= largest; ++whole) unit *= 10;
  for (; whole > -400 && unit / 10 > largest; --whole) unit /= 10;
  for (; digits > 0; --digits) unit /= 10;
  return largest > 0 ? unit : 0;
}

double coordinate_loss(std::span<const Point> original, std::span<const Point> written) {
  constexpr int kDigitsOfFloat = 9, kDigitsOfDouble = 15;
  const NumberFormat before(original), after(written);
  double loss = 0;
  if (after.digits < before.digits && after.digits < kDigitsOfDouble) loss = decimal_loss(after.digits, after.largest);
  const bool from_floats = after.float32 || (after.digits <= kDigitsOfFloat && after.digits < before.digits);
  if (from_floats && !before.float32 && before.digits > 6) loss = std::max(loss, float32_loss(after.largest));
  return loss;
}

SnappedBack snap_back_border(const RegionMesh& region, const Lattice& lattice, const RegionMatch& match,
                             double tolerance, std::span<Point> positions, std::span<LatticePoint> points) {
  SnappedBack snapped;
  std::vector<bool> counted(region.points.size(), false);
  for (std::size_t w = 0; w < positions.size(); ++w) {
    const std::uint32_t v = match.vertices[match.vertex[w]].region;
    if (v == RegionMatch::kNone || !region.outer_border[v]) continue;
    const Point home = position_in(region, lattice, v);
    double distance = 0;
    for (int a = 0; a < 3; ++a) distance = std::max(distance, std::abs(positions[w][a] - home[a]));
    if (distance > tolerance) continue;
    const bool moved = points[w] != region.points[v] || (!region.exact.empty() && distance > 0);
    positions[w] = home;
    points[w] = region.points[v];
    if (!moved) continue;
    snapped.largest = std::max(snapped.largest, distance);
    snapped.vertices += !counted[v];
    counted[v] = true;
  }
  return snapped;
}

}  // namespace ramcdb::detail
