#include "db/lock_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "db/commit_record.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

Buffer encode_charts(MeshId mesh, const std::vector<ChartId>& charts) { return encode_changed({{mesh, charts}}); }

/// Nothing where the bytes are damaged, or another mesh's.
std::optional<std::vector<ChartId>> decode_charts(MeshId mesh, Bytes bytes) {
  try {
    auto changed = decode_changed(bytes);
    if (changed.size() == 1 && changed[0].mesh == mesh && !changed[0].charts.empty() &&
        std::is_sorted(changed[0].charts.begin(), changed[0].charts.end()))
      return std::move(changed[0].charts);
  } catch (const Error&) {
    // As below.
  }
  return std::nullopt;
}

MeshId mesh_of(const Statement& row) { return MeshId(static_cast<std::uint32_t>(row.integer(1))); }

}  // namespace

std::vector<ChartLock> LockTable::active(std::int64_t now_us) {
  std::vector<ChartLock> locks;
  Statement s = database_.prepare(
      "SELECT id, mesh, charts, owner, reason, branch, taken_us, expires_us FROM lock WHERE expires_us > ? "
      "ORDER BY id");
  s.bind(1, now_us);
  while (s.step())
    locks.push_back({static_cast<std::uint32_t>(s.integer(0)), mesh_of(s),
                     decode_charts(mesh_of(s), s.blob(2)).value_or(std::vector<ChartId>{}), s.text(3), s.text(4),
                     s.text(5), s.integer(6), s.integer(7)});
  return locks;
}

std::uint32_t LockTable::add(const ChartLock& lock) {
  Statement s = database_.prepare(
      "INSERT INTO lock(mesh, charts, owner, reason, branch, taken_us, expires_us) VALUES(?, ?, ?, ?, ?, ?, ?)");
  s.bind(1, std::int64_t{lock.mesh.value}).bind(2, Bytes(encode_charts(lock.mesh, lock.charts)));
  s.bind(3, lock.owner).bind(4, lock.reason).bind(5, lock.branch).bind(6, lock.taken_us).bind(7, lock.expires_us);
  s.step();
  return static_cast<std::uint32_t>(database_.integer("SELECT last_insert_rowid()"));
}

void LockTable::release(const ChartLock& lock, const std::vector<ChartId>& charts) {
  std::vector<ChartId> left;
  std::set_difference(lock.charts.begin(), lock.charts.end(), charts.begin(), charts.end(), std::back_inserter(left));
  if (left.empty()) {
    database_.prepare("DELETE FROM lock WHERE id = ?").bind(1, std::int64_t{lock.id}).step();
    return;
  }
  Statement s = database_.prepare("UPDATE lock SET charts = ? WHERE id = ?");
  s.bind(1, Bytes(encode_charts(lock.mesh, left))).bind(2, std::int64_t{lock.id}).step();
}

void LockTable::sweep(std::int64_t now_us) {
  database_.prepare("DELETE FROM lock WHERE expires_us <= ?").bind(1, now_us).step();
}

std::vector<std::string> LockTable::problems() {
  std::vector<std::string> problems;
  for (Statement s = database_.prepare("SELECT id, mesh, charts FROM lock ORDER BY id"); s.step();)
    if (!decode_charts(mesh_of(s), s.blob(2)))
      problems.push_back(fmt::format("the charts of lock {} are damaged", s.integer(0)));
  return problems;
}

std::vector<ChartId> held_of(const ChartLock& lock, const std::vector<ChartId>& charts) {
  std::vector<ChartId> held;
  std::set_intersection(lock.charts.begin(), lock.charts.end(), charts.begin(), charts.end(), std::back_inserter(held));
  return held;
}

}  // namespace ramcdb::db
