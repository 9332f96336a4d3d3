#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "api/large_work.h"
#include "api/mesh_spool.h"
#include "api/scratch_records.h"
#include "chartify/chartify.h"

namespace ramcdb::detail {

/// A face of a chart by its vertices in the chart.
struct ChartFace {
  Triangle corners{};
  std::uint32_t face = 0;  ///< its number in MeshSpool::faces()
};

/// A chart for itself.
struct SpooledChart {
  std::vector<std::uint32_t> vertices;  ///< numbers in the whole mesh, in the order in which faces name them
  std::vector<ChartFace> faces;
  std::uint32_t isolated = 0;  ///< how many of the vertices, the last ones, have no face
};

/// The charts of a mesh in temporary files.
class ChartSpool {
 public:
  explicit ChartSpool(const std::filesystem::path& folder) : vertices_(folder), faces_(folder) {}

  /// \param key where the chart lies along the mesh's curve: the least of its faces'
  void add(std::uint64_t key, const SpooledChart& chart);
  /// When all are added: numbers the charts along the curve.
  void finish();

  [[nodiscard]] std::size_t count() const { return charts_.size(); }
  [[nodiscard]] SpooledChart chart(std::size_t chart) const;
  [[nodiscard]] std::vector<std::uint32_t> vertices_of(std::size_t chart) const {
    return vertices_.read(charts_[chart].first_vertex, charts_[chart].vertices);
  }
  /// Runs of charts that hold up to so many faces, or are one chart.
  struct Batch {
    std::size_t first = 0, last = 0;
  };
  [[nodiscard]] std::vector<Batch> batches(std::uint64_t faces) const;

 private:
  struct Entry {
    std::uint64_t key, first_vertex, first_face;
    std::uint32_t vertices, faces, isolated;
  };

  ScratchRecords<std::uint32_t> vertices_;
  ScratchRecords<ChartFace> faces_;
  std::vector<Entry> charts_;
};

/// Some charts as a mesh of their own, whose vertices are numbered as faces name them, chart after chart.
struct ChartBatch {
  chartify::IndexedMesh mesh;
  chartify::Charts charts;
  std::vector<std::uint32_t> number;  ///< per vertex its number in the whole mesh
  std::vector<std::uint32_t> face;    ///< per face its number in MeshSpool::faces()
};
/// \param which charts, each once
[[nodiscard]] ChartBatch load_charts(const ChartSpool& spool, std::span<const std::size_t> which, const MeshSpool& of,
                                     const Lattice& lattice);
[[nodiscard]] ChartBatch load_charts(const ChartSpool& spool, const ChartSpool::Batch& batch, const MeshSpool& of,
                                     const Lattice& lattice);

}  // namespace ramcdb::detail
