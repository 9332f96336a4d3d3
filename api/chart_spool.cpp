#include "api/chart_spool.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "api/vertex_ranks.h"

namespace ramcdb::detail {
void ChartSpool::add(std::uint64_t key, const SpooledChart& chart) {
  charts_.push_back({key, vertices_.size(), faces_.size(), static_cast<std::uint32_t>(chart.vertices.size()),
                     static_cast<std::uint32_t>(chart.faces.size()), chart.isolated});
  vertices_.add(std::span(chart.vertices));
  faces_.add(std::span(chart.faces));
}

void ChartSpool::finish() {
  vertices_.flush();
  faces_.flush();
  std::sort(charts_.begin(), charts_.end(), [](const Entry& a, const Entry& b) {
    return std::tuple(a.key, a.first_vertex) < std::tuple(b.key, b.first_vertex);
  });
}

SpooledChart ChartSpool::chart(std::size_t chart) const {
  const Entry& entry = charts_[chart];
  return {vertices_of(chart), faces_.read(entry.first_face, entry.faces), entry.isolated};
}

std::vector<ChartSpool::Batch> ChartSpool::batches(std::uint64_t faces) const {
  std::vector<Batch> batches;
  std::uint64_t held = 0;
  for (std::size_t c = 0; c < charts_.size(); ++c) {
    const std::uint64_t size = std::uint64_t{charts_[c].faces} + charts_[c].isolated;
    if (batches.empty() || held + size > faces) {
      batches.push_back({c, c});
      held = 0;
    }
    batches.back().last = c + 1;
    held += size;
  }
  return batches;
}

ChartBatch load_charts(const ChartSpool& spool, std::span<const std::size_t> which, const MeshSpool& of,
                       const Lattice& lattice) {
  std::vector<SpooledChart> charts;
  std::vector<std::uint32_t> named;  // of all charts those in faces first
  for (const std::size_t c : which) {
    const auto& chart = charts.emplace_back(spool.chart(c));
    named.insert(named.end(), chart.vertices.begin(), chart.vertices.end() - chart.isolated);
  }
  for (const SpooledChart& chart : charts)
    named.insert(named.end(), chart.vertices.end() - chart.isolated, chart.vertices.end());
  const VertexRanks ranks(named);

  ChartBatch batch;
  std::vector<std::uint32_t> number(ranks.vertices.size(), chartify::kNone);  // per rank
  for (std::size_t i = 0; i < named.size(); ++i)
    if (std::uint32_t& own = number[ranks.rank[i]]; own == chartify::kNone) {
      own = static_cast<std::uint32_t>(batch.number.size());
      batch.number.push_back(named[i]);
    }
  batch.charts.chart_count = static_cast<std::uint32_t>(which.size());
  std::size_t first = 0;
  for (std::uint32_t c = 0; c < charts.size(); ++c) {
    for (const ChartFace& face : charts[c].faces) {
      Triangle t{};
      for (std::size_t i = 0; i < 3; ++i) t[i] = number[ranks.rank[first + face.corners[i]]];
      batch.mesh.faces.push_back(t);
      batch.charts.chart_of_face.push_back(c);
      batch.face.push_back(face.face);
    }
    first += charts[c].vertices.size() - charts[c].isolated;
    batch.charts.chart_of_isolated_vertex.insert(batch.charts.chart_of_isolated_vertex.end(), charts[c].isolated, c);
  }
  for (const std::uint32_t v : batch.number) batch.mesh.positions.push_back(lattice.snap(of.points.at(v)));
  batch.mesh.polygon_of_face = of.polygons_of(batch.face);
  return batch;
}

ChartBatch load_charts(const ChartSpool& spool, const ChartSpool::Batch& batch, const MeshSpool& of,
                       const Lattice& lattice) {
  std::vector<std::size_t> which(batch.last - batch.first);
  std::iota(which.begin(), which.end(), batch.first);
  return load_charts(spool, which, of, lattice);
}

}  // namespace ramcdb::detail
