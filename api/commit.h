#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "api/edit_encoder.h"
#include "ramcdb/figures.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// What moves mean, before anything is coded.
[[nodiscard]] ChangeReport describe_moves(const RegionMesh& region, std::span<const VertexMove> moves,
                                          const Lattice& lattice);

/// Fills in tip, changed_by_others and conflicts of a report on moves in `parts`, against the tip of `branch`.
void compare_with_tip(ChangeReport& report, std::span<const RegionPart> parts, std::string_view branch);

/// The charts of a region that `version` holds in another state than the region does, and that `version` did not write
/// itself: what others changed before it.
[[nodiscard]] std::vector<ChartId> changed_by_others(std::span<const RegionPart> parts, VersionId version);

/// The name of an attempt: the same edit of the same checkout has one name, however often it is sent.
[[nodiscard]] std::string attempt_name(std::string_view nonce, std::string_view branch,
                                       std::span<const VertexMove> moves);

/// Codes the moves, decides against the branch's tip and publishes. Nothing moved: nothing is written. Conflicts come
/// back in the report, with nothing written. \param attempt from attempt_name(): a repeated commit is one commit.
[[nodiscard]] CommitReport commit_moves(std::span<const RegionPart> parts, const ChangeReport& change,
                                        std::span<const VertexMove> moves, const CommitOptions& options,
                                        const std::string& attempt);

}  // namespace ramcdb::detail
