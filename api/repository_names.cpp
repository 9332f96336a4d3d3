#include <algorithm>

#include "api/locks.h"
#include "api/repository_impl.h"
#include "api/snapshot_impl.h"

/// Repository's calls about branches, tags and locks.
namespace ramcdb {

std::vector<Branch> Repository::branches() const {
  const auto& store = impl_->store();
  const VersionId main = store->tip("main");
  std::vector<Branch> branches;
  for (const db::Ref& ref : store->refs())
    if (!ref.is_tag)
      branches.push_back({ref.name, ref.version, store->only_in(ref.version, {main}).size(),
                          store->only_in(main, {ref.version}).size()});
  return branches;
}

std::vector<Tag> Repository::tags() const {
  std::vector<Tag> tags;
  for (const db::Ref& ref : impl_->store()->refs())
    if (ref.is_tag) tags.push_back({ref.name, ref.version});
  return tags;
}

std::vector<VersionId> Repository::create_branch(std::string_view name, std::string_view at, bool force) {
  const auto store = impl_->store_for_writing();
  return store->create_branch(name, store->resolve(at), force);
}

std::vector<VersionId> Repository::delete_branch(std::string_view name, bool force) {
  return impl_->store_for_writing()->delete_branch(name, force);
}

void Repository::rename_branch(std::string_view from, std::string_view to) {
  impl_->store_for_writing()->rename_branch(from, to);
}

std::vector<VersionId> Repository::create_tag(std::string_view name, std::string_view at, bool force) {
  const auto store = impl_->store_for_writing();
  return store->create_tag(name, store->resolve(at), force);
}

std::vector<VersionId> Repository::delete_tag(std::string_view name) {
  return impl_->store_for_writing()->delete_tag(name);
}

LockReport Repository::lock(const Snapshot& snapshot, const std::vector<ChartId>& charts, const LockOptions& options) {
  return detail::lock_charts(impl_->store_for_writing(), snapshot.impl(), charts, options);
}

std::vector<LockInfo> Repository::unlock(const Snapshot& snapshot, const std::vector<ChartId>& charts,
                                         const std::string& owner, bool force) {
  return detail::unlock(impl_->store_for_writing(), {0, snapshot.impl().root().mesh, charts}, owner, force);
}

std::vector<LockInfo> Repository::unlock(std::uint32_t id, const std::string& owner, bool force) {
  if (id == 0) throw Error(Errc::not_found, "there is no lock 0", {}, "`ramcdb locks REPO` lists them");
  return detail::unlock(impl_->store_for_writing(), {id, {}, {}}, owner, force);
}

std::vector<LockInfo> Repository::unlock_all(const std::string& owner, bool force) {
  return detail::unlock(impl_->store_for_writing(), {}, owner, force);
}

std::vector<LockInfo> Repository::locks() const { return detail::all_locks(impl_->store()); }

}  // namespace ramcdb
