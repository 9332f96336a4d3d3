#pragma once

#include <functional>
#include <optional>

#include "api/edit_builder.h"

namespace ramcdb::detail {

/// Cuts the charts of `changes.recut` anew, between the wires that other charts share with them, and codes what is not
/// as it was: surviving faces keep their charts as far as their sizes allow (chartify/rechart.h), a chart that comes
/// out with the faces and borders that it had keeps its blobs, and so do wires. Where such a wire is cut, the charts on
/// its other side pass its parts, and keep their blobs.
/// \param region charts of `at`, with attributes, those of `changes.recut` among them
/// \param may_recut whether a chart outside may be asked for
/// Returns a chart beside them that has to be cut anew, too, because they left one that is too small on its own; then
/// nothing was added to `builder`.
[[nodiscard]] std::optional<ChartId> encode_recut(const Snapshot::Impl& at, const RegionMesh& region,
                                                  const EditedRegion& edited, const ChangeSet& changes,
                                                  const std::function<bool(ChartId)>& may_recut, unsigned threads,
                                                  EditBuilder& builder);

}  // namespace ramcdb::detail
