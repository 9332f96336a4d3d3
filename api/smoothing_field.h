#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "api/edit_encoder.h"
#include "api/scratch_file.h"
#include "api/snapshot_impl.h"

namespace ramcdb::detail {

/// The positions of a region's vertices while they are smoothed (rule: ramcdb/built_in_edits.h), with the faces that
/// tie them together, in a temporary file. In memory are the places of charts, wires and corners in it.
class SmoothingField {
 public:
  /// In 2^-24ths of a lattice step from the lattice's origin.
  using Position = std::array<std::int64_t, 3>;

  /// \param charts ascending
  SmoothingField(const Snapshot::Impl& at, std::vector<ChartId> charts, const std::filesystem::path& scratch_folder);

  using Report = std::function<void(double)>;
  /// Reads all charts, about `memory` bytes of them at a time.
  void load(std::uint64_t memory, unsigned threads, const Report& progress);
  /// One iteration. \param lambda in 2^-20ths
  void step(std::int64_t lambda, unsigned threads);

  /// Where smoothing took a vertex from where it was. Thread-safe.
  [[nodiscard]] std::optional<VertexMove> move_of(const VertexKey& key, LatticePoint from, const Point& position) const;

 private:
  /// Sums of positions: a vertex may have any number of faces.
  __extension__ using Wide = __int128;
  struct Sum {
    std::array<Wide, 3> of{};
    std::uint64_t count = 0;
  };
  struct Part {
    std::uint32_t border = 0, inner = 0, faces = 0;
    std::uint64_t positions = 0, triangles = 0, slots = 0;  ///< where they begin in the file
  };

  void number_shared();
  void fix_borders();
  void fix_wire(const PageWire& wire);
  void lay_out();
  void store(const struct LoadedChart& chart, const Part& part);
  void add_up(const Part& part, std::vector<Sum>& sums) const;
  void step_chart(const Part& part, std::int64_t lambda, std::vector<Sum>& border_sums);
  [[nodiscard]] Position start_of(LatticePoint from, const Point& position) const;
  [[nodiscard]] std::size_t slot_of(const VertexKey& key) const;
  [[nodiscard]] const Position& position_of(const VertexKey& key) const;

  const Snapshot::Impl& at_;
  std::vector<ChartId> charts_;
  std::filesystem::path scratch_folder_;
  std::vector<Part> parts_;                               ///< per chart
  std::unordered_map<WireId, std::uint32_t> wire_slots_;  ///< that of the first inner point
  std::unordered_map<CornerId, std::uint32_t> corner_slots_;
  std::vector<bool> fixed_;  ///< per slot: shared vertices that stay
  std::uint32_t slots_ = 0;
  std::uint64_t sums_begin_ = 0;
  std::optional<ScratchMemory> memory_;
};

}  // namespace ramcdb::detail
