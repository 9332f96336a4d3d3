#include "codec/range_coder.h"

#include <utility>

#include "ramcdb/error.h"

namespace ramcdb::codec {

namespace range_coder_detail {

Flush shortest_flush(std::uint64_t low, std::uint64_t range) {
  for (int bytes = 0; bytes < 8; ++bytes) {
    const std::uint64_t below = ~std::uint64_t{0} >> (8 * bytes);  // what the bytes left out could hold
    const std::uint64_t value = (low + below) & ~below;            // low rounded up; 2^64 wraps to 0
    if (value - low < range) return {value, bytes, value < low};
  }
  return {low, 8, false};
}

}  // namespace range_coder_detail

void RangeEncoder::carry() {
  for (std::size_t i = out_.size(); i-- > 0;)
    if (++out_[i] != 0) return;
}

void RangeEncoder::shift_out() {
  const auto word = static_cast<std::uint32_t>(low_ >> 32);
  const std::array<std::uint8_t, 4> bytes{static_cast<std::uint8_t>(word >> 24), static_cast<std::uint8_t>(word >> 16),
                                          static_cast<std::uint8_t>(word >> 8), static_cast<std::uint8_t>(word)};
  out_.insert(out_.end(), bytes.begin(), bytes.end());
  low_ <<= 32;
  range_ <<= 32;
}

Buffer RangeEncoder::finish() {
  const auto flush = range_coder_detail::shortest_flush(low_, range_);
  if (flush.carry) carry();
  for (int i = 0; i < flush.bytes; ++i) out_.push_back(static_cast<std::uint8_t>(flush.value >> (56 - 8 * i)));
  return std::move(out_);
}

std::uint32_t RangeDecoder::word_at_end(Bytes stream, std::size_t at) {
  // An encoder leaves out 8 bytes at most. Whoever needs more reads bytes that were never written.
  if (at + 4 > stream.size() + 8) refuse();
  std::uint32_t word = 0;
  for (std::size_t i = at; i < at + 4; ++i) word = word << 8 | (i < stream.size() ? stream[i] : 0u);
  return word;
}

void RangeDecoder::finish() const {
  std::uint64_t window = 0;  // the last 8 bytes taken
  for (std::size_t i = read_ - 8; i < read_; ++i) window = window << 8 | (i < stream_.size() ? stream_[i] : 0u);
  const auto flush = range_coder_detail::shortest_flush(window - offset_, range_);
  const std::size_t length = read_ - 8 + static_cast<std::size_t>(flush.bytes);
  if (flush.value != window || length != stream_.size()) refuse();
}

void RangeDecoder::refuse() { throw Error(Errc::corrupt, "a coded stream is cut short, too long or damaged"); }

}  // namespace ramcdb::codec
