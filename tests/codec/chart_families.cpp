#include "tests/codec/chart_families.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/codec/chart_cutter.h"
#include "tests/support/meshes.h"

namespace ramcdb::codec::testing {

namespace {

TestMesh on_lattice(const test::TestMesh& mesh, unsigned bits) { return {test::snap_to_bits(mesh, bits), mesh.faces}; }

/// Two meshes as one, without a vertex in common.
TestMesh together(TestMesh a, const TestMesh& b, LatticePoint shift) {
  const auto offset = static_cast<std::uint32_t>(a.points.size());
  for (const LatticePoint p : b.points) a.points.push_back({p.x + shift.x, p.y + shift.y, p.z + shift.z});
  for (const Triangle& f : b.faces) a.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
  return a;
}

/// All faces but those that `leave_out` says yes to.
template <class LeaveOut>
Chart cut_without(const TestMesh& mesh, const LeaveOut& leave_out) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    if (!leave_out(f)) faces.push_back(f);
  return cut(mesh, faces);
}

Chart polygon_without_inner_vertices(std::uint32_t corners) {
  Chart chart{{corners}, {}, {}};
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double t = 2 * M_PI * i / corners;
    chart.positions.push_back({static_cast<std::int32_t>(std::lround(90000 * std::cos(t))),
                               static_cast<std::int32_t>(std::lround(70000 * std::sin(t))), 0});
  }
  for (std::uint32_t low = 0, high = corners - 1; low + 1 < high;) {  // zigzag
    chart.faces.push_back({low, low + 1, high});
    if (++low + 1 < high) chart.faces.push_back({low, high - 1, high});
    --high;
  }
  return chart;
}

Chart stretched_to_the_limits(Chart chart) {
  const LatticeBox box = box_of(chart);
  for (LatticePoint& p : chart.positions)
    for (int a = 0; a < 3; ++a) {
      const double t = box.hi[a] > box.lo[a] ? double(p[a] - box.lo[a]) / double(box.hi[a] - box.lo[a]) : 0;
      p[a] = static_cast<std::int32_t>((2 * t - 1) * kMaxLatticeCoordinate);
    }
  return chart;
}

Chart with_isolated(Chart chart, int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  for (int i = 0; i < count; ++i)
    chart.positions.push_back({static_cast<std::int32_t>(random() % 5000), static_cast<std::int32_t>(random() % 5000),
                               static_cast<std::int32_t>(random() % 3)});
  return chart;
}

/// Vertices here and there, as far apart as the lattice allows.
Chart wildly_placed(Chart chart, std::uint32_t seed) {
  std::mt19937 random(seed);
  for (LatticePoint& p : chart.positions)
    for (int a = 0; a < 3; ++a)
      p[a] = random() % 3 == 0 ? (random() % 2 ? kMaxLatticeCoordinate : -kMaxLatticeCoordinate)
                               : static_cast<std::int32_t>(random() % (1u << 31)) - (1 << 30) + 1;
  for (LatticePoint& p : chart.positions)
    for (int a = 0; a < 3; ++a) p[a] = std::clamp(p[a], -kMaxLatticeCoordinate, kMaxLatticeCoordinate);
  return chart;
}

Chart all_in_one_place(Chart chart) {
  for (LatticePoint& p : chart.positions) p = {7, -7, 7};
  return chart;
}

}  // namespace

Chart boxes(std::size_t count) { return cut(on_lattice(test::boxes(count), 14)); }

Chart one_triangle() { return {{3}, {{0, 0, 0}, {10, 0, 1}, {0, 10, 2}}, {{0, 1, 2}}}; }

Chart wheel(std::uint32_t rim, bool open) {
  Chart chart{{open ? rim + 1 : rim}, {}, {}};
  const std::uint32_t hub = rim;  // the last border vertex when open, the only inner one otherwise
  for (std::uint32_t i = 0; i < rim; ++i) {
    const double t = (open ? 1.5 : 2) * M_PI * i / rim;
    chart.positions.push_back({static_cast<std::int32_t>(std::lround(30000 * std::cos(t))),
                               static_cast<std::int32_t>(std::lround(30000 * std::sin(t))),
                               static_cast<std::int32_t>(i % 7)});
  }
  chart.positions.push_back({3, 4, 500});
  for (std::uint32_t i = 0; i + open < rim; ++i) chart.faces.push_back({i, (i + 1) % rim, hub});
  return chart;
}

