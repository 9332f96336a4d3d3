#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ramcdb/bytes.h"
#include "ramcdb/chart.h"
#include "ramcdb/error.h"
#include "tests/fuzz/target.h"

/// What the targets of codec/ share: an input is what the decoder has to know beforehand, as a few bytes, and a blob.
namespace ramcdb::fuzz {

/// Takes numbers from the front of an input; 0 behind its end.
class CoderInput {
 public:
  CoderInput(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

  std::uint8_t byte() {
    if (left_.empty()) return 0;
    const std::uint8_t value = left_.front();
    left_ = left_.subspan(1);
    return value;
  }
  std::uint32_t word() {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value |= std::uint32_t{byte()} << (8 * i);
    return value;
  }
  [[nodiscard]] Bytes blob() const { return left_; }

 private:
  Bytes left_;
};

/// Puts an input together: the mirror of CoderInput.
class CoderSeed {
 public:
  CoderSeed& byte(std::size_t value) {
    bytes_.push_back(static_cast<char>(value));
    return *this;
  }
  CoderSeed& word(std::uint32_t value) {
    for (int i = 0; i < 4; ++i) byte(value >> (8 * i) & 255);
    return *this;
  }
  [[nodiscard]] Seed named(std::string name, Bytes blob) const {
    return {std::move(name), bytes_ + std::string(blob.begin(), blob.end())};
  }

 private:
  std::string bytes_;
};

/// Whether `decode()` throws what a decoder may throw; what else it throws ends the program.
template <class Decode>
bool refuses(const Decode& decode) {
  try {
    decode();
    return false;
  } catch (const Error& error) {
    require(error.code() == Errc::corrupt || error.code() == Errc::unsupported_version, error.what());
    return true;
  }
}

/// Small charts of all kinds, the contexts that chart, layer and polygon blobs are decoded in.
[[nodiscard]] const std::vector<Chart>& charts();

/// The chart that a byte chooses, and its number.
[[nodiscard]] inline const Chart& chart_of(std::uint8_t choice) { return charts()[choice % charts().size()]; }

/// Indices in range, coordinates on the lattice.
void require_valid(std::span<const LatticePoint> positions, std::span<const Triangle> faces);

}  // namespace ramcdb::fuzz
