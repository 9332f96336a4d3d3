#include "tools/generated_shapes.h"

#include <algorithm>
#include <cmath>

#include "tests/support/meshes.h"

namespace ramcdb::tools {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// 0..1, of a number.
double share(std::uint64_t number) {
  return static_cast<double>(mixed(number) >> 11) / static_cast<double>(1ULL << 53);
}

std::uint64_t side_of(double area) { return static_cast<std::uint64_t>(std::max(2.0, std::sqrt(area) + 0.5)); }

/// Rings between two poles, moved along their radius.
class Planet : public Shape {
 public:
  explicit Planet(std::uint64_t faces) : around_(std::max<std::uint64_t>(4, side_of(static_cast<double>(faces)))) {
    rings_ = std::max<std::uint64_t>(2, faces / (2 * around_));
  }
  std::uint64_t vertices() const override { return around_ * rings_ + 2; }
  std::uint64_t faces() const override { return 2 * around_ * rings_; }

  Point vertex(std::uint64_t number) const override {
    if (number >= around_ * rings_) return displaced({0, 0, number == around_ * rings_ ? 1.0 : -1.0});
    const double polar = kPi * static_cast<double>(number / around_ + 1) / static_cast<double>(rings_ + 1);
    const double turn = 2 * kPi * static_cast<double>(number % around_) / static_cast<double>(around_);
    return displaced({std::sin(polar) * std::cos(turn), -std::sin(polar) * std::sin(turn), std::cos(polar)});
  }

  Face face(std::uint64_t number) const override {
    const std::uint64_t u = number / 2 % around_, next = (u + 1) % around_, ring = number / 2 / around_;
    const std::uint64_t top = around_ * rings_, last = top - around_;
    if (ring + 1 == rings_) return number % 2 == 0 ? Face{next, u, top} : Face{last + u, last + next, top + 1};
    const std::uint64_t a = ring * around_ + u, b = ring * around_ + next;
    return number % 2 == 0 ? Face{a, b, b + around_} : Face{a, b + around_, a + around_};
  }

 private:
  static Point displaced(const Point& p) {
    const double r = 1 + 0.2 * test::fractal({3 * p.x + 7, 3 * p.y + 5, 3 * p.z + 3}, 7);
    return {r * p.x, r * p.y, r * p.z};
  }
  std::uint64_t around_, rings_ = 2;
};

/// An open grid of square tiles, one behind the other in the file as surveys deliver them, that share their borders.
class Tiles : public Shape {
 public:
  explicit Tiles(std::uint64_t faces) : side_(side_of(static_cast<double>(faces) / (2.0 * kTile * kTile))) {}
  std::uint64_t vertices() const override { return (side_ * kTile + 1) * (side_ * kTile + 1); }
  std::uint64_t faces() const override { return 2 * side_ * side_ * kTile * kTile; }

  Point vertex(std::uint64_t number) const override {
    const std::uint64_t row = side_ * kTile + 1;
    const double x = static_cast<double>(number % row), y = static_cast<double>(number / row);
    return {x, y, 60 * test::fractal({x / 200, y / 200, 0.5}, 7)};
  }

  Face face(std::uint64_t number) const override {
    constexpr std::uint64_t kCells = kTile * kTile;
    const std::uint64_t tile = number / 2 / kCells, cell = number / 2 % kCells, row = side_ * kTile + 1;
    const std::uint64_t x = tile % side_ * kTile + cell % kTile, y = tile / side_ * kTile + cell / kTile;
    const std::uint64_t a = y * row + x, b = a + row;
    return number % 2 == 0 ? Face{a, a + 1, b + 1} : Face{a, b + 1, b};
  }

 private:
  static constexpr std::uint64_t kTile = 64;
  std::uint64_t side_;
};

/// Boxes of 12 faces on a grid of streets.
class City : public Shape {
 public:
  explicit City(std::uint64_t faces) : boxes_(std::max<std::uint64_t>(1, faces / 12)) {
    row_ = side_of(static_cast<double>(boxes_));
  }
  std::uint64_t vertices() const override { return 8 * boxes_; }
  std::uint64_t faces() const override { return 12 * boxes_; }

