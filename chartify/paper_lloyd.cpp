#include "chartify/paper_lloyd.h"

#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "chartify/growth.h"

namespace ramcdb::chartify {
namespace {

constexpr int kMostIterations = 30;
constexpr double kLambda = 1;  // equation (1): the smallest value that keeps costs from being negative

using Vector = std::array<double, 3>;

Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector normalized(const Vector& v) {
  const double length = std::sqrt(dot(v, v));
  return length > 0 ? Vector{v[0] / length, v[1] / length, v[2] / length} : Vector{};
}

class PaperLloyd {
 public:
  PaperLloyd(const IndexedMesh& mesh, const Neighbours& neighbours, const Regions& regions)
      : neighbours_(neighbours), regions_(regions), seeds_(spread_seeds(regions)) {
    for (const Triangle& t : mesh.faces) {
      std::array<Vector, 3> p{};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t a = 0; a < 3; ++a) p[i][a] = mesh.positions[t[i]][static_cast<int>(a)];
      const Vector sum = p[0] + p[1] + p[2], u = p[1] - p[0], v = p[2] - p[0];
      centroids_.push_back({sum[0] / 3, sum[1] / 3, sum[2] / 3});
      normals_.push_back(normalized({u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]}));
    }
  }

  void grow() {
    partition_.chart_of_face.assign(centroids_.size(), kNone);
    partition_.sizes.assign(seeds_.size(), 0);
    normal_sum_.assign(seeds_.size(), Vector{});
    queue_ = {};
    order_ = 0;
    for (std::uint32_t c = 0; c < seeds_.size(); ++c) queue_.push({0, order_++, seeds_[c], c});
    while (!queue_.empty()) {
      const Candidate candidate = queue_.top();
      queue_.pop();
      if (partition_.chart_of_face[candidate.face] == kNone) conquer(candidate.face, candidate.chart);
    }
  }

  /// Returns whether any seed moved.
  bool move_seeds() {
    std::vector<Vector> sums(seeds_.size());
    std::vector<double> nearest(seeds_.size(), std::numeric_limits<double>::infinity());
    std::vector<std::uint32_t> seeds(seeds_);
    for (std::size_t f = 0; f < centroids_.size(); ++f)
      if (const std::uint32_t c = partition_.chart_of_face[f]; c != kNone) sums[c] = sums[c] + centroids_[f];
    for (std::uint32_t f = 0; f < centroids_.size(); ++f) {
      const std::uint32_t c = partition_.chart_of_face[f];
      if (c == kNone) continue;
      const double n = partition_.sizes[c];
      const Vector d = centroids_[f] - Vector{sums[c][0] / n, sums[c][1] / n, sums[c][2] / n};
      if (dot(d, d) >= nearest[c]) continue;
      nearest[c] = dot(d, d);
      seeds[c] = f;
    }
    return std::exchange(seeds_, seeds) != seeds;
  }

  Partition take() { return std::move(partition_); }

 private:
  struct Candidate {
    double cost;
    std::uint64_t order;  ///< of pushing; earlier ones first among equals
    std::uint32_t face, chart;
    friend bool operator>(const Candidate& a, const Candidate& b) {
      return a.cost != b.cost ? a.cost > b.cost : a.order > b.order;
    }
  };

  void conquer(std::uint32_t face, std::uint32_t chart) {
    partition_.chart_of_face[face] = chart;
    ++partition_.sizes[chart];
    normal_sum_[chart] = normal_sum_[chart] + normals_[face];
    const Vector normal = normalized(normal_sum_[chart]);
    const std::uint32_t region = regions_.region_of_face[face];
    const double average = static_cast<double>(regions_.sizes[region]) / regions_.charts[region];
    const double access = partition_.sizes[chart] / average;  // equation (2)
    for (std::size_t e = 3 * std::size_t{face}; e < 3 * std::size_t{face} + 3; ++e) {
      const std::uint32_t g = neighbours_[e];
      if (g == kNone || partition_.chart_of_face[g] != kNone || regions_.region_of_face[g] != region) continue;
      const Vector step = centroids_[g] - centroids_[face];
      const double cost = (kLambda - dot(normal, normals_[g])) * std::sqrt(dot(step, step));  // equation (1)
      queue_.push({access * cost, order_++, g, chart});                                       // equation (3)
    }
  }

  const Neighbours& neighbours_;
  const Regions& regions_;
  std::vector<Vector> centroids_, normals_, normal_sum_;
  std::vector<std::uint32_t> seeds_;
  Partition partition_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
  std::uint64_t order_ = 0;
};

}  // namespace

Partition paper_lloyd(const IndexedMesh& mesh, const Neighbours& neighbours, const Regions& regions,
                      const Progress& progress) {
  PaperLloyd lloyd(mesh, neighbours, regions);
  lloyd.grow();
  for (int i = 0; i < kMostIterations && lloyd.move_seeds(); ++i) {
    report(progress, static_cast<double>(i + 1) / (kMostIterations + 1));
    lloyd.grow();
  }
  return lloyd.take();
}

}  // namespace ramcdb::chartify
