#include "tests/api/numbered_edits.h"

/// Branches and tags through the public library.
namespace ramcdb::test {
namespace {

template <class Run>
void expect_refused(Errc code, const std::string& part, Run&& run) {
  try {
    run();
    ADD_FAILURE() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(static_cast<int>(e.code()), static_cast<int>(code)) << e.what();
    EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
  }
}

/// Lifts the inner vertices of a chart on a branch.
CommitReport lift(Repository& repository, const std::string& branch, std::uint32_t chart,
                  const std::string& author = "ada") {
  auto edit = repository.begin_edit({}, branch);
  Patch& patch = edit.checkout({{OfCharts{{ChartId(chart)}}}, 0});
  for (const auto v : patch.mesh().all_vertices())
    if (!patch.mesh().is_boundary(v))
      patch.mesh().set_point(v, patch.mesh().point(v) + Patch::Mesh::Point(0, 0, edit.base().lattice().step));
  CommitOptions options;
  options.message = "lift";
  options.branch = branch;
  options.author = author;
  return edit.commit(options);
}

TEST(Names, EveryReadingCallTakesABranchOrATag) {
  TempRepository repo(terrain(40, 40));
  (void)repo->create_branch("side");
  (void)repo->create_tag("start", "1");
  EXPECT_EQ(lift(*repo, "side", 2).revision, VersionId(2));
  EXPECT_EQ(lift(*repo, "main", 3).revision, VersionId(3));
  EXPECT_EQ(lift(*repo, "side", 2).revision, VersionId(4));

  EXPECT_EQ(repo->resolve("side"), VersionId(4));
  EXPECT_EQ(repo->resolve("side~2"), VersionId(1));
  EXPECT_EQ(repo->resolve("start"), VersionId(1));
  EXPECT_EQ(repo->snapshot({}, "side").info().revision, VersionId(4));
  EXPECT_EQ(repo->meshes("side").size(), 1U);
  EXPECT_EQ(repo->log("side").size(), 3U);
  EXPECT_EQ(repo->log("main").size(), 2U);
  EXPECT_EQ(repo->show("side~").id, VersionId(2));
  const DiffReport diff = repo->diff(repo->snapshot({}, "main"), repo->snapshot({}, "side"));
  EXPECT_EQ(diff.changed, (std::vector<ChartId>{ChartId(2), ChartId(3)}));
  EXPECT_EQ(repo->diff(repo->snapshot({}, "start"), repo->snapshot({}, "side")).changed, std::vector{ChartId(2)});
  const auto charts = repo->snapshot({}, "side").find({{OfCharts{{ChartId(2)}}}, 0});
  EXPECT_EQ(repo->checkout_file(repo->snapshot({}, "side"), charts, repo / "part.ply", {}).revision, VersionId(4));
  EXPECT_EQ(repo->export_mesh(repo->snapshot({}, "side"), repo / "side.ply", {}).revision, VersionId(4));
  EXPECT_EQ(face_set_of_file(repo->snapshot().lattice(), repo / "side.ply"),
            face_set(whole(repo->snapshot({}, "side"))));
  EXPECT_NE(face_set(whole(repo->snapshot({}, "main"))), face_set(whole(repo->snapshot({}, "side"))));
  EXPECT_TRUE(repo->verify({}).ok());
}

TEST(Names, BranchesSayHowFarTheyAreFromMain) {
  TempRepository repo(terrain(20, 20));
  (void)repo->create_branch("side");
  (void)lift(*repo, "side", 1);
  (void)lift(*repo, "side", 1);
  (void)lift(*repo, "main", 1);
  (void)repo->create_branch("old", "1");
  const auto branches = repo->branches();
  ASSERT_EQ(branches.size(), 3U);
  const auto expect = [&](std::size_t i, const char* name, std::uint32_t tip, std::uint64_t ahead,
                          std::uint64_t behind) {
    EXPECT_EQ(branches[i].name, name);
    EXPECT_EQ(branches[i].tip, VersionId(tip));
    EXPECT_EQ(branches[i].ahead, ahead) << name;
    EXPECT_EQ(branches[i].behind, behind) << name;
  };
  expect(0, "main", 4, 0, 0);
  expect(1, "old", 1, 0, 1);
  expect(2, "side", 3, 2, 1);
  (void)repo->create_tag("a", "side");
  (void)repo->create_tag("b", "side");
  EXPECT_EQ(repo->tags().size(), 2U);
  const auto refs = repo->show("3").refs;
  ASSERT_EQ(refs.size(), 3U);
  EXPECT_EQ(refs[0].name, "side");
  EXPECT_FALSE(refs[0].is_tag);
  EXPECT_EQ(refs[2].name, "b");
  EXPECT_TRUE(refs[2].is_tag);
  EXPECT_TRUE(repo->log("3")[1].refs.empty());
}

TEST(Names, ACommitToABranchWithoutTheMeshIsRefused) {
  TempRepository repo(terrain(20, 20));
  (void)repo->create_branch("before");
  ImportOptions options;
  options.name = "second";
  options.chart_faces = 200;
  (void)repo->import(repo / "input.ply", options);
  const Snapshot second = repo->snapshot("second");
  (void)repo->checkout_file(second, second.find({{WholeMesh{}}, 0}), repo / "part.ply", {});
  mesh_file::MeshData data = mesh_file::read_mesh(repo / "part.ply");
  for (Point& p : data.positions) p.z += 0.25;
  write_data(data, repo / "part.ply", mesh_file::Scalar::float32);
  CommitOptions commit = message("lift");
  for (const char* branch : {"before", "nobody"}) {
    commit.branch = branch;
    expect_refused(Errc::conflict, std::string("is not on branch ") + branch,
                   [&] { (void)repo->commit_file(repo / "part.ply", commit); });
  }
  EXPECT_EQ(repo->branches().size(), 2U);
  EXPECT_EQ(repo->log().size(), 2U);
}

TEST(Names, AnImportToANewBranchBeginsFromMain) {
  TempRepository repo(terrain(20, 20));
  ImportOptions options;
  options.name = "second";
  options.branch = "scans";
  EXPECT_EQ(repo->import(repo / "input.ply", options).info.revision, VersionId(2));
  EXPECT_EQ(repo->meshes("scans").size(), 2U);
  EXPECT_EQ(repo->meshes("main").size(), 1U);
  EXPECT_EQ(repo->resolve("scans~"), VersionId(1));
  options.name = "mesh";
  options.branch = "other";
  expect_refused(Errc::invalid_argument, "already holds a mesh",
                 [&] { (void)repo->import(repo / "input.ply", options); });
  for (const char* name : {"17", "a b", "HEAD"}) {
    options.branch = name;
    options.name = "third";
    expect_refused(Errc::invalid_argument, "is no name", [&] { (void)repo->import(repo / "input.ply", options); });
  }
}

}  // namespace
}  // namespace ramcdb::test
