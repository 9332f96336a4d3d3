#pragma once

#include <array>
#include <cstdint>

namespace ramcdb::chartify {

/// Position along a Hilbert curve through a cube of 2^bits cells a side; 1 <= bits <= 21. After J. Skilling,
/// "Programming the Hilbert curve" (2004): Gray code in, transposed index out, then interleaved.
inline std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x, int bits) {
  const std::uint32_t top = 1U << (bits - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (std::uint32_t& coordinate : x) {
      if (coordinate & q) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ coordinate) & p;
        x[0] ^= t;
        coordinate ^= t;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1)
    if (x[2] & q) t ^= q - 1;
  for (std::uint32_t& coordinate : x) coordinate ^= t;
  std::uint64_t key = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (const std::uint32_t coordinate : x) key = key << 1 | ((coordinate >> bit) & 1);
  return key;
}

}  // namespace ramcdb::chartify
