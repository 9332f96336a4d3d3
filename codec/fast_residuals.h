#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/fast_plan.h"
#include "ramcdb/bytes.h"

/// How far predictions missed, three numbers per inner vertex, as bytes.
///
/// Every number is coded with one of a family of fixed distributions, from narrow to wide. Which one: numbers that are
/// expected to be alike share a context (how large the misses of the same coordinate were around the vertex, and how
/// many parallelograms the prediction had), and a context takes the distribution of the mean that it has seen so far.
/// Contexts look up their distribution anew every kScaleBlock vertices only, so that a decoder hardly notices.
///
///   residuals = mean:1  state:4 state:4 state:4  word*  raw bits, backwards from the end
///   number    = token  raw_bits                         sign in the lowest bit: 0, -1, 1, -2, 2 ...
///
/// Tokens below kDirectTokens are the number; above, two tokens halve each octave, and raw bits tell the rest; the last
/// token says that six raw bits with the size of the number follow, and the number. Each coordinate has a state of its
/// own; the three take their words from one stream.
namespace ramcdb::codec {

using FastResidual = std::array<std::int32_t, 3>;

[[nodiscard]] Buffer encode_residuals(const FastPlan& plan, std::uint32_t border,
                                      std::span<const FastResidual> residuals);

/// Throws corrupt when encode_residuals did not write `bytes` for such a plan.
[[nodiscard]] std::vector<FastResidual> decode_residuals(Bytes bytes, const FastPlan& plan, std::uint32_t border);

}  // namespace ramcdb::codec
