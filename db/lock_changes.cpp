#include <fmt/format.h>

#include <algorithm>

#include "db/store_impl.h"
#include "ramcdb/error.h"

/// How locks change: Store's lock and unlock. Each is one change_names() under the writer lock.
namespace ramcdb::db {
namespace {

/// Charts of one lock, cut down to those that somebody asks about.
struct Held {
  ChartLock lock;
  std::vector<ChartId> charts;
};

std::vector<ChartLock> cut_down(const std::vector<Held>& held) {
  std::vector<ChartLock> locks;
  for (const Held& h : held) {
    locks.push_back(h.lock);
    locks.back().charts = h.charts;
  }
  return locks;
}

std::vector<Held> holding(const std::vector<ChartLock>& locks, MeshId mesh, const std::vector<ChartId>& charts) {
  std::vector<Held> held;
  for (const ChartLock& lock : locks)
    if (lock.mesh == mesh)
      if (auto some = held_of(lock, charts); !some.empty()) held.push_back({lock, std::move(some)});
  return held;
}

std::vector<Held> selected(const std::vector<ChartLock>& locks, const LockSelection& which) {
  if (which.mesh) return holding(locks, which.mesh, which.charts);
  std::vector<Held> held;
  for (const ChartLock& lock : locks)
    if (which.id == 0 || which.id == lock.id) held.push_back({lock, lock.charts});
  return held;
}

}  // namespace

std::vector<ChartLock> StoreImpl::locks(std::int64_t now_us) {
  return with_catalogue([&](Catalogue& c) { return c.locks().active(now_us); });
}

std::vector<ChartLock> StoreImpl::locks_against(MeshId mesh, std::span<const ChartId> charts, std::string_view owner,
                                                std::int64_t now_us) {
  std::vector<Held> held = holding(locks(now_us), mesh, {charts.begin(), charts.end()});
  std::erase_if(held, [&](const Held& h) { return h.lock.owner == owner; });
  return cut_down(held);
}

Store::LockTaken StoreImpl::lock(const ChartLock& wanted, bool steal) {
  if (wanted.charts.empty() || wanted.owner.empty() || wanted.expires_us <= wanted.taken_us)
    throw Error(Errc::invalid_argument, "a lock needs charts, an owner and some time");
  return change_names([&](Catalogue& c) {
    c.locks().sweep(wanted.taken_us);
    std::vector<Held> others = holding(c.locks().active(wanted.taken_us), wanted.mesh, wanted.charts);
    std::erase_if(others, [&](const Held& h) { return h.lock.owner == wanted.owner; });
    LockTaken taken{wanted, cut_down(others)};
    taken.done = others.empty() || steal;
    if (!taken.done) return taken;
    for (const Held& h : others) c.locks().release(h.lock, h.charts);
    taken.lock.id = c.locks().add(wanted);
    return taken;
  });
}

Store::Unlocked StoreImpl::unlock(const LockSelection& which, std::string_view owner, bool force, std::int64_t now_us) {
  return change_names([&](Catalogue& c) {
    c.locks().sweep(now_us);
    const std::vector<Held> held = selected(c.locks().active(now_us), which);
    std::vector<Held> mine, others;
    for (const Held& h : held) (force || h.lock.owner == owner ? mine : others).push_back(h);
    Unlocked result{{}, cut_down(others)};
    const bool all = which.id == 0 && !which.mesh;
    if (!others.empty() && !all) return result;
    for (const Held& h : mine) c.locks().release(h.lock, h.charts);
    result.released = cut_down(mine);
    return result;
  });
}

}  // namespace ramcdb::db
