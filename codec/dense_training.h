#pragma once

#include <span>

#include "codec/tables.h"
#include "ramcdb/chart.h"

namespace ramcdb::codec {

/// Predictor weights of the dense coder that suit a mesh, from some of its charts: iteratively reweighted least squares
/// (weight 1 / (error^2 + 2), in lattice units), so that it is the number of bits that gets small, not the largest
/// errors. The order in which a chart is coded depends on its positions and not on weights, so what predictions are
/// made from is gathered in one walk. A class keeps the built-in weights where its own would not pay for their place in
/// the table.
///
/// The same charts give the same tables on every machine. Charts that the dense coder does not take teach nothing.
/// \param charts takes more time and memory with every vertex (some 200 bytes); 100,000 vertices say all there is
/// \param vertices of the whole mesh: what the table has to pay for
[[nodiscard]] CoderTables train_dense(std::span<const Chart* const> charts, std::uint64_t vertices);

}  // namespace ramcdb::codec
