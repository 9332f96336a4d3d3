#include "api/streamed_export.h"

#include "api/chart_loader.h"
#include "api/file_coordinates.h"
#include "api/scratch_records.h"
#include "api/snapshot_impl.h"
#include "api/spooled_edit.h"

namespace ramcdb::detail {
namespace {

constexpr std::uint64_t kMemory = std::uint64_t{256} << 20;
constexpr std::uint64_t kBytesPerFace = 400;  ///< of a chart that is decoded

/// Numbers the vertices of a mesh in the order in which its charts come. Points of a wire follow one another, since the
/// first chart on it passes all of them in turn.
class VertexNumbers {
 public:
  explicit VertexNumbers(const MeshRecord& record)
      : wires_(record.next_wire.value), corners_(record.next_corner.value, kNone) {}

  void begin_chart() { chart_ = kNone; }

  /// \param inner_points of the wire that it is on, else not used
  std::uint32_t number(const VertexKey& key, std::uint32_t inner_points) {
    if (key.where == VertexKey::Where::corner) return first_or(corners_[key.id], 0);
    if (key.where == VertexKey::Where::chart) return first_or(chart_, key.index);
    OfWire& wire = wires_[key.id];
    if (wire.first == kNone) wire.backwards = key.index > 0;
    return first_or(wire.first, wire.backwards ? inner_points - 1 - key.index : key.index);
  }

  [[nodiscard]] std::uint32_t next() const { return next_; }
  void take() { ++next_; }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct OfWire {
    std::uint32_t first = kNone;
    bool backwards = false;
  };

  [[nodiscard]] std::uint32_t first_or(std::uint32_t& first, std::uint32_t index) const {
    if (first == kNone) first = next_;
    return first + index;
  }

  std::vector<OfWire> wires_;
  std::vector<std::uint32_t> corners_;
  std::uint32_t chart_ = kNone, next_ = 0;
};

/// A mesh on its way into a file.
class Exporter {
 public:
  Exporter(const Snapshot& snapshot, const std::filesystem::path& file, const FileOptions& options)
      : snapshot_(snapshot),
        at_(snapshot.impl()),
        options_(options),
        format_(mesh_file::format_of(file)),
        numbers_(at_.record()),
        positions_(folder_of(file)),
        corners_(folder_of(file)) {}

  StreamedExport run(const std::filesystem::path& file) {
    const std::vector<ChartId> charts = snapshot_.find({{WholeMesh{}}, 0}, &out_.cost);
    for (const auto batch : in_batches(at_, charts, kMemory, kBytesPerFace, options_.threads)) {
      if (options_.progress)
        options_.progress("read", static_cast<double>(out_.charts) / static_cast<double>(charts.size()));
      add(batch);
    }
    out_.vertices = positions_.size();
    out_.faces = corners_.size();
    positions_.flush();
    corners_.flush();
    write(file);
    return std::move(out_);
  }

 private:
  static std::filesystem::path folder_of(const std::filesystem::path& file) {
    return file.has_parent_path() ? file.parent_path() : ".";
  }

  void add(std::span<const ChartId> batch) {
    ChartLoader loader(at_);
    RegionMesh added;  // the vertices that are new
    for (const LoadedChart& chart : loader.load(batch, options_.threads, &out_.cost)) add(chart, loader, added);
    held_by_floats_ = held_by_floats_ && floats_hold(snapshot_, added);
    for (std::size_t v = 0; v < added.points.size(); ++v) positions_.add(snapshot_.position(added, v));
    out_.charts += batch.size();
  }

  void add(const LoadedChart& chart, const ChartLoader& loader, RegionMesh& added) {
    numbers_.begin_chart();
    std::vector<std::uint32_t> number(chart.keys.size());
    for (std::size_t v = 0; v < chart.keys.size(); ++v) {
      const VertexKey& key = chart.keys[v];
      const bool of_wire = key.where == VertexKey::Where::wire;
      number[v] = numbers_.number(key, of_wire ? loader.wires().at(WireId(key.id)).entry.inner_points : 0);
      if (number[v] != numbers_.next()) continue;
      numbers_.take();
      added.points.push_back(chart.chart.positions[v]);
      if (!chart.exact.empty()) added.exact.push_back(chart.exact[v]);
    }
    for (const Triangle& t : chart.chart.faces) corners_.add({number[t[0]], number[t[1]], number[t[2]]});
  }

  void write(const std::filesystem::path& file) {
    const ScratchView positions = positions_.view(), corners = corners_.view();
    mesh_file::MeshOutput out;
    out.scalar = scalar_for(at_.record(), format_, held_by_floats_);
    out.positions = positions.as<Point>();
    out.corners = corners.as<std::uint32_t>();
    out.references = at_.layers().references;
    out_.left_out = mesh_file::write_mesh(file, format_, out, options_.ascii);
  }

  const Snapshot& snapshot_;
  const Snapshot::Impl& at_;
  const FileOptions& options_;
  mesh_file::Format format_;
  VertexNumbers numbers_;
  ScratchRecords<Point> positions_;
  ScratchRecords<Triangle> corners_;
  bool held_by_floats_ = true;
  StreamedExport out_;
};

}  // namespace

bool exports_in_pieces(const Snapshot& snapshot, const std::filesystem::path& file, const FileOptions& options) {
  return options.paint == Paint::none && !mesh_file::is_gltf(mesh_file::format_of(file)) &&
         snapshot.impl().layers().layers.empty();
}

StreamedExport export_in_pieces(const Snapshot& snapshot, const std::filesystem::path& file,
                                const FileOptions& options) {
  return Exporter(snapshot, file, options).run(file);
}

}  // namespace ramcdb::detail
