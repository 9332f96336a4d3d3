#include "tests/codec/chart_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace ramcdb::codec::testing {

namespace {

std::int32_t rounded(double x) { return static_cast<std::int32_t>(std::lround(x)); }

/// Corners 3 f + c of the mesh, joined where faces of the region share an edge.
class Fans {
 public:
  explicit Fans(std::size_t corners) : parent_(corners) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t of(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

std::uint32_t next_corner(std::uint32_t c) { return c % 3 == 2 ? c - 2 : c + 1; }

}  // namespace

TestMesh torus(int around, int across, std::int32_t radius) {
  TestMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
      const double tube = radius * (0.35 + 0.05 * std::sin(5 * u) * std::cos(3 * v));
      mesh.points.push_back({rounded((radius * 0.6 + tube * std::cos(v)) * std::cos(u)),
                             rounded((radius * 0.6 + tube * std::cos(v)) * std::sin(u)), rounded(tube * std::sin(v))});
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TestMesh terrain(int side, std::int32_t spacing, std::uint32_t seed) {
  std::mt19937 random(seed);
  TestMesh mesh;
  const auto jitter = [&] { return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(spacing / 2 + 1)); };
  for (std::int32_t i = 0; i <= side; ++i)
    for (std::int32_t j = 0; j <= side; ++j)
      mesh.points.push_back({i * spacing + jitter(), j * spacing + jitter(), (i * i - 3 * j) * spacing / 9 + jitter()});
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (side + 1) + j); };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const int flip = static_cast<int>(random() % 2);
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1 - flip, j + 1)});
      mesh.faces.push_back({at(i + flip, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TestMesh sphere(int levels, std::int32_t radius) {
  struct P {
    double x, y, z;
  };
  std::vector<P> points{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  std::vector<Triangle> faces{{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
      if (fresh) points.push_back({points[a].x + points[b].x, points[a].y + points[b].y, points[a].z + points[b].z});
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : faces) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  TestMesh mesh;
  mesh.faces = std::move(faces);
  for (const P& p : points) {
    const double scale = radius / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    mesh.points.push_back({rounded(p.x * scale), rounded(p.y * scale), rounded(p.z * scale)});
  }
  return mesh;
}

Chart cut(const TestMesh& mesh, const std::vector<std::uint32_t>& faces) {
  const auto origin = [&](std::uint32_t corner) { return mesh.faces[faces[corner / 3]][corner % 3]; };
  const auto corners = static_cast<std::uint32_t>(3 * faces.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;
  for (std::uint32_t c = 0; c < corners; ++c) edges[{origin(c), origin(next_corner(c))}] = c;
  Fans fans(corners);
  std::vector<std::uint32_t> border;  // corners whose edge has no face of the region behind it
  for (std::uint32_t c = 0; c < corners; ++c) {
    const auto twin = edges.find({origin(next_corner(c)), origin(c)});
    if (twin == edges.end()) {
      border.push_back(c);
      continue;
    }
    fans.join(c, next_corner(twin->second));
    fans.join(next_corner(c), twin->second);
  }
  std::map<std::uint32_t, std::uint32_t> follower;  // border fan -> the next one of its loop
  for (const std::uint32_t c : border) follower[fans.of(c)] = fans.of(next_corner(c));

  Chart chart;
  std::map<std::uint32_t, std::uint32_t> local;
  const auto place = [&](std::uint32_t fan) {
    if (local.try_emplace(fan, static_cast<std::uint32_t>(chart.positions.size())).second)
      chart.positions.push_back(mesh.points[origin(fan)]);
  };
  for (const std::uint32_t c : border) {
    std::uint32_t fan = fans.of(c), size = 0;
    for (; !local.contains(fan); fan = follower[fan], ++size) place(fan);
    if (size > 0) chart.loop_sizes.push_back(size);
  }
  for (std::uint32_t c = 0; c < corners; ++c) place(fans.of(c));
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    chart.faces.push_back({local[fans.of(3 * f)], local[fans.of(3 * f + 1)], local[fans.of(3 * f + 2)]});
  return chart;
}

Chart cut(const TestMesh& mesh) {
  std::vector<std::uint32_t> all(mesh.faces.size());
  std::iota(all.begin(), all.end(), 0u);
  return cut(mesh, all);
}

std::vector<std::uint32_t> random_region(const TestMesh& mesh, std::size_t size, int patches, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> face_at;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t c = 0; c < 3; ++c) face_at[{mesh.faces[f][c], mesh.faces[f][(c + 1) % 3]}] = f;
  std::vector<bool> taken(mesh.faces.size(), false);
  std::vector<std::uint32_t> reached, region;
  for (int p = 0; p < patches; ++p) reached.push_back(static_cast<std::uint32_t>(random() % mesh.faces.size()));
  while (!reached.empty() && region.size() < size) {
    std::swap(reached[random() % reached.size()], reached.back());
    const std::uint32_t f = reached.back();
    reached.pop_back();
    if (taken[f]) continue;
    taken[f] = true;
    region.push_back(f);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto neighbour = face_at.find({mesh.faces[f][(c + 1) % 3], mesh.faces[f][c]});
      if (neighbour != face_at.end() && !taken[neighbour->second]) reached.push_back(neighbour->second);
    }
  }
  return region;
}

Chart shuffled(const Chart& chart, std::uint32_t seed) {
  std::mt19937 random(seed);
  const std::uint32_t border = chart.border_count();
  std::vector<std::uint32_t> order(chart.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = order.size(); i > border + std::size_t{1}; --i)
    std::swap(order[i - 1], order[border + random() % (i - border)]);
  Chart result{chart.loop_sizes, std::vector<LatticePoint>(order.size()), chart.faces};
  for (std::size_t v = 0; v < order.size(); ++v) result.positions[order[v]] = chart.positions[v];
  for (Triangle& face : result.faces) {
    for (std::uint32_t& v : face) v = order[v];
    std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(random() % 3), face.end());
  }
  for (std::size_t i = result.faces.size(); i > 1; --i) std::swap(result.faces[i - 1], result.faces[random() % i]);
  return result;
}

Chart normalized(const Chart& chart) {
  const auto border = static_cast<std::ptrdiff_t>(chart.border_count());
  std::vector<std::uint32_t> order(chart.positions.size()), number(chart.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin() + border, order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return chart.positions[a] < chart.positions[b]; });
  for (std::uint32_t i = 0; i < order.size(); ++i) number[order[i]] = i;
  Chart result{chart.loop_sizes, {}, chart.faces};
  for (const std::uint32_t v : order) result.positions.push_back(chart.positions[v]);
  for (Triangle& face : result.faces) {
    for (std::uint32_t& v : face) v = number[v];
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  }
  std::sort(result.faces.begin(), result.faces.end());
  return result;
}

LatticeBox box_of(const Chart& chart) {
  LatticeBox box;
  for (const LatticePoint p : chart.positions) box.add(p);
  return box;
}

}  // namespace ramcdb::codec::testing
