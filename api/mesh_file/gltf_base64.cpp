#include "api/mesh_file/gltf_base64.h"

#include <array>
#include <cstdint>

namespace ramcdb::mesh_file::gltf {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Value of each base64 character; 255: none.
constexpr std::array<std::uint8_t, 256> base64_table() {
  std::array<std::uint8_t, 256> table{};
  table.fill(255);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    table[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
  table[static_cast<unsigned char>('-')] = 62;  // as URIs may write them
  table[static_cast<unsigned char>('_')] = 63;
  return table;
}

}  // namespace

void Base64Encoder::add(std::string_view bytes) {
  for (const char byte : bytes) {
    bits_ = bits_ << 8U | static_cast<unsigned char>(byte);
    if (++pending_ == 3) add_digits(4);
  }
}

void Base64Encoder::end() {
  if (pending_) {
    const std::size_t digits = pending_ + 1;
    bits_ <<= 8U * (3 - static_cast<unsigned>(pending_));
    add_digits(digits);
    text_.append(4 - digits, '=');
  }
  put_(text_);
  text_.clear();
}

void Base64Encoder::add_digits(std::size_t digits) {
  constexpr std::size_t kBlock = 1 << 16;
  for (unsigned i = 0; i < digits; ++i) text_ += kDigits[bits_ >> (18 - 6 * i) & 63U];
  bits_ = 0;
  pending_ = 0;
  if (text_.size() < kBlock) return;
  put_(text_);
  text_.clear();
}

bool decode_base64(std::string_view text, std::string& bytes) {
  static constexpr auto kTable = base64_table();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  bytes.resize(text.size() / 4 * 3 + (text.size() % 4 ? text.size() % 4 - 1 : 0));
  std::size_t to = 0;
  std::uint32_t bits = 0;
  std::uint8_t wrong = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t digit = kTable[static_cast<unsigned char>(text[i])];
    wrong |= digit;
    bits = bits << 6 | (digit & 63U);
    if (i % 4 != 3) continue;
    for (const unsigned shift : {16U, 8U, 0U}) bytes[to++] = static_cast<char>(bits >> shift & 255U);
  }
  if (text.size() % 4 >= 2) bytes[to++] = static_cast<char>(bits >> (text.size() % 4 == 2 ? 4U : 10U) & 255U);
  if (text.size() % 4 == 3) bytes[to++] = static_cast<char>(bits >> 2U & 255U);
  return !(wrong & 192U) && text.size() % 4 != 1;
}

}  // namespace ramcdb::mesh_file::gltf
