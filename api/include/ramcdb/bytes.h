#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ramcdb {

/// A read-only view of bytes. It owns nothing: the function that hands one out says how long it lives.
using Bytes = std::span<const std::uint8_t>;

/// Bytes that are owned.
using Buffer = std::vector<std::uint8_t>;

}  // namespace ramcdb
