#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "api/region_file.h"
#include "db/store.h"
#include "ramcdb/repository.h"

namespace ramcdb::detail {

/// Region -> file and sidecar: see Repository::checkout_file. \param lock that was taken for it; 0 for none
CheckoutReport checkout_region(db::Store& store, const std::filesystem::path& repository, const Snapshot& snapshot,
                               const std::vector<ChartId>& charts, const std::filesystem::path& file,
                               const FileOptions& options, std::uint32_t lock);

/// Throws invalid_argument for a file that exists and may hold somebody's work, unless `options` say so.
void refuse_to_overwrite(const std::filesystem::path& file, const FileOptions& options);

/// What reading cost and the file became, into a report.
void add_costs(CheckoutReport& report, const ReadCost& cost, const WrittenRegion& written);

/// Whole mesh -> file: see Repository::export_mesh.
CheckoutReport export_mesh(const Snapshot& snapshot, const std::filesystem::path& file, const FileOptions& options);

[[nodiscard]] ChangeReport status_of_file(const std::shared_ptr<db::Store>& store, const std::filesystem::path& file,
                                          const std::filesystem::path& heatmap = {});

CommitReport commit_file(const std::shared_ptr<db::Store>& store, const std::filesystem::path& file,
                         const CommitOptions& options);

}  // namespace ramcdb::detail
