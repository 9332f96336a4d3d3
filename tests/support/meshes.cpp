#include "tests/support/meshes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <random>

namespace ramcdb::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

using Index = std::uint32_t;

Index index(std::size_t i) { return static_cast<Index>(i); }

/// Pseudo-random in -1..1 from lattice coordinates.
double noise_at(std::int64_t x, std::int64_t y, std::int64_t z) {
  auto h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U ^ static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FU ^
           static_cast<std::uint64_t>(z) * 0x165667B19E3779F9U;
  h = (h ^ (h >> 29)) * 0xBF58476D1CE4E5B9U;
  h = (h ^ (h >> 32)) * 0x94D049BB133111EBU;
  return static_cast<double>((h ^ (h >> 31)) >> 11) / static_cast<double>(1ULL << 52) - 1;
}

double smooth_noise(const Point& p) {
  const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double tx = ease(p.x - fx), ty = ease(p.y - fy), tz = ease(p.z - fz);
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const double weight = (c & 1 ? tx : 1 - tx) * (c & 2 ? ty : 1 - ty) * (c & 4 ? tz : 1 - tz);
    sum += weight * noise_at(static_cast<std::int64_t>(fx) + (c & 1), static_cast<std::int64_t>(fy) + ((c >> 1) & 1),
                             static_cast<std::int64_t>(fz) + (c >> 2));
  }
  return sum;
}

void append(TestMesh& mesh, const TestMesh& other, const Point& shift, double scale = 1) {
  const Index base = index(mesh.positions.size());
  for (const Point& p : other.positions)
    mesh.positions.push_back({p.x * scale + shift.x, p.y * scale + shift.y, p.z * scale + shift.z});
  for (const Triangle& t : other.faces) mesh.faces.push_back({t[0] + base, t[1] + base, t[2] + base});
}

