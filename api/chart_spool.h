#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "api/large_work.h"
#include "api/mesh_spool.h"
#include "api/scratch_records.h"
#include "chartify/chartify.h"

namespace ramcdb::detail {

/// A face of a chart by its vertices in the whole mesh; or, as SortedFace, a vertex without a face.
struct ChartFace {
  Triangle corners{};
  std::uint32_t face = 0;  ///< in the file
};

/// The charts of a mesh, face by face in a temporary file.
class ChartSpool {
 public:
  explicit ChartSpool(const std::filesystem::path& folder) : faces_(folder) {}

  /// \param key where the chart lies along the mesh's curve: the least of its faces'
  /// \param isolated how many of `faces`, the last ones, are vertices without a face
  void add(std::uint64_t key, std::span<const ChartFace> faces, std::uint32_t isolated);
  /// When all are added: numbers the charts along the curve.
  void finish();

  [[nodiscard]] std::size_t count() const { return charts_.size(); }
  [[nodiscard]] std::vector<ChartFace> faces_of(std::size_t chart) const {
    return faces_.read(charts_[chart].begin, charts_[chart].size);
  }
  /// Runs of charts that hold up to so many faces, or are one chart.
  struct Batch {
    std::size_t first = 0, last = 0;
  };
  [[nodiscard]] std::vector<Batch> batches(std::uint64_t faces) const;
  [[nodiscard]] std::uint32_t isolated_in(std::size_t chart) const { return charts_[chart].isolated; }

 private:
  struct Entry {
    std::uint64_t key, begin;
    std::uint32_t size, isolated;
  };

  ScratchRecords<ChartFace> faces_;
  std::vector<Entry> charts_;
};

/// Some charts as a mesh of their own, whose vertices are numbered as faces name them, chart after chart.
struct ChartBatch {
  chartify::IndexedMesh mesh;
  chartify::Charts charts;
  std::vector<std::uint32_t> number;  ///< per vertex its number in the whole mesh
  std::vector<std::uint32_t> face;    ///< per face its number in the file
};
/// \param which charts, each once
[[nodiscard]] ChartBatch load_charts(const ChartSpool& spool, std::span<const std::size_t> which,
                                     const PointFile& points, const Lattice& lattice);
[[nodiscard]] ChartBatch load_charts(const ChartSpool& spool, const ChartSpool::Batch& batch, const PointFile& points,
                                     const Lattice& lattice);

}  // namespace ramcdb::detail