  Point vertex(std::uint64_t number) const override {
    const std::uint64_t box = number / 8, c = number % 8;
    const Point size{4 + 8 * share(3 * box), 4 + 8 * share(3 * box + 1), 3 + 30 * share(3 * box + 2)};
    const double x = 16 * static_cast<double>(box % row_), y = 16 * static_cast<double>(box / row_);
    return {x + (c & 1 ? size.x : 0), y + (c & 2 ? size.y : 0), c & 4 ? size.z : 0};
  }

  Face face(std::uint64_t number) const override {
    static constexpr std::uint64_t kBox[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    const auto& corners = kBox[number % 12];
    const std::uint64_t first = number / 12 * 8;
    return {first + corners[0], first + corners[1], first + corners[2]};
  }

 private:
  std::uint64_t boxes_, row_ = 1;
};

/// A rough torus with a hollow wall, which holes run through: an outer and an inner sheet, joined around each hole.
class Statue : public Shape {
 public:
  explicit Statue(std::uint64_t faces) {
    const double tiles = static_cast<double>(faces) / kFaces;
    around_ = side_of(tiles / 3);
    along_ = std::max<std::uint64_t>(3, static_cast<std::uint64_t>(tiles / static_cast<double>(around_)));
    around_ = std::max<std::uint64_t>(3, around_);
    for (std::uint64_t i = 0, n = 0; i < kTile * kTile; ++i) {
      const auto inside = [](std::uint64_t x) { return x > kHole && x < kHole + kWide; };
      place_.push_back(inside(i % kTile) && inside(i / kTile) ? 0 : n++);
      if (place_.back() == 0 && i > 0) continue;
      cell_.push_back(i);
    }
    for (std::uint64_t i = 0; i < kTile * kTile; ++i)
      if (!is_hole(i % kTile, i / kTile)) cells_.push_back(i);
  }
  std::uint64_t vertices() const override { return 2 * around_ * along_ * kVertices; }
  std::uint64_t faces() const override { return around_ * along_ * kFaces; }

  Point vertex(std::uint64_t number) const override {
    const std::uint64_t sheet = number % 2, tile = number / 2 / kVertices, cell = cell_[number / 2 % kVertices];
    const double u = static_cast<double>(tile % around_ * kTile + cell % kTile) / static_cast<double>(around_ * kTile);
    const double v = static_cast<double>(tile / around_ * kTile + cell / kTile) / static_cast<double>(along_ * kTile);
    const double a = 2 * kPi * u, b = 2 * kPi * v;
    const double x = std::cos(a), y = std::sin(a);
    const double rough =
        0.06 * test::fractal({4 * (3 + x) * std::cos(b) + 50, 4 * (3 + x) * std::sin(b) + 50, 4 * y + 50}, 6);
    const double r = (sheet == 0 ? 1.0 : 0.8) + rough;
    return {(3 + r * x) * std::cos(b), (3 + r * x) * std::sin(b), r * y};
  }

  Face face(std::uint64_t number) const override {
    const std::uint64_t tile = number / kFaces, at = number % kFaces, half = at % 2;
    if (at >= 4 * kCells) return wall(tile, (at - 4 * kCells) / 2, half);
    const std::uint64_t sheet = at / (2 * kCells), cell = cells_[at / 2 % kCells];
    const std::uint64_t x = cell % kTile, y = cell / kTile;
    return quad(
        {id(tile, x, y, sheet), id(tile, x + 1, y, sheet), id(tile, x + 1, y + 1, sheet), id(tile, x, y + 1, sheet)},
        half, sheet == 0);
  }

 private:
  static constexpr std::uint64_t kTile = 24, kHole = 8, kWide = 8;
  static constexpr std::uint64_t kVertices = kTile * kTile - (kWide - 1) * (kWide - 1);  ///< of a sheet, per tile
  static constexpr std::uint64_t kCells = kTile * kTile - kWide * kWide;
  static constexpr std::uint64_t kFaces = 4 * kCells + 8 * kWide;

