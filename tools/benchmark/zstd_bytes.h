#pragma once

#include <zstd.h>

#include <stdexcept>

#include "ramcdb/bytes.h"

namespace ramcdb::benchmark {

inline Buffer packed(const Buffer& bytes, int level = 19) {
  Buffer out(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(size)) throw std::runtime_error("zstd cannot pack");
  out.resize(size);
  return out;
}

inline Buffer unpacked(Bytes bytes) {
  Buffer out(ZSTD_getFrameContentSize(bytes.data(), bytes.size()));
  const std::size_t size = ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size) || size != out.size()) throw std::runtime_error("zstd cannot unpack");
  return out;
}

}  // namespace ramcdb::benchmark