/// A closed grid of rings: u around, v along; wraps in u, and in v too where asked.
template <class Place>
TestMesh tube(std::size_t nu, std::size_t nv, bool closed_v, Place&& place) {
  TestMesh mesh;
  for (std::size_t v = 0; v < nv; ++v)
    for (std::size_t u = 0; u < nu; ++u)
      mesh.positions.push_back(place(static_cast<double>(u) / static_cast<double>(nu), v));
  for (std::size_t v = 0; v + (closed_v ? 0 : 1) < nv; ++v)
    for (std::size_t u = 0; u < nu; ++u) {
      const Index a = index(v * nu + u), b = index(v * nu + (u + 1) % nu);
      const Index c = index((v + 1) % nv * nu + u), d = index((v + 1) % nv * nu + (u + 1) % nu);
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  return mesh;
}

TestMesh box(const Point& lo, const Point& size) {
  TestMesh mesh;
  for (int c = 0; c < 8; ++c)
    mesh.positions.push_back({lo.x + (c & 1 ? size.x : 0), lo.y + (c & 2 ? size.y : 0), lo.z + (c & 4 ? size.z : 0)});
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Joins vertices of `other` that lie on vertices of `mesh`; everything else of it is added.
void append_joined(TestMesh& mesh, const TestMesh& other) {
  std::map<std::tuple<double, double, double>, Index> at;
  for (Index v = 0; v < mesh.positions.size(); ++v)
    at.emplace(std::tuple{mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z}, v);
  std::vector<Index> to;
  for (const Point& p : other.positions) {
    const auto [it, is_new] = at.try_emplace(std::tuple{p.x, p.y, p.z}, index(mesh.positions.size()));
    if (is_new) mesh.positions.push_back(p);
    to.push_back(it->second);
  }
  for (const Triangle& t : other.faces) mesh.faces.push_back({to[t[0]], to[t[1]], to[t[2]]});
}

}  // namespace

double fractal(const Point& p, int octaves) {
  double sum = 0, weight = 0.5, scale = 1;
  for (int o = 0; o < octaves; ++o, weight /= 2, scale *= 2)
    sum += weight * smooth_noise({p.x * scale + 17 * o, p.y * scale, p.z * scale});
  return sum;
}

TestMesh sphere(std::size_t faces) {
  const auto nu = std::max<std::size_t>(4, static_cast<std::size_t>(std::sqrt(static_cast<double>(faces))));
  const std::size_t nv = std::max<std::size_t>(2, faces / (2 * nu));
  TestMesh mesh = tube(nu, nv, false, [&](double u, std::size_t v) {
    const double polar = kPi * static_cast<double>(v + 1) / static_cast<double>(nv + 1), turn = 2 * kPi * u;
    return Point{std::sin(polar) * std::cos(turn), -std::sin(polar) * std::sin(turn), std::cos(polar)};
  });
  const Index top = index(mesh.positions.size()), bottom = top + 1;
  mesh.positions.push_back({0, 0, 1});
  mesh.positions.push_back({0, 0, -1});
  for (std::size_t u = 0; u < nu; ++u) {
    const Index a = index(u), b = index((u + 1) % nu), last = index((nv - 1) * nu);
    mesh.faces.push_back({b, a, top});
    mesh.faces.push_back({last + a, last + b, bottom});
  }
  return mesh;
}

TestMesh torus(std::size_t faces) {
  const auto nu = std::max<std::size_t>(3, static_cast<std::size_t>(std::sqrt(static_cast<double>(faces) / 6)));
  const std::size_t nv = std::max<std::size_t>(3, faces / (2 * nu));
  return tube(nu, nv, true, [&](double u, std::size_t v) {
    const double a = 2 * kPi * u, b = 2 * kPi * static_cast<double>(v) / static_cast<double>(nv);
    const double r = 1 + 0.4 * std::cos(a);
    return Point{r * std::cos(b), r * std::sin(b), 0.4 * std::sin(a)};
  });
}

TestMesh genus3(std::size_t faces) {
  // A plate of 14 x 6 blocks of n x n cells, blocks (2..3, 2..3), (6..7, 2..3), (10..11, 2..3) left out.
  const auto n = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(static_cast<double>(faces) / 320)));
  const std::size_t nx = 14 * n, ny = 6 * n;
  const auto solid = [&](std::ptrdiff_t x, std::ptrdiff_t y) {
    if (x < 0 || y < 0 || x >= static_cast<std::ptrdiff_t>(nx) || y >= static_cast<std::ptrdiff_t>(ny)) return false;
    const std::size_t bx = static_cast<std::size_t>(x) / n, by = static_cast<std::size_t>(y) / n;
    return by < 2 || by > 3 || bx % 4 < 2;
  };
  TestMesh mesh;
  std::map<std::tuple<std::size_t, std::size_t, int>, Index> at;
  const auto vertex = [&](std::size_t x, std::size_t y, int side) {
    const auto [it, is_new] = at.try_emplace({x, y, side}, index(mesh.positions.size()));
    if (is_new) {
      const double px = static_cast<double>(x) / static_cast<double>(n),
                   py = static_cast<double>(y) / static_cast<double>(n);
      mesh.positions.push_back({px, py, (side ? 0.6 : -0.6) + 0.2 * std::sin(px) * std::cos(py)});
    }
    return it->second;
  };
  const auto quad = [&](Index a, Index b, Index c, Index d) {
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({a, c, d});
  };
  for (std::size_t y = 0; y < ny; ++y)
    for (std::size_t x = 0; x < nx; ++x) {
      const auto sx = static_cast<std::ptrdiff_t>(x), sy = static_cast<std::ptrdiff_t>(y);
      if (!solid(sx, sy)) continue;
      quad(vertex(x, y, 1), vertex(x + 1, y, 1), vertex(x + 1, y + 1, 1), vertex(x, y + 1, 1));
      quad(vertex(x, y, 0), vertex(x, y + 1, 0), vertex(x + 1, y + 1, 0), vertex(x + 1, y, 0));
      if (!solid(sx, sy - 1)) quad(vertex(x, y, 0), vertex(x + 1, y, 0), vertex(x + 1, y, 1), vertex(x, y, 1));
      if (!solid(sx, sy + 1))
        quad(vertex(x, y + 1, 0), vertex(x, y + 1, 1), vertex(x + 1, y + 1, 1), vertex(x + 1, y + 1, 0));
      if (!solid(sx - 1, sy)) quad(vertex(x, y, 0), vertex(x, y, 1), vertex(x, y + 1, 1), vertex(x, y + 1, 0));
      if (!solid(sx + 1, sy))
        quad(vertex(x + 1, y, 0), vertex(x + 1, y + 1, 0), vertex(x + 1, y + 1, 1), vertex(x + 1, y, 1));
    }
  return mesh;
}

