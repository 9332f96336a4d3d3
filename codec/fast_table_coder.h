#pragma once

#include "codec/fast_tables.h"
#include "ramcdb/bytes.h"

namespace ramcdb::codec {

/// The fast profile's part of a table blob: what differs from the built-in tables, by an adaptive range coder.
///
///   fast_part = context{kStepContexts} class{kFastPredictors}
///   context   = differs:bit [ difference{kStepSymbols - 1} ]     the last frequency follows from the others
///   class     = differs:bit [ difference{6} ]
///
/// Differences are signed numbers, to the built-in ones; those at the same place among symbols or weights share a
/// model. Throws invalid_argument for weights beyond +-kMostPlaceWeight.
[[nodiscard]] Buffer encode_fast_tables(const FastTables& tables);

/// Throws corrupt for bytes that encode_fast_tables did not write, so that any chart can be coded with the result.
[[nodiscard]] FastTables decode_fast_tables(Bytes bytes);

}  // namespace ramcdb::codec
