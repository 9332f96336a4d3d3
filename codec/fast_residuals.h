#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/fast_plan.h"
#include "codec/fast_vector.h"
#include "ramcdb/bytes.h"

/// How far predictions missed, three numbers per inner vertex, as bytes.
///
/// Every number is coded with one of a family of fixed distributions, from narrow to wide. Which one: numbers that are
/// expected to be alike share a context (how large the misses of the same coordinate were around the vertex, and how
/// many parallelograms the prediction had), and a context takes the distribution of the mean that it has seen so far.
///
///   residuals = [typical:1 state:4 state:4 state:4 word* raw bits]     nothing for no vertices
///   typical   = the distribution of all numbers together: what vertices of the border pass for
///   number    = token [raw bits]                                       signs in the lowest bit: 0, -1, 1, -2, 2 ...
///
/// Tokens below kDirectTokens are the number; above, two tokens share each octave, and raw bits tell the rest; the last
/// token says that kWideSize raw bits with the size of the number follow, and the number. Each coordinate has a state
/// of its own; the three take their words from one stream, forwards. The raw bits begin with the highest bit of the
/// last byte and run backwards until they meet the words.
namespace ramcdb::codec {

/// The fourth number is 0.
using FastResidual = Int4;

/// The numbers as bytes.
[[nodiscard]] Buffer encode_residuals(const FastPlan& plan, std::uint32_t border,
                                      std::span<const FastResidual> residuals);

/// Throws corrupt when encode_residuals did not write `bytes` for such a plan.
[[nodiscard]] std::vector<FastResidual> decode_residuals(Bytes bytes, const FastPlan& plan, std::uint32_t border);

}  // namespace ramcdb::codec