TestMesh terrain(std::size_t nx, std::size_t ny) {
  TestMesh mesh;
  for (std::size_t y = 0; y <= ny; ++y)
    for (std::size_t x = 0; x <= nx; ++x) {
      const auto px = static_cast<double>(x), py = static_cast<double>(y);
      mesh.positions.push_back({px, py, 12 * fractal({px / 16, py / 16, 0.5}, 5)});
    }
  for (std::size_t y = 0; y < ny; ++y)
    for (std::size_t x = 0; x < nx; ++x) {
      const Index a = index(y * (nx + 1) + x), b = a + 1, c = index((y + 1) * (nx + 1) + x), d = c + 1;
      mesh.faces.push_back({a, b, d});
      mesh.faces.push_back({a, d, c});
    }
  return mesh;
}

TestMesh scan(std::size_t faces) {
  TestMesh mesh = sphere(faces);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Point& p = mesh.positions[v];
    const double bumps = 0.35 * fractal({2 * p.x + 9, 2 * p.y, 2 * p.z}, 4);
    const double grain = 0.002 * noise_at(static_cast<std::int64_t>(v), 1, 2);
    const double r = 1 + bumps + grain;
    p = {1.1 * p.x * r, 0.8 * p.y * r, 1.6 * p.z * r};
  }
  // Holes: all faces around some vertices; the vertices go too.
  const std::size_t every = std::max<std::size_t>(97, faces / 40);
  std::vector<Index> to(mesh.positions.size(), 0);
  TestMesh open;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    to[v] = index(open.positions.size());
    if (v % every != every / 2) open.positions.push_back(mesh.positions[v]);
  }
  for (const Triangle& t : mesh.faces)
    if (std::none_of(t.begin(), t.end(), [&](Index v) { return v % every == every / 2; }))
      open.faces.push_back({to[t[0]], to[t[1]], to[t[2]]});
  return open;
}

TestMesh boxes(std::size_t count) {
  TestMesh mesh;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(i % side), y = static_cast<double>(i / side);
    const double height = 5 + 4 * noise_at(static_cast<std::int64_t>(i), 3, 5);
    append(mesh, box({0, 0, 0}, {6 + noise_at(static_cast<std::int64_t>(i), 1, 1), 6, height}), {10 * x, 12 * y, 0});
  }
  return mesh;
}

TestMesh several_components() {
  TestMesh mesh;
  append(mesh, sphere(4000), {0, 0, 0}, 3);
  append(mesh, torus(2500), {6, 0, 0});
  append(mesh, terrain(30, 20), {-40, -10, -6});
  append(mesh, sphere(200), {0, 7, 0}, 0.5);
  append(mesh, boxes(9), {10, 10, 0}, 0.2);
  append(mesh, sphere(16), {0, -7, 0}, 0.1);
  return mesh;
}

