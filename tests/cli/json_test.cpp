#include "tests/cli/scene.h"

/// The keys that scripts rely on, word for word and in order; more may follow them.
namespace ramcdb::test {
namespace {

using Keys = std::vector<std::string>;

const Keys kByteKeys = {"wire_net",   "wires",  "connectivity", "geometry", "chart_headers",
                        "attributes", "tables", "payload",      "store"};
const Keys kInfoKeys = {"mesh",       "revision",  "vertices",   "faces",          "charts",
                        "wires",      "corners",   "components", "boundary_loops", "nonmanifold_edges",
                        "lattice",    "max_error", "profile",    "bytes",          "bits_per_vertex",
                        "chart_faces"};
const Keys kCheckoutKeys = {"revision", "charts", "faces", "vertices", "bytes_read", "blobs_read", "seconds"};
const Keys kStatusKeys = {
    "base",      "tip",  "charts_touched", "vertices_moved", "vertices_added", "vertices_removed", "max_displacement",
    "conflicts", "clean"};

Keys keys_of(const nlohmann::ordered_json& json) {
  Keys keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

void expect_starts_with(const nlohmann::ordered_json& json, const Keys& expected) {
  Keys keys = keys_of(json);
  ASSERT_GE(keys.size(), expected.size());
  keys.resize(expected.size());
  EXPECT_EQ(keys, expected);
}

/// Runs with --json, wants success and one object.
nlohmann::ordered_json json_of(Arguments arguments) {
  arguments.emplace_back("--json");
  const Outcome outcome = run_ramcdb(arguments);
  expect_done(outcome);
  return only_object(outcome.out);
}

class Json : public SceneTest {};

TEST_F(Json, Init) {
  const auto json = json_of({"init", path("other.ramcdb")});
  EXPECT_EQ(keys_of(json), (Keys{"repository", "id"}));
}

TEST_F(Json, Info) {
  const auto json = json_of({"info", repo_});
  expect_starts_with(json, kInfoKeys);
  EXPECT_EQ(keys_of(json["lattice"]), (Keys{"step", "origin", "lossless"}));
  EXPECT_EQ(json["lattice"]["origin"].size(), 3U);
  EXPECT_EQ(keys_of(json["bytes"]), kByteKeys);
  EXPECT_EQ(keys_of(json["bits_per_vertex"]), kByteKeys);
  EXPECT_EQ(keys_of(json["chart_faces"]), (Keys{"min", "median", "p95", "max"}));
  EXPECT_EQ(json["vertices"], 3721);
  EXPECT_EQ(json["faces"], 7200);
  EXPECT_EQ(json["profile"], "dense");
  EXPECT_DOUBLE_EQ(json["bits_per_vertex"]["payload"].get<double>(), json["bytes"]["payload"].get<double>() * 8 / 3721);
}

TEST_F(Json, PayloadIsTheSumOfItsKinds) {
  const auto bytes = json_of({"info", repo_})["bytes"];
  std::uint64_t sum = 0;
  for (const auto& [kind, n] : bytes.items())
    if (kind != "payload" && kind != "store") sum += n.get<std::uint64_t>();
  EXPECT_EQ(bytes["payload"], sum);
  EXPECT_GE(bytes["store"], bytes["payload"]);
}

TEST_F(Json, Import) {
  const auto json = json_of({"import", repo_, path("wavy.ply"), "--name", "again"});
  expect_starts_with(json, kInfoKeys);
  for (const char* key : {"dropped", "polygons_as_fans", "vertices_welded", "measured_error", "seconds"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_LE(json["measured_error"].get<double>(), json["max_error"].get<double>());
}

TEST_F(Json, Ls) {
  const auto json = json_of({"ls", repo_});
  ASSERT_EQ(json["meshes"].size(), 1U);
  EXPECT_EQ(json["meshes"][0]["name"], "wavy");
  EXPECT_EQ(json["meshes"][0]["faces"], 7200);
}

TEST_F(Json, Charts) {
  const auto json = json_of({"charts", repo_, "--all"});
  std::uint64_t faces = 0;
  for (const auto& chart : json["charts"]) faces += chart["faces"].get<std::uint64_t>();
  EXPECT_EQ(faces, 7200U);
  EXPECT_EQ(json["charts"].size(), json_of({"info", repo_})["charts"].get<std::size_t>());
  expect_starts_with(json["charts"][0], {"id", "faces", "vertices"});
}

TEST_F(Json, CheckoutAndExport) {
  const auto part = json_of({"checkout", repo_, "--charts", "1,2", "-o", path("part.ply")});
  expect_starts_with(part, kCheckoutKeys);
  EXPECT_EQ(part["charts"], 2);
  EXPECT_GE(part["pages_read"], 1) << "also those that finding the charts took";
  EXPECT_LE(part["pages_read"], 4);
  const auto whole = json_of({"export", repo_, "-o", path("whole.ply")});
  expect_starts_with(whole, kCheckoutKeys);
  EXPECT_EQ(whole["vertices"], 3721);
  EXPECT_GT(whole["bytes_read"], part["bytes_read"]);
}

TEST_F(Json, StatusAndDiffOfAFile) {
  const std::string file = checked_out("middle.ply");
  auto status = json_of({"status", file});
  expect_starts_with(status, kStatusKeys);
  EXPECT_EQ(status["clean"], true);
  edit(file);
  status = json_of({"status", file});
  EXPECT_EQ(status["clean"], false);
  EXPECT_EQ(status["vertices_moved"], 1);
  EXPECT_TRUE(status["conflicts"].is_array());
  const auto diff = json_of({"diff", file});
  expect_starts_with(diff, kStatusKeys);
  EXPECT_EQ(diff["per_chart"].size(), status["charts_touched"].get<std::size_t>());
}

TEST_F(Json, CommitLogShowAndDiffOfVersions) {
  const std::string file = checked_out("middle.ply");
  edit(file);
  const auto commit = json_of({"commit", file, "-m", "lift"});
  expect_starts_with(commit, {"revision", "parent", "charts_touched", "charts_reencoded", "charts_added",
                              "charts_removed", "wires_reencoded", "ranges_expanded", "vertices_moved",
                              "vertices_added", "vertices_removed", "max_displacement", "bytes_written", "seconds"});
  EXPECT_EQ(commit["revision"], 2);
  EXPECT_EQ(commit["parent"], 1);
  EXPECT_EQ(commit["vertices_moved"], 1);

  const auto log = json_of({"log", repo_});
  ASSERT_EQ(log["revisions"].size(), 2U);
  expect_starts_with(log["revisions"][0],
                     {"id", "parents", "branch", "author", "time", "message", "meshes", "charts_touched"});
  EXPECT_EQ(log["revisions"][0]["parents"], nlohmann::ordered_json::array({1}));
  EXPECT_EQ(log["revisions"][0]["message"], "lift");
  EXPECT_EQ(log["revisions"][1]["author"], "Ada");

  const auto show = json_of({"show", repo_, "HEAD"});
  EXPECT_EQ(show["id"], 2);
  EXPECT_EQ(show["changes"][0]["mesh"], "wavy");
  EXPECT_EQ(show["bytes_written"], commit["bytes_written"]);

  const auto diff = json_of({"diff", repo_, "1", "2"});
  EXPECT_EQ(diff["vertices_moved"], 1);
  EXPECT_EQ(diff["added"].size() + diff["removed"].size(), 0U);
}

TEST_F(Json, Verify) {
  const auto full = json_of({"verify", repo_});
  EXPECT_EQ(keys_of(full), (Keys{"ok", "objects", "decoded_charts", "problems"}));
  EXPECT_EQ(full["ok"], true);
  EXPECT_EQ(full["decoded_charts"], json_of({"info", repo_})["charts"]);
  EXPECT_EQ(json_of({"verify", repo_, "--quick"})["decoded_charts"], 0);
}

TEST_F(Json, TextThatIsNotUtf8DoesNotBreakIt) {
  const std::string file = checked_out("middle.ply");
  edit(file);
  expect_done(run_ramcdb({"commit", file, "-m", "caf\xe9 \"quoted\"\nsecond line", "-q"}));
  EXPECT_EQ(json_of({"log", repo_})["revisions"][0]["message"], "caf\xef\xbf\xbd \"quoted\"\nsecond line");
}

}  // namespace
}  // namespace ramcdb::test
