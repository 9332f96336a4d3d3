#include "chartify/hilbert_cells.h"

#include <algorithm>

#include "chartify/hilbert.h"

namespace ramcdb::chartify {
namespace {

constexpr int kBits = 16;

LatticeBox box_of(const IndexedMesh& mesh) {
  LatticeBox box;
  for (const LatticePoint p : mesh.positions) box.add(p);
  return box;
}

}  // namespace

HilbertCurve::HilbertCurve(const LatticeBox& box) {
  if (box.empty()) return;
  std::int64_t extent = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    low_[a] = 3 * std::int64_t{box.lo[axis]};
    extent = std::max(extent, 3 * (std::int64_t{box.hi[axis]} - box.lo[axis]) + 1);
  }
  while ((extent - 1) >> shift_ >> kBits) ++shift_;
}

std::uint64_t HilbertCurve::key(const std::array<std::int64_t, 3>& sum) const {
  std::array<std::uint32_t, 3> cell{};
  for (std::size_t a = 0; a < 3; ++a) cell[a] = static_cast<std::uint32_t>((sum[a] - low_[a]) >> shift_);
  return hilbert_key(cell, kBits);
}

HilbertCells::HilbertCells(const IndexedMesh& mesh) : mesh_(mesh), curve_(box_of(mesh)) {}

}  // namespace ramcdb::chartify
