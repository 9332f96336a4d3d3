#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "api/edit_encoder.h"
#include "api/page_index.h"
#include "api/scratch_file.h"
#include "api/turned_normals.h"

namespace ramcdb::detail {

/// Where a vertex goes; none where the mesh would keep it as it is. It is asked about a shared vertex once for every
/// chart on it, from several threads, and always has the same answer. `position` in model units.
using Mover = std::function<std::optional<VertexMove>(const VertexKey& key, LatticePoint from, const Point& position)>;

/// Which vertices of a mesh an edit moves, and how much it may hold in memory.
struct StreamedMoves {
  std::vector<ChartId> region;  ///< ascending
  bool border_moves = false;    ///< vertices move that charts outside the region share, so that those follow
  Mover mover;
  NormalTurner turner;             ///< none: normals stay as they are
  bool normals_still_fit = false;  ///< though they stay as they are
  std::uint64_t memory = 0;        ///< bytes for charts that are held at a time, more for one chart if it needs more
  std::filesystem::path scratch_folder;
};

struct SpooledBlob {
  std::uint64_t begin = 0;
  std::size_t size = 0;
};

struct SpooledLayer {
  std::uint16_t layer = 0;
  SpooledBlob blob;
  std::uint64_t bytes_before = 0;  ///< checksum included
};

/// A chart of which something was coded anew.
struct SpooledChart {
  ChartState base;  ///< what was read: the tip must still have it
  std::optional<SpooledBlob> blob;
  TableId table;
  LatticeBox box;
  codec::ChartCost cost_before, cost;
  std::vector<SpooledLayer> layers;
};

struct SpooledWire {
  WireId group;  ///< the first wire in its blob
  std::uint32_t inner_points = 0;
  std::uint64_t bytes_before = 0;  ///< its share of the blob that it was in, checksum included
  std::uint64_t points = 0;        ///< where its new points begin, ends included
};

/// An edit that moves vertices, coded, with all blobs in a file.
struct SpooledEdit {
  explicit SpooledEdit(const std::filesystem::path& folder) : file(folder) {}

  ScratchFile file;
  std::map<ChartId, SpooledChart> charts;
  std::map<WireId, SpooledWire> wires;
  std::map<WireId, SpooledBlob> wire_groups;  ///< by first wire
  std::map<CornerId, LatticePoint> corners;

  std::uint64_t charts_touched = 0, vertices_moved = 0, ranges_expanded = 0;
  double max_displacement = 0;  ///< model units
};

/// Codes what an edit moves, a few charts at a time. Every chart, wire and corner is as encode_edit would make it from
/// the same moves; threads and memory change no byte of it, except that wires are grouped by the thousand.
[[nodiscard]] SpooledEdit encode_streamed(const Snapshot::Impl& at, const StreamedMoves& moves, unsigned threads,
                                          const std::function<void(double)>& progress);

/// Charts in lists of a few that may be in memory at a time: `per_face` bytes for each face, and no more than keep all
/// threads busy.
[[nodiscard]] std::vector<std::span<const ChartId>> in_batches(const Snapshot::Impl& at,
                                                               std::span<const ChartId> charts, std::uint64_t memory,
                                                               std::uint64_t per_face, unsigned threads);

}  // namespace ramcdb::detail
