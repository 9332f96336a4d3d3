#pragma once

#include <cstdint>

namespace ramcdb::detail {

/// What the store adds to every blob: its checksum. Figures count it.
inline constexpr std::uint64_t kBlobOverhead = 8;

/// Deeper trees of index pages do not exist: 64^8 pages.
inline constexpr int kMaxPageDepth = 10;

}  // namespace ramcdb::detail
