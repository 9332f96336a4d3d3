#include "api/locks.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "api/chart_text.h"
#include "api/page_index.h"
#include "api/snapshot_impl.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

constexpr std::int64_t kMicroseconds = 1'000'000;
constexpr std::int64_t kMostSeconds = 3650LL * 24 * 3600;

/// Wall-clock time: locks must end across restarts and machines.
std::int64_t now_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

/// To the minute; from the year 2500 on a clock was wrong, and no more is said.
std::string time_text(std::int64_t time_us) {
  const std::int64_t seconds = time_us / kMicroseconds;
  if (seconds < 0 || seconds > 16'725'225'600) return "a time far away";
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(static_cast<std::time_t>(seconds)));
}

std::string holder_text(const db::ChartLock& lock) {
  return fmt::format("{} {} by {} until {}{}", lock.charts.size() == 1 ? "chart" : "charts", chart_text(lock.charts),
                     lock.owner, time_text(lock.expires_us), lock.reason.empty() ? "" : ", " + lock.reason);
}

std::string holders_text(const std::vector<db::ChartLock>& locks) {
  std::string text;
  for (const db::ChartLock& lock : locks) text += (text.empty() ? "" : "; ") + holder_text(lock);
  return text;
}

/// Names and index pages of the meshes that locks speak of, as of the branches' tips.
class Tips {
 public:
  explicit Tips(const std::shared_ptr<db::Store>& store) : store_(store), refs_(store->refs()) {}

  [[nodiscard]] LockInfo info_of(const db::ChartLock& lock) {
    LockInfo info{lock.id, {}, lock.charts, {}, lock.owner, lock.reason, lock.branch, lock.taken_us, lock.expires_us};
    const auto root = root_of(lock);
    info.mesh = root ? root->name : fmt::format("#{}", lock.mesh.value);
    if (!root) {
      info.gone = info.charts;
      return info;
    }
    const PageIndex pages(store_, *root);
    for (const ChartId id : info.charts)
      if (!pages.leaf_of(id)) info.gone.push_back(id);
    return info;
  }

 private:
  /// On the lock's branch, or on main where that is gone.
  [[nodiscard]] std::optional<db::MeshRoot> root_of(const db::ChartLock& lock) {
    for (const std::string& branch : {lock.branch, std::string("main")})
      for (const db::Ref& ref : refs_)
        if (ref.name == branch)
          for (db::MeshRoot& root : store_->roots(store_->resolve(branch)))
            if (root.mesh == lock.mesh) return std::move(root);
    return std::nullopt;
  }

  std::shared_ptr<db::Store> store_;
  std::vector<db::Ref> refs_;
};

std::vector<LockInfo> infos_of(const std::shared_ptr<db::Store>& store, const std::vector<db::ChartLock>& locks) {
  std::vector<LockInfo> infos;
  if (locks.empty()) return infos;
  Tips tips(store);
  for (const db::ChartLock& lock : locks) infos.push_back(tips.info_of(lock));
  return infos;
}

}  // namespace

void refuse_locked(db::Store& store, MeshId mesh, std::span<const ChartId> charts, const std::string& owner) {
  const auto others = store.locks_against(mesh, charts, owner, now_us());
  if (others.empty()) return;
  throw Error(Errc::conflict, "others have locked what this changes, nothing was written", holders_text(others),
              "ask them, wait, or commit with --ignore-locks");
}

bool is_locked(db::Store& store, MeshId mesh, ChartId chart, const std::string& owner) {
  return !store.locks_against(mesh, std::span(&chart, 1), owner, now_us()).empty();
}

LockReport lock_charts(const std::shared_ptr<db::Store>& store, const Snapshot::Impl& at,
                       const std::vector<ChartId>& charts, const LockOptions& options) {
  if (options.owner.empty()) throw Error(Errc::invalid_argument, "a lock needs an owner", {}, "name one with --owner");
  if (options.seconds < 1 || options.seconds > kMostSeconds)
    throw Error(Errc::invalid_argument, "a lock lasts between a second and ten years", {}, "say --for 2h");
  db::ChartLock wanted{0, at.root().mesh, charts, options.owner, options.reason, options.branch, now_us(), 0};
  wanted.expires_us = wanted.taken_us + options.seconds * kMicroseconds;
  const auto taken = store->lock(wanted, options.steal);
  if (!taken.done)
    throw Error(Errc::conflict, "others have locked what this would lock", holders_text(taken.others),
                "ask them, wait, or take it over with --steal");
  return {infos_of(store, {taken.lock}).front(), infos_of(store, taken.others)};
}

std::vector<LockInfo> unlock(const std::shared_ptr<db::Store>& store, const db::LockSelection& which,
                             const std::string& owner, bool force) {
  const auto result = store->unlock(which, owner, force, now_us());
  if (result.released.empty() && !result.others.empty() && (which.id != 0 || which.mesh))
    throw Error(Errc::conflict, fmt::format("that is not locked by {}", owner), holders_text(result.others),
                "ask them, or --force");
  if (result.released.empty() && which.id != 0)
    throw Error(Errc::not_found, fmt::format("there is no lock {}", which.id), {}, "`ramcdb locks REPO` lists them");
  if (result.released.empty() && which.mesh)
    throw Error(Errc::not_found, "none of these charts is locked", "charts " + chart_text(which.charts),
                "`ramcdb locks REPO` lists the locks");
  return infos_of(store, result.released);
}

void release_lock(db::Store& store, std::uint32_t id) noexcept {
  if (id == 0) return;
  try {
    (void)store.unlock({id, {}, {}}, {}, true, now_us());
  } catch (const std::exception&) {
    // The commit that it was for is done.
  }
}

std::vector<LockInfo> all_locks(const std::shared_ptr<db::Store>& store) {
  return infos_of(store, store->locks(now_us()));
}

std::vector<LockInfo> locks_on(const std::shared_ptr<db::Store>& store, MeshId mesh, std::span<const ChartId> charts) {
  return infos_of(store, store->locks_against(mesh, charts, {}, now_us()));  // nobody has an empty name
}

}  // namespace ramcdb::detail
