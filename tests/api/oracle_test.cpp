#include <cstdlib>
#include <iostream>
#include <optional>

#include "tests/api/oracle.h"

// Random edits of all kinds, each checked against a plain mesh to which the same was done. RAMCDB_ORACLE_STEPS makes
// sequences longer, RAMCDB_ORACLE_SEED others.
namespace ramcdb::test {
namespace {

struct OracleFamily {
  const char* name;
  TestMesh (*make)();
  std::uint32_t chart_faces;
  bool weird;  ///< edits may make places that are not manifold
};

unsigned from_environment(const char* name, unsigned otherwise) {
  const char* text = std::getenv(name);
  return text ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : otherwise;
}

mesh_file::MeshData colored(const TestMesh& mesh) {
  mesh_file::MeshData data;
  data.positions = mesh.positions;
  for (const Triangle& t : mesh.faces) data.corners.insert(data.corners.end(), t.begin(), t.end());
  Attribute color{{"color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color, {}, {}}, {}};
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (std::size_t i = 0; i < 3; ++i) color.values.push_back(static_cast<double>((v * (i + 1)) % 256));
  data.attributes = {color};
  return data;
}

void write_colored(const mesh_file::MeshData& data, const std::filesystem::path& file) {
  mesh_file::MeshOutput out;
  out.positions = data.positions;
  out.corners = data.corners;
  out.scalar = mesh_file::Scalar::float64;
  out.vertex_ids = data.vertex_ids;
  out.attributes = data.attributes;
  (void)mesh_file::write_mesh(file, mesh_file::format_of(file), out);
}

class Oracle {
 public:
  Oracle(const OracleFamily& family, unsigned seed)
      : family_(family), random_(seed), repository_(make(folder_)), colored_(seed % 2 == 0) {
    mesh_file::MeshData data = colored(family.make());
    if (!colored_) data.attributes.clear();
    write_colored(data, folder_ / "input.ply");
    ImportOptions options;
    options.name = "mesh";
    options.bits = 14;
    options.chart_faces = family.chart_faces;
    (void)repository_.import(folder_ / "input.ply", options);
  }

  void run(unsigned steps) {
    omerr().disable();  // it speaks of every face that it cannot hold
    for (step_ = 1; step_ <= steps && !::testing::Test::HasFailure(); ++step_) {
      SCOPED_TRACE(::testing::Message() << family_.name << ", step " << step_);
      try {
        step();
      } catch (const Error& error) {
        ADD_FAILURE() << what_ << ": " << error.what();
      }
    }
    if (!::testing::Test::HasFailure()) compare_with_fresh_import();
  }

 private:
  static Repository make(const TempFolder& folder) {
    Repository::create(folder / "r.ramcdb");
    return Repository::open(folder / "r.ramcdb");
  }

  void step() {
    const Snapshot before = repository_.snapshot();
    const RegionMesh all = whole(before);
    const PageCounts pages(before);
    const auto kind = random_() % 8;
    std::optional<Model> expected;
    region_.clear();
    if (kind < 3) {
      expected = edit_patch(before, all);
    } else if (kind < 7) {
      expected = edit_file(before, all);
    } else {
      expected = edit_side_by_side(before, all);
    }
    if (!expected) return;
    ++done_;
    check(before, *expected, pages);
  }

  /// Some charts around one, or all.
  std::vector<ChartId> pick_region(const Snapshot& snapshot) {
    const std::vector<ChartId> all = snapshot.find({{WholeMesh{}}, 0});
    if (random_() % 10 == 0) return all;
    const ChartId middle = all[random_() % all.size()];
    std::vector<ChartId> charts = snapshot.find({{OfCharts{{middle}}}, random_() % 3 ? 1U : 0U});
    const std::size_t most = 1 + random_() % 8;
    while (charts.size() > most) {
      std::size_t i = random_() % charts.size();
      if (charts[i] != middle) charts.erase(charts.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (random_() % 6 == 0) charts.push_back(all[random_() % all.size()]);  // somewhere else
    std::sort(charts.begin(), charts.end());
    charts.erase(std::unique(charts.begin(), charts.end()), charts.end());
    return charts;
  }

  Sketch draw(const RegionMesh& region, bool may_move_shared, bool weird) {
    Sketch sketch(region);
    const auto changes = random_() % 5;
    for (auto i = changes; i > 0; --i) sketch.change(random_, weird);
    if (changes == 0 || random_() % 3 == 0) {
      std::vector<bool> may_move(region.points.size());
      for (std::uint32_t v = 0; v < may_move.size(); ++v)
        may_move[v] = may_move_shared || region.keys[v].where == VertexKey::Where::chart;
      sketch.move(random_, may_move);
    }
    sketch.tidy();
    return sketch;
  }

  std::vector<std::vector<double>> colors_of(const Sketch& sketch) {
    std::vector<std::vector<double>> colors;
    for (const std::uint32_t was : sketch.vertex_was)
      colors.push_back(was == Sketch::kNew ? std::vector<double>{} : color_at(sketch.region(), was));
    return colors;
  }

  CommitOptions options() const {
    CommitOptions options = message(what_.c_str());
    return options;
  }

  std::optional<Model> edit_patch(const Snapshot& before, const RegionMesh& all) {
    what_ = "patch";
    const std::vector<ChartId> charts = pick_region(before);
    auto edit = repository_.begin_edit();
    Patch& patch = edit.checkout({{OfCharts{charts}}, 0});
    const Sketch sketch = sketch_in_patch(patch, draw(patch.region(), true, family_.weird), random_);
    auto colors = colors_of(sketch);
    if (colored_ && random_() % 4 == 0)
      for (std::uint32_t v = 0; v < sketch.points.size(); ++v)
        if (sketch.vertex_was[v] != Sketch::kNew && random_() % 5 == 0) {
          colors[v] = {double(random_() % 256), 1, 2};
          std::ranges::copy(colors[v],
                            patch.attributes().front().values.begin() + 3 * std::ptrdiff_t{sketch.vertex_was[v]});
        }
    return commit(all, {&sketch}, {colors}, [&] { return edit.commit(options()); });
  }

  std::optional<Model> edit_file(const Snapshot& before, const RegionMesh& all) {
    static constexpr const char* kFiles[] = {"a.ply", "a.obj", "a.off", "a.ply"};
    const std::string name = kFiles[random_() % 4];
    const bool ids = name == "a.ply";
    what_ = "file " + name;
    const std::vector<ChartId> charts = pick_region(before);
    FileOptions file_options;
    file_options.local_origin = false;
    (void)repository_.checkout_file(before, charts, folder_ / name, file_options);
    const RegionMesh region = before.read_with_attributes(charts);
    if (random_() % 6 == 0) try_to_tear(region, folder_ / name);
    const mesh_file::MeshData read = mesh_file::read_mesh(folder_ / name);
    const Sketch sketch = draw(region, ids, family_.weird);
    if (sketch.faces.empty() || sketch.points.empty()) return std::nullopt;
    auto colors = colors_of(sketch);
    if (colored_)
      for (auto& color : colors)
        if (color.empty() || random_() % 50 == 0) color = {double(random_() % 256), 7, 9};
    write_sketch(sketch, colors, read.vertex_ids, folder_ / name, !ids && random_() % 2);
    return commit(all, {&sketch}, {colors}, [&] { return repository_.commit_file(folder_ / name, options()); });
  }

  void write_sketch(const Sketch& sketch, const std::vector<std::vector<double>>& colors,
                    const std::vector<std::uint64_t>& ids, const std::filesystem::path& file, bool shuffle) {
    mesh_file::MeshData data;
    std::vector<std::uint32_t> order(sketch.points.size()), place(order.size());
    for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
    std::vector<Triangle> faces = sketch.faces;
    if (shuffle) {
      std::shuffle(order.begin(), order.end(), random_);
      std::shuffle(faces.begin(), faces.end(), random_);
    }
    Attribute color{{"color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color, {}, {}}, {}};
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      const std::uint32_t v = order[i];
      place[v] = i;
      data.positions.push_back(repository_.snapshot().position(sketch.points[v]));
      if (!ids.empty()) data.vertex_ids.push_back(sketch.vertex_was[v] == Sketch::kNew ? 0 : ids[sketch.vertex_was[v]]);
      color.values.insert(color.values.end(), colors[v].begin(), colors[v].end());
    }
    for (const Triangle& t : faces)
      for (const std::uint32_t v : t) data.corners.push_back(place[v]);
    if (colored_) data.attributes = {color};
    write_colored(data, file);
  }

  /// Edits that were made at the same time, of regions without a common chart.
  std::optional<Model> edit_side_by_side(const Snapshot& before, const RegionMesh& all) {
    what_ = "side by side";
    const std::vector<ChartId> charts = pick_region(before);
    std::vector<ChartId> others;
    for (const ChartId id : pick_region(before))
      if (!std::ranges::binary_search(charts, id)) others.push_back(id);
    if (others.empty()) return std::nullopt;
    auto first = repository_.begin_edit(), second = repository_.begin_edit();
    Patch &a = first.checkout({{OfCharts{charts}}, 0}), &b = second.checkout({{OfCharts{others}}, 0});
    const Sketch mine = sketch_in_patch(a, draw(a.region(), true, family_.weird), random_);
    const Sketch theirs = sketch_in_patch(b, draw(b.region(), false, family_.weird), random_);
    const auto colors = colors_of(mine), their_colors = colors_of(theirs);
    const Model of_both = with_sketches(all, {&mine, &theirs}, {colors, their_colors});
    if (!theirs.outer_edges_intact() || of_both.faces.empty()) return std::nullopt;
    auto expected = commit(all, {&mine}, {colors}, [&] { return first.commit(options()); });
    if (!expected) return std::nullopt;
    const VersionId tip = repository_.resolve("HEAD");
    const CommitReport report = second.commit(options());
    if (!report.conflicts.empty()) {
      EXPECT_EQ(repository_.resolve("HEAD"), tip);
      return expected;
    }
    region_.insert(others.begin(), others.end());
    return of_both;
  }

  template <class Commit>
  std::optional<Model> commit(const RegionMesh& all, const std::vector<const Sketch*>& sketches,
                              const std::vector<std::vector<std::vector<double>>>& colors, Commit&& run) {
    Model expected = with_sketches(all, sketches, colors);
    for (const Sketch* sketch : sketches) {
      if (!sketch->outer_edges_intact()) return std::nullopt;  // OpenMesh could not hold it
      region_.insert(sketch->region().charts.begin(), sketch->region().charts.end());
    }
    if (expected.faces.empty()) return std::nullopt;
    const CommitReport report = run();
    EXPECT_TRUE(report.conflicts.empty());
    return expected;
  }

  /// Faces that go at the region's outer border are refused, with the way out, and nothing is written.
  void try_to_tear(const RegionMesh& region, const std::filesystem::path& file) {
    const mesh_file::MeshData read = mesh_file::read_mesh(file);
    Sketch sketch(region);
    if (!sketch.tear(random_)) return;
    sketch.tidy();
    if (sketch.faces.empty()) return;
    const VersionId tip = repository_.resolve("HEAD");
    auto colors = colors_of(sketch);
    for (auto& color : colors)
      if (colored_ && color.empty()) color = {0, 0, 0};
    write_sketch(sketch, colors, read.vertex_ids, file, false);
    try {
      (void)repository_.commit_file(file, options());
      ADD_FAILURE() << "a torn border was taken (" << what_ << ")";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::invalid_argument);
      EXPECT_NE(std::string(error.what()).find("--grow 1"), std::string::npos) << error.what();
    }
    EXPECT_EQ(repository_.resolve("HEAD"), tip);
  }

  void check(const Snapshot& before, const Model& expected, const PageCounts& pages) {
    const Snapshot after = repository_.snapshot();
    const RegionMesh now = whole(after);
    const Model is = model_of(now);
    EXPECT_EQ(face_set(is.points, is.faces), face_set(expected.points, expected.faces)) << what_;
    EXPECT_EQ(is.sorted_points(), expected.sorted_points()) << what_;
    if (colored_) {
      const auto wanted = expected.known_colors(), have = is.known_colors();
      EXPECT_TRUE(std::includes(have.begin(), have.end(), wanted.begin(), wanted.end())) << what_ << ": colours";
    }
    check_counts(after, is, expected);
    check_untouched(before, pages, PageCounts(after));
    Repository::VerifyOptions verify;
    verify.quick = step_ % 10 != 0;
    for (const auto& problem : repository_.verify(verify).problems)
      ADD_FAILURE() << what_ << ": " << problem.object << " " << problem.text;
    if (step_ % 7 == 0) {
      auto edit = repository_.begin_edit();
      (void)edit.checkout({{WholeMesh{}}, 0});
      EXPECT_TRUE(edit.commit(options()).nothing_changed);
    }
  }

  void check_counts(const Snapshot& after, const Model& is, const Model& expected) {
    const MeshInfo info = after.info();
    const PageCounts pages(after);
    const detail::Topology counted = is.topology(), wanted = expected.topology();
    EXPECT_EQ(info.vertices, is.points.size()) << what_;
    EXPECT_EQ(info.faces, is.faces.size()) << what_;
    EXPECT_EQ(info.charts, pages.charts.size()) << what_;
    EXPECT_EQ(info.wires, pages.wires.size()) << what_;
    EXPECT_EQ(info.corners, pages.corners.size()) << what_;
    const auto same = [&](std::uint64_t detail::Topology::*count, std::uint64_t said, const char* name) {
      EXPECT_EQ(counted.*count, wanted.*count) << what_ << ": " << name << " of the mesh";
      EXPECT_EQ(said, counted.*count) << what_ << ": " << name << " of info";
    };
    same(&detail::Topology::isolated_vertices, info.isolated_vertices, "isolated vertices");
    same(&detail::Topology::degenerate_faces, info.degenerate_faces, "degenerate faces");
    same(&detail::Topology::duplicate_faces, info.duplicate_faces, "duplicate faces");
    same(&detail::Topology::nonmanifold_edges, info.nonmanifold_edges, "non-manifold edges");

    same(&detail::Topology::nonmanifold_vertices, info.nonmanifold_vertices, "non-manifold vertices");
    same(&detail::Topology::inconsistent_edges, info.inconsistent_edges, "inconsistent edges");
  }

  /// Charts away from the region keep their blobs; those that the edit made have the right size.
  void check_untouched(const Snapshot& before, const PageCounts& was, const PageCounts& is) {
    const std::vector<ChartId> region(region_.begin(), region_.end());
    const std::vector<ChartId> near = before.find({{OfCharts{region}}, 2});
    for (const auto& [id, chart] : was.charts) {
      if (std::ranges::binary_search(near, id)) continue;
      const auto now = is.charts.find(id);
      if (now == is.charts.end()) {
        ADD_FAILURE() << what_ << ": chart " << id.value << " far away is gone";
      } else {
        EXPECT_EQ(detail::state_of(now->second), detail::state_of(chart)) << what_ << ": chart " << id.value;
      }
    }
    for (const auto& [id, chart] : is.charts)
      if (!was.charts.contains(id) || was.charts.at(id).faces != chart.faces) {
        EXPECT_LE(chart.faces, 2 * family_.chart_faces) << what_;
        small_ += 4 * chart.faces < family_.chart_faces;
        ++made_;
      }
  }

  void compare_with_fresh_import() {
    const Snapshot last = repository_.snapshot();
    (void)repository_.export_mesh(last, folder_ / "last.ply", {});
    EXPECT_EQ(face_set_of_file(last.lattice(), folder_ / "last.ply"), face_set(whole(last)));
    ImportOptions options;
    options.name = "fresh";
    options.lattice = last.lattice();
    options.chart_faces = family_.chart_faces;
    const MeshInfo fresh = repository_.import(folder_ / "last.ply", options).info, info = last.info();
    const double ratio = static_cast<double>(info.bytes.payload) / static_cast<double>(fresh.bytes.payload);
    std::cout << family_.name << ": " << done_ << " edits, " << info.faces << " faces, " << info.charts << " charts ("
              << fresh.charts << " afresh), payload " << ratio << " of a fresh import; of " << made_ << " charts made, "
              << small_ << " small\n";
  }

  const OracleFamily& family_;
  Sketch::Random random_;
  TempFolder folder_;
  Repository repository_;
  bool colored_;
  unsigned step_ = 0, done_ = 0;
  std::size_t made_ = 0, small_ = 0;
  std::set<ChartId> region_;
  std::string what_;
};

class OracleTest : public ::testing::TestWithParam<OracleFamily> {};

TEST_P(OracleTest, HoldsWhatAPlainMeshHolds) {
  const unsigned seed = from_environment("RAMCDB_ORACLE_SEED", 1);
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  Oracle(GetParam(), seed).run(from_environment("RAMCDB_ORACLE_STEPS", 40));
}

INSTANTIATE_TEST_SUITE_P(Of, OracleTest,
                         ::testing::Values(OracleFamily{"sphere", [] { return sphere(1500); }, 80, false},
                                           OracleFamily{"terrain", [] { return terrain(44, 44); }, 60, true},
                                           OracleFamily{"scan", [] { return scan(2000); }, 120, true},
                                           OracleFamily{"boxes", [] { return boxes(60); }, 60, true},
                                           OracleFamily{"moebius", [] { return moebius(); }, 60, true},
                                           OracleFamily{"sheets", [] { return three_faces_one_edge(); }, 60, true},
                                           OracleFamily{"isolated", [] { return isolated_vertices(); }, 100, true},
                                           OracleFamily{"duplicates", [] { return degenerate_and_duplicate_faces(); },
                                                        60, true}),
                         [](const auto& family) { return std::string(family.param.name); });

}  // namespace
}  // namespace ramcdb::test
