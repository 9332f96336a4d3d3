#include "db/ref_table.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

constexpr const char* kColumns = "name, kind, version, checksum";

const char* kind_of(const Ref& ref) { return ref.is_tag ? "tag" : "branch"; }

std::int64_t checksum_of(const Ref& ref) {
  std::string text = ref.name;
  text.append(1, '\0').append(kind_of(ref)).append(1, '\0').append(std::to_string(ref.version.value));
  return static_cast<std::int64_t>(XXH3_64bits(text.data(), text.size()));
}

Ref ref_of(const Statement& row) {
  return {row.text(0), row.text(1) == "tag", VersionId(static_cast<std::uint32_t>(row.integer(2)))};
}

bool is_intact(const Statement& row) { return checksum_of(ref_of(row)) == row.integer(3); }

bool has_version(Database& database, VersionId version) {
  return database.prepare("SELECT 1 FROM version WHERE id = ?").bind(1, std::int64_t{version.value}).step();
}

std::string missing_text(const Ref& ref) {
  return fmt::format("{} {} names version {}, which is not there", kind_of(ref), ref.name, ref.version.value);
}

}  // namespace

std::vector<Ref> RefTable::all() {
  std::vector<Ref> refs;
  for (Statement s = database_.prepare(fmt::format("SELECT {} FROM ref ORDER BY kind, name", kColumns)); s.step();)
    refs.push_back(ref_of(s));
  return refs;
}

std::optional<Ref> RefTable::find(std::string_view name) {
  Statement s = database_.prepare(fmt::format("SELECT {} FROM ref WHERE name = ?", kColumns));
  s.bind(1, name);
  if (!s.step()) return std::nullopt;
  Ref ref = ref_of(s);
  const std::string way_out = fmt::format("set it anew with `ramcdb {} REPO {} VERSION -f`", kind_of(ref), name);
  if (!is_intact(s))
    throw Error(Errc::corrupt, fmt::format("what {} {} names is damaged", kind_of(ref), name),
                fmt::format("it says version {}", ref.version.value), way_out);
  if (!has_version(database_, ref.version)) throw Error(Errc::corrupt, missing_text(ref), {}, way_out);
  return ref;
}

VersionId RefTable::tip(std::string_view branch) {
  const auto ref = find(branch);
  if (ref && ref->is_tag)
    throw Error(Errc::invalid_argument, fmt::format("{} is a tag", branch), {}, "versions are published on branches");
  return ref ? ref->version : VersionId();
}

void RefTable::set(const Ref& ref) {
  Statement s = database_.prepare(fmt::format("INSERT OR REPLACE INTO ref({}) VALUES(?, ?, ?, ?)", kColumns));
  s.bind(1, ref.name).bind(2, kind_of(ref)).bind(3, std::int64_t{ref.version.value}).bind(4, checksum_of(ref));
  s.step();
}

void RefTable::remove(std::string_view name) {
  database_.prepare("DELETE FROM ref WHERE name = ?").bind(1, name).step();
}

std::vector<std::string> RefTable::problems() {
  std::vector<std::string> problems;
  for (Statement s = database_.prepare(fmt::format("SELECT {} FROM ref ORDER BY kind, name", kColumns)); s.step();) {
    const Ref ref = ref_of(s);
    if (!is_intact(s))
      problems.push_back(
          fmt::format("what {} {} names is damaged: it says version {}", kind_of(ref), ref.name, ref.version.value));
    if (!has_version(database_, ref.version)) problems.push_back(missing_text(ref));
  }
  return problems;
}

}  // namespace ramcdb::db