  static bool is_hole(std::uint64_t x, std::uint64_t y) {
    return x >= kHole && x < kHole + kWide && y >= kHole && y < kHole + kWide;
  }

  /// Vertices at the far sides of a tile are the next tile's.
  [[nodiscard]] std::uint64_t id(std::uint64_t tile, std::uint64_t x, std::uint64_t y, std::uint64_t sheet) const {
    std::uint64_t u = tile % around_, v = tile / around_;
    if (x == kTile) u = (u + 1) % around_;
    if (y == kTile) v = (v + 1) % along_;
    return 2 * ((v * around_ + u) * kVertices + place_[y % kTile * kTile + x % kTile]) + sheet;
  }

  static Face quad(const std::array<std::uint64_t, 4>& v, std::uint64_t half, bool as_is) {
    Face face = half == 0 ? Face{v[0], v[1], v[2]} : Face{v[0], v[2], v[3]};
    if (!as_is) std::swap(face[1], face[2]);
    return face;
  }

  /// Step `at` of the way around a hole, the hole on the left.
  [[nodiscard]] Face wall(std::uint64_t tile, std::uint64_t at, std::uint64_t half) const {
    const auto corner = [](std::uint64_t step) {
      const std::uint64_t side = step / kWide % 4, on = step % kWide, end = kHole + kWide;
      if (side == 0) return std::pair(kHole + on, kHole);
      if (side == 1) return std::pair(end, kHole + on);
      if (side == 2) return std::pair(end - on, end);
      return std::pair(kHole, end - on);
    };
    const auto [x, y] = corner(at);
    const auto [p, q] = corner(at + 1);
    return quad({id(tile, x, y, 0), id(tile, p, q, 0), id(tile, p, q, 1), id(tile, x, y, 1)}, half, true);
  }

  std::uint64_t around_ = 3, along_ = 3;
  std::vector<std::uint64_t> place_, cell_, cells_;
};

template <class Kind>
std::unique_ptr<Shape> make(std::uint64_t faces) {
  return std::make_unique<Kind>(faces);
}

}  // namespace

const std::vector<ShapeKind>& shape_kinds() {
  static const std::vector<ShapeKind> kinds = {
      {"planet", "a sphere with mountains", make<Planet>},
      {"tiles", "an open terrain, tile by tile", make<Tiles>},
      {"city", "boxes of 12 faces", make<City>},
      {"statue", "a rough torus with a hollow wall and many holes through it", make<Statue>},
  };
  return kinds;
}

Shuffle::Shuffle(std::uint64_t size, std::uint64_t seed) : size_(size), seed_(seed) {
  while ((std::uint64_t{1} << (2 * half_bits_)) < size) ++half_bits_;
}

std::uint64_t Shuffle::round(int round, std::uint64_t half) const {
  const std::uint64_t mask = (std::uint64_t{1} << half_bits_) - 1;
  return mixed(half + seed_ * 0x9e3779b97f4a7c15 + static_cast<std::uint64_t>(round) * 0xc2b2ae3d27d4eb4f) & mask;
}

std::uint64_t Shuffle::forwards(std::uint64_t x) const {
  std::uint64_t left = x >> half_bits_, right = x & ((std::uint64_t{1} << half_bits_) - 1);
  for (int r = 0; r < 4; ++r) {
    left ^= round(r, right);
    std::swap(left, right);
  }
  return left << half_bits_ | right;
}

std::uint64_t Shuffle::backwards(std::uint64_t x) const {
  std::uint64_t left = x >> half_bits_, right = x & ((std::uint64_t{1} << half_bits_) - 1);
  for (int r = 3; r >= 0; --r) {
    std::swap(left, right);
    left ^= round(r, right);
  }
  return left << half_bits_ | right;
}

std::uint64_t Shuffle::place_of(std::uint64_t number) const {
  do number = forwards(number);
  while (number >= size_);
  return number;
}

std::uint64_t Shuffle::number_at(std::uint64_t place) const {
  do place = backwards(place);
  while (place >= size_);
  return place;
}

}  // namespace ramcdb::tools
