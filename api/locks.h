#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "db/store.h"
#include "ramcdb/names.h"
#include "ramcdb/snapshot.h"

/// Advisory locks: what the public calls do.
namespace ramcdb::detail {

/// Throws conflict, naming owners, charts and when they end, where others than `owner` have locked any of `charts`
/// (ascending). A commit asks this while it holds the writer lock, with all charts that it changes.
void refuse_locked(db::Store& store, MeshId mesh, std::span<const ChartId> charts, const std::string& owner);

/// Whether others than `owner` have locked a chart.
[[nodiscard]] bool is_locked(db::Store& store, MeshId mesh, ChartId chart, const std::string& owner);

/// Throws conflict where others have locked charts, unless `options.steal`.
[[nodiscard]] LockReport lock_charts(const std::shared_ptr<db::Store>& store, const Snapshot::Impl& at,
                                     const std::vector<ChartId>& charts, const LockOptions& options);

/// Throws not_found where nothing is locked of what is named, conflict where others hold it and not `force`.
[[nodiscard]] std::vector<LockInfo> unlock(const std::shared_ptr<db::Store>& store, const db::LockSelection& which,
                                           const std::string& owner, bool force);

/// Gives a checkout's lock back, if it still holds: its work is committed. Never fails: it ends by itself anyway.
void release_lock(db::Store& store, std::uint32_t id) noexcept;

[[nodiscard]] std::vector<LockInfo> all_locks(const std::shared_ptr<db::Store>& store);

/// Those on any of these charts, each cut down to them, whoever holds them.
[[nodiscard]] std::vector<LockInfo> locks_on(const std::shared_ptr<db::Store>& store, MeshId mesh,
                                             std::span<const ChartId> charts);

}  // namespace ramcdb::detail
