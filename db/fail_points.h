#pragma once

#include <functional>
#include <string_view>

/// Named places on the way of a commit where tests let it fail. Without a hook they do nothing.
///
///     writer.locked        the writer lock is held, nothing is written
///     blobs.flushed        a part of the blobs is durable, on the pending list
///     blobs.before         before the last LMDB transaction
///     blobs.committed      all blobs and the commit record are durable, no row
///     row.before_commit    the row is written, its transaction is open
///     row.committed        the version is published, nobody knows yet
///     recovery.begin       a crash's leftovers were found
///     recovery.deleted     they are gone
///     names.locked         the writer lock is held for a change of branches, tags or chart locks
///     names.before_commit  the change is made, its transaction is open
///     names.committed      it is durable, nobody knows yet
namespace ramcdb::db {

using FailHook = std::function<void(std::string_view point)>;

/// For tests, before other threads run: what to call at each point. An empty function takes the hook away.
void set_fail_hook(FailHook hook);

void fail_point(std::string_view name);

}  // namespace ramcdb::db
