#include "db/catalogue.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "db/fail_points.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

constexpr std::int64_t kApplicationId = 0x52414D43;  // "RAMC"
constexpr std::int64_t kSchemaVersion = 1;

constexpr const char* kSchema = R"(
  CREATE TABLE repository(id TEXT NOT NULL);
  CREATE TABLE version(
    id INTEGER PRIMARY KEY,
    branch TEXT NOT NULL,
    author TEXT NOT NULL,
    message TEXT NOT NULL,
    time_us INTEGER NOT NULL,
    attempt TEXT NOT NULL UNIQUE,
    figures TEXT NOT NULL,
    parents TEXT NOT NULL,
    roots BLOB NOT NULL,
    changed BLOB NOT NULL);
)";

constexpr const char* kInfoColumns = "id, branch, author, message, time_us, attempt, figures, parents";

std::string parents_text(const std::vector<VersionId>& parents) {
  nlohmann::json list = nlohmann::json::array();
  for (const VersionId p : parents) list.push_back(p.value);
  return list.dump();
}

std::vector<VersionId> parents_of(const std::string& text) {
  try {
    std::vector<VersionId> parents;
    for (const auto& p : nlohmann::json::parse(text)) parents.emplace_back(p.get<std::uint32_t>());
    return parents;
  } catch (const nlohmann::json::exception&) {
    throw Error(Errc::corrupt, "a version's list of parents is damaged", text, "run `ramcdb verify`");
  }
}

VersionInfo info_of(const Statement& row) {
  VersionInfo info;
  info.id = VersionId(static_cast<std::uint32_t>(row.integer(0)));
  info.branch = row.text(1);
  info.author = row.text(2);
  info.message = row.text(3);
  info.time_us = row.integer(4);
  info.attempt = row.text(5);
  info.figures = row.text(6);
  info.parents = parents_of(row.text(7));
  return info;
}

}  // namespace

void Catalogue::create(const std::filesystem::path& file, std::string_view repository_id) {
  Database db(file, Database::Mode::create);
  // The smallest pages: a catalogue of a few versions fits one block of the disk.
  db.run("PRAGMA page_size = 512; PRAGMA journal_mode = WAL");
  DatabaseTransaction transaction(db);
  db.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", kApplicationId, kSchemaVersion));
  for (const char* schema : {kSchema, RefTable::kSchema, LockTable::kSchema}) db.run(schema);
  db.prepare("INSERT INTO repository(id) VALUES(?)").bind(1, repository_id).step();
  transaction.commit();
  db.checkpoint();
}

Catalogue::Catalogue(const std::filesystem::path& file, Database::Mode mode) : database_(file, mode) {
  const std::int64_t schema = database_.integer("PRAGMA user_version");
  if (database_.integer("PRAGMA application_id") != kApplicationId)
    throw Error(Errc::corrupt, "the catalogue is not one of RAMCdb", file.string(), "restore it from a backup");
  if (schema > kSchemaVersion)
    throw Error(Errc::unsupported_version, fmt::format("the catalogue has format {}", schema), file.string(),
                fmt::format("this program knows formats up to {}: use a newer one", kSchemaVersion));
}

std::string Catalogue::repository_id() { return database_.text("SELECT id FROM repository"); }

VersionId Catalogue::newest() {
  return VersionId(static_cast<std::uint32_t>(database_.integer("SELECT coalesce(max(id), 0) FROM version")));
}

std::optional<VersionInfo> Catalogue::version(VersionId id) {
  Statement s = database_.prepare(fmt::format("SELECT {} FROM version WHERE id = ?", kInfoColumns));
  s.bind(1, std::int64_t{id.value});
  if (!s.step()) return std::nullopt;
  return info_of(s);
}

std::optional<CommitRecord> Catalogue::record(VersionId id) {
  auto info = version(id);
  if (!info) return std::nullopt;
  return CommitRecord{std::move(*info), roots(id), changed(id)};
}

Buffer Catalogue::blob_of(VersionId id, std::string_view column) {
  Statement s = database_.prepare(fmt::format("SELECT {} FROM version WHERE id = ?", column));
  s.bind(1, std::int64_t{id.value});
  if (!s.step()) throw Error(Errc::not_found, fmt::format("there is no version {}", id.value), {}, "see `ramcdb log`");
  return s.blob(0);
}

std::vector<MeshRoot> Catalogue::roots(VersionId id) { return decode_roots(blob_of(id, "roots")); }

std::vector<ChangedCharts> Catalogue::changed(VersionId id) { return decode_changed(blob_of(id, "changed")); }

std::vector<VersionId> Catalogue::all_versions() {
  std::vector<VersionId> versions;
  for (Statement s = database_.prepare("SELECT id FROM version ORDER BY id"); s.step();)
    versions.emplace_back(static_cast<std::uint32_t>(s.integer(0)));
  return versions;
}

std::optional<VersionId> Catalogue::published_by(std::string_view attempt) {
  Statement s = database_.prepare("SELECT id FROM version WHERE attempt = ?");
  s.bind(1, attempt);
  if (!s.step()) return std::nullopt;
  return VersionId(static_cast<std::uint32_t>(s.integer(0)));
}

std::vector<VersionId> Catalogue::parents(VersionId id) {
  Statement s = database_.prepare("SELECT parents FROM version WHERE id = ?");
  s.bind(1, std::int64_t{id.value});
  return s.step() ? parents_of(s.text(0)) : std::vector<VersionId>{};
}

void Catalogue::insert(const CommitRecord& record) {
  const VersionInfo& info = record.info;
  Statement s = database_.prepare(
      fmt::format("INSERT INTO version({}, roots, changed) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)", kInfoColumns));
  s.bind(1, std::int64_t{info.id.value}).bind(2, info.branch).bind(3, info.author).bind(4, info.message);
  s.bind(5, info.time_us).bind(6, info.attempt).bind(7, info.figures).bind(8, parents_text(info.parents));
  s.bind(9, Bytes(encode_roots(record.roots))).bind(10, Bytes(encode_changed(record.changed)));
  s.step();
}

void Catalogue::publish(const CommitRecord& record, VersionId expected_tip) {
  DatabaseTransaction transaction(database_);
  const bool nameless = record.info.branch.empty();
  const VersionId tip = nameless ? VersionId() : refs().tip(record.info.branch);
  if (tip != expected_tip)
    throw Error(Errc::conflict, fmt::format("branch {} moved to version {}", record.info.branch, tip.value),
                fmt::format("expected version {}", expected_tip.value), "check out again");
  insert(record);
  if (!nameless) refs().set({record.info.branch, false, record.info.id});
  locks().sweep(record.info.time_us);
  fail_point("row.before_commit");
  transaction.commit();
}

std::vector<std::string> Catalogue::integrity_problems() {
  std::vector<std::string> problems;
  for (Statement s = database_.prepare("PRAGMA integrity_check"); s.step();)
    if (s.text(0) != "ok") problems.push_back(s.text(0));
  return problems;
}

}  // namespace ramcdb::db
