#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/edit_encoder.h"
#include "ramcdb/figures.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// A version of any number of meshes that is ready to be put on a tip.
struct VersionDraft {
  struct MeshEdit {
    std::shared_ptr<const Snapshot::Impl> at;  ///< what it is coded on: the mesh as `roots` has it
    EncodedEdit edit;
  };
  std::vector<db::MeshRoot> roots;       ///< of all meshes, before the edits
  std::vector<MeshEdit> edits;           ///< of different meshes
  std::vector<db::ChangedCharts> taken;  ///< what `roots` has other than the tip
  VersionId second_parent;               ///< a version that is merged; 0 for none
};

/// Makes a version from the tip of a branch; none when there is nothing to publish.
using MakeDraft = std::function<std::optional<VersionDraft>(VersionId tip)>;

/// A mesh as a version of a branch has it. Throws conflict where it is not there.
[[nodiscard]] std::shared_ptr<const Snapshot::Impl> mesh_on_branch(const Snapshot::Impl& base, VersionId version,
                                                                   const std::string& branch);

/// Publishes a version on the tip of `options.branch`, or of `options.onto`: made without the writer's lock, and with
/// it where the tip moved twice meanwhile, so that it comes to an end. \param base where a branch `options.onto` begins
/// that is not there yet \param operation what the version's figures call it \param report gets the version; counts of
/// the edits for the version's figures are there when `make` returns
void publish_on_tip(const std::shared_ptr<db::Store>& store, VersionId base, const CommitOptions& options,
                    std::string_view operation, const std::string& attempt, const MakeDraft& make,
                    CommitReport& report);

/// Publishes an edit of one mesh as a version after the one that it is coded on, and on no branch: it can be had by its
/// number only.
[[nodiscard]] VersionId publish_nameless(const Snapshot::Impl& at, EncodedEdit edit, const CommitOptions& options);

}  // namespace ramcdb::detail
