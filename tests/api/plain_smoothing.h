#pragma once

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "ramcdb/snapshot.h"

/// What smoothing does, on one mesh in memory and as plainly as can be (rule: ramcdb/built_in_edits.h).
namespace ramcdb::test {

/// Vertices of edges that have not exactly two faces, and those that charts outside share.
inline std::vector<bool> fixed_vertices(const RegionMesh& region) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> faces_at;
  for (const Triangle& t : region.faces)
    for (std::size_t i = 0; i < 3; ++i) ++faces_at[std::minmax(t[i], t[(i + 1) % 3])];
  std::vector<bool> fixed = region.outer_border;
  for (const auto& [edge, faces] : faces_at)
    if (faces != 2) fixed[edge.first] = fixed[edge.second] = true;
  return fixed;
}

__extension__ using Wide = __int128;

inline Wide floor_divide(Wide num, Wide den) { return num / den - (num % den < 0); }

/// Lattice points in 2^-24ths of a step; lambda in 2^-20ths.
inline std::vector<LatticePoint> smoothed(const RegionMesh& region, unsigned iterations, double lambda) {
  const auto share = static_cast<std::int64_t>(std::floor(lambda * 1048576 + 0.5));
  const std::vector<bool> fixed = fixed_vertices(region);
  std::vector<std::array<std::int64_t, 3>> now(region.points.size()), next;
  for (std::size_t v = 0; v < now.size(); ++v)
    for (int a = 0; a < 3; ++a) now[v][static_cast<std::size_t>(a)] = std::int64_t{region.points[v][a]} * 16777216;
  for (unsigned i = 0; i < iterations; ++i) {
    next = now;
    for (std::size_t a = 0; a < 3; ++a) {
      std::vector<Wide> sum(now.size(), 0), count(now.size(), 0);
      for (const Triangle& t : region.faces)
        for (const std::uint32_t v : t)
          for (const std::uint32_t w : t)
            if (v != w) sum[v] += now[w][a], ++count[v];
      for (std::size_t v = 0; v < now.size(); ++v)
        if (!fixed[v] && count[v] > 0)
          next[v][a] += static_cast<std::int64_t>(
              floor_divide(share * (sum[v] - count[v] * now[v][a]) + count[v] * 524288, count[v] * 1048576));
    }
    now = next;
  }
  std::vector<LatticePoint> points(now.size());
  for (std::size_t v = 0; v < now.size(); ++v)
    for (int a = 0; a < 3; ++a)
      points[v][a] = static_cast<std::int32_t>(floor_divide(now[v][static_cast<std::size_t>(a)] + 8388608, 16777216));
  return points;
}

/// The same in doubles, model units, with every neighbour once: what textbooks say. Equal to the above up to rounding.
inline std::vector<Point> smoothed_in_doubles(const RegionMesh& region, const Lattice& lattice, unsigned iterations,
                                              double lambda) {
  const std::vector<bool> fixed = fixed_vertices(region);
  std::vector<std::vector<std::uint32_t>> ring(region.points.size());
  for (const Triangle& t : region.faces)
    for (std::size_t i = 0; i < 3; ++i)
      for (const std::uint32_t w : {t[(i + 1) % 3], t[(i + 2) % 3]})
        if (std::find(ring[t[i]].begin(), ring[t[i]].end(), w) == ring[t[i]].end()) ring[t[i]].push_back(w);
  std::vector<Point> now, next;
  for (const LatticePoint p : region.points) now.push_back(lattice.position(p));
  for (unsigned i = 0; i < iterations; ++i) {
    next = now;
    for (std::size_t v = 0; v < now.size(); ++v) {
      if (fixed[v] || ring[v].empty()) continue;
      for (int a = 0; a < 3; ++a) {
        double mean = 0;
        for (const std::uint32_t w : ring[v]) mean += now[w][a] / static_cast<double>(ring[v].size());
        next[v][a] += lambda * (mean - now[v][a]);
      }
    }
    now = next;
  }
  return now;
}

}  // namespace ramcdb::test