TestMesh moebius() {
  constexpr std::size_t kAround = 60, kAcross = 5;
  TestMesh mesh;
  for (std::size_t u = 0; u < kAround; ++u)
    for (std::size_t v = 0; v < kAcross; ++v) {
      const double turn = 2 * kPi * static_cast<double>(u) / kAround;
      const double s = 0.4 * (static_cast<double>(v) / (kAcross - 1) - 0.5);
      const double r = 1 + s * std::cos(turn / 2);
      mesh.positions.push_back({r * std::cos(turn), r * std::sin(turn), s * std::sin(turn / 2)});
    }
  for (std::size_t u = 0; u < kAround; ++u)
    for (std::size_t v = 0; v + 1 < kAcross; ++v) {
      const bool seam = u + 1 == kAround;
      const auto at = [&](std::size_t du, std::size_t dv) {
        const std::size_t w = v + dv;
        return du == 0 ? index(u * kAcross + w) : seam ? index(kAcross - 1 - w) : index((u + 1) * kAcross + w);
      };
      mesh.faces.push_back({at(0, 0), at(1, 0), at(1, 1)});
      mesh.faces.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  return mesh;
}

TestMesh two_cubes_sharing_edge() {
  TestMesh mesh = box({0, 0, 0}, {1, 1, 1});
  append_joined(mesh, box({1, 1, 0}, {1, 1, 1}));
  return mesh;
}

TestMesh hourglass() {
  TestMesh mesh = box({0, 0, 0}, {1, 1, 1});
  append_joined(mesh, box({1, 1, 1}, {1, 1, 1}));
  return mesh;
}

TestMesh three_faces_one_edge() {
  TestMesh mesh;
  for (int z = 0; z <= 6; ++z) mesh.positions.push_back({0, 0, static_cast<double>(z)});
  for (int sheet = 0; sheet < 3; ++sheet) {
    const Index base = index(mesh.positions.size());
    const double turn = 2 * kPi * sheet / 3;
    for (int z = 0; z <= 6; ++z) mesh.positions.push_back({std::cos(turn), std::sin(turn), static_cast<double>(z)});
    for (Index z = 0; z < 6; ++z) {
      mesh.faces.push_back({z, base + z, base + z + 1});
      mesh.faces.push_back({z, base + z + 1, z + 1});
    }
  }
  return mesh;
}

TestMesh degenerate_and_duplicate_faces() {
  TestMesh mesh = terrain(12, 12);
  const Triangle first = mesh.faces[40], second = mesh.faces[101];
  mesh.faces.push_back({first[0], first[0], first[1]});
  mesh.faces.push_back({second[2], second[1], second[2]});
  mesh.faces.push_back({5, 5, 5});
  mesh.faces.push_back(first);
  mesh.faces.push_back({second[0], second[2], second[1]});
  mesh.positions[30] = mesh.positions[31];
  return mesh;
}

TestMesh isolated_vertices() {
  TestMesh mesh = sphere(800);
  for (int i = 0; i < 40; ++i)
    mesh.positions.insert(mesh.positions.end(), {noise_at(i, 0, 0) * 2, noise_at(i, 1, 0) * 2, noise_at(i, 2, 0) * 2});
  return mesh;
}

TestMesh shuffled(const TestMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  const auto permutation = [&](std::size_t count) {
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    return order;
  };
  const std::vector<Index> vertex_order = permutation(mesh.positions.size());
  std::vector<Index> to(mesh.positions.size());
  TestMesh out;
  for (Index v = 0; v < vertex_order.size(); ++v) {
    to[vertex_order[v]] = v;
    out.positions.push_back(mesh.positions[vertex_order[v]]);
  }
  for (const Index f : permutation(mesh.faces.size())) {
    Triangle t = mesh.faces[f];
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
    out.faces.push_back({to[t[0]], to[t[1]], to[t[2]]});
  }
  return out;
}

std::vector<LatticePoint> snap_to_bits(const TestMesh& mesh, unsigned bits) {
  if (mesh.positions.empty()) return {};
  Point lo = mesh.positions.front(), hi = lo;
  for (const Point& p : mesh.positions)
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], p[a]);
      hi[a] = std::max(hi[a], p[a]);
    }
  const double extent = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
  const Lattice lattice{lo, extent > 0 ? extent / static_cast<double>((1U << bits) - 1) : 1};
  std::vector<LatticePoint> points;
  for (const Point& p : mesh.positions) points.push_back(lattice.snap(p));
  return points;
}

std::optional<std::filesystem::path> meshes_folder() {
  if (const char* named = std::getenv("RAMCDB_MESHES")) return std::filesystem::path(named);
  const auto beside = std::filesystem::path(RAMCDB_SOURCE_DIR).parent_path() / "shared" / "meshes";
  if (std::filesystem::is_directory(beside)) return beside;
  return std::nullopt;
}

std::uintmax_t largest_real_file() {
  if (const char* given = std::getenv("RAMCDB_LARGEST_FILE")) return std::strtoull(given, nullptr, 10);
#ifdef __SANITIZE_ADDRESS__
  return 1'000'000;
#else
  return 3'000'000;
#endif
}

}  // namespace ramcdb::test
