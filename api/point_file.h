#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include "api/lattice_choice.h"
#include "api/scratch_records.h"
#include "ramcdb/attributes.h"

namespace ramcdb::detail {

/// The positions of a mesh in a temporary file: as float32 as long as all of them are such numbers, else as float64.
class PointFile {
 public:
  explicit PointFile(const std::filesystem::path& folder) : folder_(folder), narrow_(std::in_place, folder) {}

  void add(std::span<const Point> points);
  /// From here on points can be read, and none added.
  void finish();

  [[nodiscard]] std::uint64_t size() const { return wide_ ? wide_->size() : narrow_->size(); }
  [[nodiscard]] NumberType type() const { return wide_ ? NumberType::float64 : NumberType::float32; }
  /// Here and there; thread-safe.
  [[nodiscard]] Point at(std::uint64_t number) const {
    if (wide_) return view_->as<Point>()[number];
    const Narrow& p = view_->as<Narrow>()[number];
    return {p[0], p[1], p[2]};
  }
  /// Outlived by the file.
  [[nodiscard]] PositionSource source() const;

 private:
  using Narrow = std::array<float, 3>;

  void widen();

  std::filesystem::path folder_;
  std::optional<ScratchRecords<Narrow>> narrow_;
  std::optional<ScratchRecords<Point>> wide_;
  std::optional<ScratchView> view_;
};

}  // namespace ramcdb::detail
