#include "api/chart_spool.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "api/face_blocks.h"

namespace ramcdb::detail {
namespace {

constexpr std::uint32_t kNone = chartify::kNone;

/// Gives vertices of a whole mesh numbers of their own, in the order in which they come.
class Renumbering {
 public:
  explicit Renumbering(std::vector<std::uint32_t> vertices) : sorted_(std::move(vertices)) {
    sort_vertices(sorted_);
    own_.assign(sorted_.size(), kNone);
  }

  std::uint32_t number(std::uint32_t vertex, std::vector<std::uint32_t>& in_order) {
    const auto at = std::lower_bound(sorted_.begin(), sorted_.end(), vertex) - sorted_.begin();
    std::uint32_t& own = own_[static_cast<std::size_t>(at)];
    if (own == kNone) {
      own = static_cast<std::uint32_t>(in_order.size());
      in_order.push_back(vertex);
    }
    return own;
  }

 private:
  std::vector<std::uint32_t> sorted_, own_;
};

}  // namespace

void ChartSpool::add(std::uint64_t key, std::span<const ChartFace> faces, std::uint32_t isolated) {
  charts_.push_back({key, faces_.size(), static_cast<std::uint32_t>(faces.size()), isolated});
  faces_.add(faces);
}

void ChartSpool::finish() {
  faces_.flush();
  std::sort(charts_.begin(), charts_.end(),
            [](const Entry& a, const Entry& b) { return std::tuple(a.key, a.begin) < std::tuple(b.key, b.begin); });
}

std::vector<ChartSpool::Batch> ChartSpool::batches(std::uint64_t faces) const {
  std::vector<Batch> batches;
  std::uint64_t held = 0;
  for (std::size_t c = 0; c < charts_.size(); ++c) {
    if (batches.empty() || held + charts_[c].size > faces) {
      batches.push_back({c, c});
      held = 0;
    }
    batches.back().last = c + 1;
    held += charts_[c].size;
  }
  return batches;
}

ChartBatch load_charts(const ChartSpool& spool, std::span<const std::size_t> which, const PointFile& points,
                       const Lattice& lattice) {
  std::vector<std::vector<ChartFace>> charts;
  std::vector<std::uint32_t> vertices;
  for (const std::size_t c : which) {
    charts.push_back(spool.faces_of(c));
    for (const ChartFace& face : charts.back())
      for (const std::uint32_t v : face.corners)
        if (v != SortedFace::kNoVertex) vertices.push_back(v);
  }
  Renumbering numbers(std::move(vertices));
  ChartBatch batch;
  batch.charts.chart_count = static_cast<std::uint32_t>(which.size());
  for (std::uint32_t c = 0; c < which.size(); ++c)
    for (const ChartFace& face : std::span(charts[c]).first(charts[c].size() - spool.isolated_in(which[c]))) {
      Triangle t{};
      for (std::size_t i = 0; i < 3; ++i) t[i] = numbers.number(face.corners[i], batch.number);
      batch.mesh.faces.push_back(t);
      batch.charts.chart_of_face.push_back(c);
      batch.face.push_back(face.face);
    }
  for (std::uint32_t c = 0; c < which.size(); ++c)
    for (const ChartFace& vertex : std::span(charts[c]).last(spool.isolated_in(which[c]))) {
      (void)numbers.number(vertex.corners[0], batch.number);
      batch.charts.chart_of_isolated_vertex.push_back(c);
    }
  for (const std::uint32_t v : batch.number) batch.mesh.positions.push_back(lattice.snap(points.at(v)));
  return batch;
}

ChartBatch load_charts(const ChartSpool& spool, const ChartSpool::Batch& batch, const PointFile& points,
                       const Lattice& lattice) {
  std::vector<std::size_t> which(batch.last - batch.first);
  std::iota(which.begin(), which.end(), batch.first);
  return load_charts(spool, which, points, lattice);
}

}  // namespace ramcdb::detail
