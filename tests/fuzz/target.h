#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// Bytes that nobody vouches for, given to one reader or decoder. A target is one file that defines the two functions
/// below; it runs under libFuzzer (tools/fuzz), or over files and its own seeds (replay.cpp, in the tests).
namespace ramcdb::fuzz {

struct Seed {
  std::string name;
  std::string bytes;
};

/// Small inputs to begin with, of all kinds.
[[nodiscard]] std::vector<Seed> seeds();

/// Ends the program, saying what is wrong, unless `holds`: what libFuzzer keeps the input for.
void require(bool holds, const char* what);

}  // namespace ramcdb::fuzz

/// libFuzzer's: 0, or a call that does not return. Bytes lie in a block of just their size.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
