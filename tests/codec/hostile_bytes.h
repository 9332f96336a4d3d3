#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "ramcdb/bytes.h"
#include "ramcdb/error.h"
#include "tests/support/memory_watch.h"

/// What every decoder must survive.
namespace ramcdb::codec::testing {

inline constexpr std::size_t kMostMemory = std::size_t{256} << 20;

inline std::string hex(Bytes bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const auto b : bytes) text += {kDigits[b >> 4], kDigits[b & 15]};
  return text;
}

inline Buffer bytes_of(std::string_view hex_digits) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  Buffer bytes;
  for (std::size_t i = 0; i + 1 < hex_digits.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(16 * digit(hex_digits[i]) + digit(hex_digits[i + 1])));
  return bytes;
}

/// Whether `decode(bytes)` throws ramcdb::Error. The bytes lie in a block of just their size, so that an address
/// sanitizer sees one byte too far. Any other exception, and memory beyond bounds, fails the test.
template <class Decode>
bool refuses(const Decode& decode, Bytes bytes) {
  const auto exact = std::make_unique<std::uint8_t[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), exact.get());
  const test::MemoryWatch watch;
  bool refused = false;
  try {
    decode(Bytes(exact.get(), bytes.size()));
  } catch (const Error& e) {
    refused = true;
    EXPECT_TRUE(e.code() == Errc::corrupt || e.code() == Errc::unsupported_version) << e.what();
  } catch (const std::exception& e) {
    ADD_FAILURE() << "not a ramcdb::Error: " << e.what();
  }
  EXPECT_LT(watch.peak(), kMostMemory);
  return refused;
}

/// For blobs that carry no check: shorter and longer ones may well be those of something else, which `decode` has to
/// look at, but mostly they are refused.
template <class Decode>
void expect_survives_other_lengths(const Decode& decode, const Buffer& blob) {
  std::size_t refused = 0, tried = 0;
  for (std::size_t n = 0; n < blob.size(); ++n, ++tried) refused += refuses(decode, Bytes(blob).first(n));
  EXPECT_GE(2 * refused, tried);
  for (const int extra : {0, 1, 127, 128, 255}) {
    Buffer longer = blob;
    longer.push_back(static_cast<std::uint8_t>(extra));
    (void)refuses(decode, longer);
    longer.insert(longer.end(), 8, static_cast<std::uint8_t>(extra));
    EXPECT_TRUE(refuses(decode, longer)) << "with nine times " << extra << " behind";
  }
}

/// Every shorter prefix and every longer blob must be refused.
template <class Decode>
void expect_refuses_other_lengths(const Decode& decode, const Buffer& blob) {
  for (std::size_t n = 0; n < blob.size(); ++n)
    EXPECT_TRUE(refuses(decode, Bytes(blob).first(n))) << "first " << n << " of " << blob.size();
  for (const int extra : {0, 1, 127, 128, 255}) {
    Buffer longer = blob;
    longer.push_back(static_cast<std::uint8_t>(extra));
    EXPECT_TRUE(refuses(decode, longer)) << "with " << extra << " behind";
  }
}

/// Damages each byte in turn, in six ways; returns how many of those blobs `decode` took. It has to check what it gets.
template <class Decode>
int count_taken_when_damaged(const Decode& decode, const Buffer& blob) {
  int taken = 0;
  for (std::size_t i = 0; i < blob.size(); ++i)
    for (const int change : {1, 4, 32, 128, 255, 85}) {
      Buffer damaged = blob;
      damaged[i] = static_cast<std::uint8_t>(damaged[i] ^ change);
      taken += !refuses(decode, damaged);
    }
  return taken;
}

}  // namespace ramcdb::codec::testing