std::vector<NamedChart> manifold_charts() {
  const TestMesh ring = torus(24, 14, 4000), ball = sphere(3, 3000), land = terrain(20, 40, 5);
  std::vector<NamedChart> charts{
      {"empty", {}},
      {"one triangle", one_triangle()},
      {"two triangles with one corner in common",
       cut({{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {-9, 0, 0}, {0, -9, 0}}, {{0, 1, 2}, {0, 3, 4}}})},
      {"pillow", {{}, {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {{0, 1, 2}, {0, 2, 1}}}},
      {"tetrahedron",
       cut({{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}})},
      {"only isolated vertices", with_isolated({}, 30, 2)},
      {"isolated vertices beside faces", with_isolated(cut(land, random_region(land, 300, 1, 4)), 17, 3)},
      {"isolated vertices in equal places", all_in_one_place(with_isolated({}, 5, 2))},
      {"polygon", polygon_without_inner_vertices(1000)},
      {"inner vertex of valence 1000", wheel(1000, false)},
      {"border vertex of valence 1000", wheel(1000, true)},
      {"closed sphere", cut(ball)},
      {"closed torus", cut(ring)},
      {"torus with a hole", cut_without(ring, [](std::uint32_t f) { return f < 9; })},
      {"tube", cut_without(ring, [](std::uint32_t f) { return f < 56; })},
      {"sphere with many holes", cut_without(ball, [](std::uint32_t f) { return f % 16 == 3; })},
      {"all but the corners of a sphere's faces", cut_without(ball, [](std::uint32_t f) { return f % 4 != 3; })},
      {"several components", cut(together(together(ball, ring, {20000, 0, 0}), land, {0, 0, -9000}))},
      {"equal components in one place", cut(together(ball, ball, {}))},
      {"genus 3", cut(on_lattice(test::genus3(1500), 12))},
      {"scan", cut(on_lattice(test::scan(3000), 12))},
      {"boxes", boxes(40)},
      {"scan on 20 bits", cut(on_lattice(test::scan(1500), 20))},
      {"terrain on 20 bits", cut(on_lattice(test::terrain(20, 25), 20))},
      {"scan on 30 bits", cut(on_lattice(test::scan(800), 30))},
      {"terrain from end to end of the lattice", stretched_to_the_limits(cut(land))},
      {"torus from end to end of the lattice", stretched_to_the_limits(cut(ring))},
      {"torus in one place", all_in_one_place(cut(ring))},
      {"vertices anywhere", wildly_placed(cut(ball), 8)},
      {"border vertices anywhere", wildly_placed(cut(ring, random_region(ring, 400, 3, 6)), 9)},
  };
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    const TestMesh& mesh = seed % 3 == 0 ? ring : seed % 3 == 1 ? ball : land;
    const int patches = 1 + static_cast<int>(seed % 5);
    charts.push_back(
        {"random region " + std::to_string(seed), cut(mesh, random_region(mesh, 8 * seed, patches, seed))});
  }
  return charts;
}

std::vector<NamedChart> broken_charts() {
  const TestMesh land = terrain(8, 40, 5);
  Chart repeated = cut(land);
  repeated.faces.push_back(repeated.faces[10]);
  Chart backside = cut(land);
  backside.faces.push_back({backside.faces[10][0], backside.faces[10][2], backside.faces[10][1]});
  Chart degenerate = cut(land);
  degenerate.faces.push_back({4, 4, 5});
  degenerate.faces.push_back({6, 6, 6});
  Chart turned = cut(land);
  std::swap(turned.faces[20][0], turned.faces[20][1]);
  Chart without_border = cut(land);
  without_border.loop_sizes.clear();
  Chart wrong_loops = cut(land);
  wrong_loops.loop_sizes = {3, wrong_loops.loop_sizes[0] - 3};
  Chart all_isolated = cut(land);
  all_isolated.faces.clear();
  const test::TestMesh messy = test::degenerate_and_duplicate_faces();
  return {
      {"a face twice", repeated},
      {"a face and its back", backside},
      {"degenerate faces", degenerate},
      {"a face turned over", turned},
      {"border without loops", without_border},
      {"loops that are no border", wrong_loops},
      {"loops without faces", all_isolated},
      {"two fans at a vertex",
       {{},
        {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}, {-9, 0, 0}, {0, -9, 0}, {0, 0, -9}},
        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 5, 4}, {0, 4, 6}, {4, 5, 6}, {0, 6, 5}}}},
      {"degenerate and duplicate faces", {{}, test::snap_to_bits(messy, 12), messy.faces}},
      {"three faces on an edge",
       {{}, test::snap_to_bits(test::three_faces_one_edge(), 12), test::three_faces_one_edge().faces}},
      {"moebius strip", {{}, test::snap_to_bits(test::moebius(), 12), test::moebius().faces}},
      {"extremes",
       {{},
        {{kMaxLatticeCoordinate, kMaxLatticeCoordinate, kMaxLatticeCoordinate},
         {-kMaxLatticeCoordinate, -kMaxLatticeCoordinate, -kMaxLatticeCoordinate}},
        {{0, 1, 0}, {1, 1, 1}}}},
  };
}

Chart triangle_soup(std::uint32_t seed) {
  std::mt19937 random(seed);
  Chart chart;
  const std::uint32_t vertices = 1 + static_cast<std::uint32_t>(random() % 12);
  const std::uint32_t spread = 1u << (random() % 31);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    LatticePoint p;
    for (int a = 0; a < 3; ++a) p[a] = static_cast<std::int32_t>(random() % spread);
    chart.positions.push_back(p);
  }
  std::uint32_t border = 0;
  while (random() % 2 == 0) {
    const auto size = static_cast<std::uint32_t>(3 + random() % 3);
    if (border + size > vertices) break;
    chart.loop_sizes.push_back(size);
    border += size;
  }
  const std::uint32_t faces = static_cast<std::uint32_t>(random() % 25);
  for (std::uint32_t f = 0; f < faces; ++f) {
    Triangle face;
    for (std::uint32_t& v : face) v = static_cast<std::uint32_t>(random() % vertices);
    chart.faces.push_back(face);
  }
  return chart;
}

}  // namespace ramcdb::codec::testing
