#pragma once

#include <filesystem>
#include <functional>
#include <unordered_map>
#include <vector>

#include "api/chart_loader.h"
#include "api/region_file.h"
#include "api/scratch_records.h"

namespace ramcdb::detail {

/// Numbers vertices in the order in which charts name them, every one once. Charts, wires and corners need memory,
/// their vertices none: those of a wire follow one another, since the first chart on it passes all of them in turn.
class VertexNumbers {
 public:
  /// The number of a vertex: count() for one that was not named before, which then counts. A chart's inner vertices are
  /// named once.
  [[nodiscard]] std::uint32_t number(const VertexKey& key);
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  /// Point `from` has number `first`; the next ones along the wire have the next numbers if that is its begin, else
  /// those before it have.
  struct Run {
    std::uint32_t first, from;
  };
  [[nodiscard]] std::uint32_t take(std::uint32_t number) {
    if (number == count_) ++count_;
    return number;
  }

  std::unordered_map<std::uint32_t, Run> wires_;
  std::unordered_map<std::uint32_t, std::uint32_t> corners_;
  std::uint32_t count_ = 0;
};

/// A whole mesh on its way to a file, in the order of a region of all its charts: read a few charts at a time, and kept
/// in temporary files.
class OutputSpool {
 public:
  /// \param folder of the temporary files; \param paint colours of charts, or empty
  OutputSpool(const Snapshot::Impl& at, const std::filesystem::path& folder, std::vector<mesh_file::FaceColor> paint);

  /// \param memory bytes for the charts that are held at a time
  void load(std::span<const ChartId> charts, std::uint64_t memory, unsigned threads, ReadCost& cost,
            const std::function<void(double)>& progress);

  [[nodiscard]] std::uint64_t vertices() const { return points_.size(); }
  [[nodiscard]] std::uint64_t faces() const { return faces_; }  ///< triangles

  /// Throws as `coordinates_for` and `write_output_mesh`.
  [[nodiscard]] WrittenRegion write(const Snapshot& snapshot, const std::filesystem::path& file,
                                    const FileOptions& options) const;

 private:
  struct Values {
    const Layer* layer;
    std::size_t place;  ///< in the layers of a chart
    ScratchRecords<double> numbers;
  };

  void add(const LoadedChart& chart, std::size_t position);
  void add_faces(const LoadedChart& chart, const std::vector<std::uint32_t>& vertex, std::size_t position);
  void add_values(Values& values, const LoadedChart& chart, const std::vector<std::uint32_t>& new_vertices) const;
  void flush();

  const Snapshot::Impl& at_;
  std::filesystem::path folder_;
  std::vector<mesh_file::FaceColor> paint_;
  bool has_polygons_;
  VertexNumbers numbers_;
  std::uint64_t faces_ = 0;
  ScratchRecords<LatticePoint> points_;
  ScratchRecords<Point> exact_;
  ScratchRecords<std::uint32_t> corners_, sizes_;
  ScratchRecords<mesh_file::FaceColor> face_colors_;
  std::vector<Values> values_;
};

}  // namespace ramcdb::detail
