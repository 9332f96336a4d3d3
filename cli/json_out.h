#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/name_text.h"
#include "ramcdb/figures.h"

/// What `--json` prints, one function per kind of report. Scripts rely on the keys: add some, never rename one. Every
/// function returns one JSON object and a line end. Text that is not UTF-8 gets replacement characters.
namespace ramcdb::cli {

[[nodiscard]] std::string init_json(const std::filesystem::path& folder, const std::string& id);
[[nodiscard]] std::string import_json(const ImportReport& report);
[[nodiscard]] std::string info_json(const MeshInfo& info);
[[nodiscard]] std::string meshes_json(const std::vector<MeshSummary>& meshes, VersionId revision);
[[nodiscard]] std::string charts_json(const std::vector<ChartSummary>& charts, VersionId revision);
/// Of checkout and of export.
[[nodiscard]] std::string checkout_json(const CheckoutReport& report);
/// With a row per chart.
[[nodiscard]] std::string status_json(const ChangeReport& report);
/// Of `diff FILE`: the status.
[[nodiscard]] std::string diff_json(const ChangeReport& report);
/// Of `diff REPO REV1 REV2`.
[[nodiscard]] std::string diff_json(const DiffReport& report);
[[nodiscard]] std::string commit_json(const CommitReport& report);
[[nodiscard]] std::string merge_json(const MergeReport& report);
/// Of `import --into`: that of a commit, and what was found.
[[nodiscard]] std::string import_into_json(const ImportIntoReport& report);
[[nodiscard]] std::string repack_json(const RepackReport& report);
[[nodiscard]] std::string log_json(const std::vector<VersionRecord>& versions);
[[nodiscard]] std::string show_json(const VersionRecord& version);
[[nodiscard]] std::string branches_json(const std::vector<Branch>& branches);
[[nodiscard]] std::string tags_json(const std::vector<Tag>& tags);
[[nodiscard]] std::string name_change_json(const NameChange& change);
/// One object with the list under `key`.
[[nodiscard]] std::string locks_json(const std::vector<LockInfo>& locks, const char* key);
[[nodiscard]] std::string lock_json(const LockReport& report);
[[nodiscard]] std::string verify_json(const VerifyReport& report);

}  // namespace ramcdb::cli
