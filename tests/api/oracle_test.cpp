#include <cstdlib>
#include <iostream>
#include <optional>

#include "tests/api/oracle.h"
#include "tests/api/oracle_checks.h"
#include "tests/api/oracle_history.h"

// Random edits of all kinds on branches, each checked against a plain mesh to which the same was done.
// RAMCDB_ORACLE_STEPS makes sequences longer, RAMCDB_ORACLE_SEED others; even seeds paint as well. Many long ones:
//   RAMCDB_ORACLE_SEED=7 RAMCDB_ORACLE_STEPS=500 TMPDIR=/dev/shm tools/test --fast Oracle
namespace ramcdb::test {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr unsigned kSteps = 8;
#else
constexpr unsigned kSteps = 40;
#endif

struct OracleFamily {
  const char* name;
  TestMesh (*make)();
  std::uint32_t chart_faces;
  bool weird;         ///< edits may make places that are not manifold
  bool fair = false;  ///< large enough to compare what it takes with a fresh import
};

unsigned from_environment(const char* name, unsigned otherwise) {
  const char* text = std::getenv(name);
  return text ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : otherwise;
}

Attribute color_attribute() {
  return {{"color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color, {}, {}}, {}};
}

mesh_file::MeshData colored(const TestMesh& mesh) {
  mesh_file::MeshData data;
  data.positions = mesh.positions;
  for (const Triangle& t : mesh.faces) data.corners.insert(data.corners.end(), t.begin(), t.end());
  Attribute color = color_attribute();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (std::size_t i = 0; i < 3; ++i) color.values.push_back(static_cast<double>((v * (i + 1)) % 256));
  data.attributes = {color};
  return data;
}

/// An edit that was made and not committed yet.
struct Work {
  std::string what, branch;
  VersionId base;
  std::set<ChartId> region;
  Model ours;  ///< what the base becomes by it
  std::function<CommitReport(const CommitOptions&)> commit;
  std::filesystem::path file;  ///< where it was made in one
};

class Oracle {
 public:
  Oracle(const OracleFamily& family, unsigned seed)
      : family_(family), random_(seed), repository_(make(folder_)), colored_(seed % 2 == 0) {
    mesh_file::MeshData data = colored(family.make());
    if (!colored_) data.attributes.clear();
    write_data(data, folder_ / "input.ply");
    (void)repository_.import(folder_ / "input.ply", importing("mesh"));
    const Snapshot first = repository_.snapshot("mesh");
    Model model = model_of(whole(first));
    next_id_ = model.ids.size();
    faces_ = std::max<std::size_t>(model.faces.size(), 300);
    history_.add(first.version(), {}, std::move(model));
    tips_["main"] = first.version();
  }

  void run(unsigned steps) {
    omerr().disable();  // it speaks of every face that it cannot hold
    for (step_ = 1; step_ <= steps && !::testing::Test::HasFailure(); ++step_) {
      SCOPED_TRACE(::testing::Message() << family_.name << ", step " << step_);
      try {
        step();
        check_history();
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
  [[nodiscard]] ImportOptions importing(const char* name) const {
    ImportOptions options;
    options.name = name;
    options.bits = 14;
    options.chart_faces = family_.chart_faces;
    return options;
  }
  [[nodiscard]] CommitOptions options(const std::string& branch) const {
    CommitOptions options = message(what_.c_str());
    options.branch = branch;
    return options;
  }
  [[nodiscard]] Snapshot at(VersionId version) const {
    return repository_.snapshot("mesh", "v" + std::to_string(version.value));
  }

  void step() {
    const auto kind = random_() % 16;
    const std::string branch = some_branch();
    if (kind < 4) {
      edit(begin_patch(branch));
    } else if (kind < 9) {
      edit(begin_file(branch, "file"));
    } else if (kind < 12) {
      edit_beside_others(branch);
    } else if (kind == 12) {
      change_branches();
    } else if (kind < 15) {
      merge_branch(branch);
    } else {
      revert(branch);
    }
  }

  std::string some_branch() {
    if (random_() % 2) return "main";
    auto it = tips_.begin();
    std::advance(it, static_cast<std::ptrdiff_t>(random_() % tips_.size()));
    return it->first;
  }

  // Edits.

  void edit(std::optional<Work> work) {
    if (!work) return;
    what_ = work->what + " on " + work->branch;
    if (finish(*work) && !work->file.empty()) look_at_file(*work);
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

  /// A mesh that has grown or shrunk much is changed to the other side, if a few tries find how.
  Sketch draw(const RegionMesh& region, bool may_move_shared, std::size_t faces) {
    for (int tries = 0;; ++tries) {
      Sketch sketch = draw(region, may_move_shared);
      const std::size_t now = faces + sketch.faces.size() - region.faces.size();
      const bool suits = now > faces ? now < 3 * faces_ / 2 : now == faces || now > 2 * faces_ / 3;
      if (suits || tries == 20) return sketch;
    }
  }

  Sketch draw(const RegionMesh& region, bool may_move_shared) {
    Sketch sketch(region);
    const auto changes = random_() % 5;
    for (auto i = changes; i > 0; --i) sketch.change(random_, family_.weird);
    if (changes == 0 || random_() % 3 == 0) {
      std::vector<bool> may_move(region.points.size());
      for (std::uint32_t v = 0; v < may_move.size(); ++v)
        may_move[v] = may_move_shared || region.keys[v].where == VertexKey::Where::chart;
      sketch.move(random_, may_move);
    }
    sketch.tidy();
    return sketch;
  }

  [[nodiscard]] std::size_t face_count(const Snapshot& snapshot) const {
    return history_.model(snapshot.version()).faces.size();
  }

  std::vector<Model::Color> colors_of(const Sketch& sketch) {
    std::vector<Model::Color> colors;
    for (const std::uint32_t was : sketch.vertex_was)
      colors.push_back(was == Sketch::kNew ? Model::Color{} : color_at(sketch.region(), was));
    return colors;
  }

  std::optional<Work> begin_patch(const std::string& branch) {
    auto transaction = std::make_shared<EditTransaction>(repository_.begin_edit("mesh", branch));
    const Snapshot base = transaction->base();
    const std::vector<ChartId> charts = pick_region(base);
    Patch& patch = transaction->checkout({{OfCharts{charts}}, 0});
    const Sketch sketch = sketch_in_patch(patch, draw(patch.region(), true, face_count(base)), random_);
    auto colors = colors_of(sketch);
    if (colored_ && random_() % 4 == 0)
      for (std::uint32_t v = 0; v < sketch.points.size(); ++v)
        if (sketch.vertex_was[v] != Sketch::kNew && random_() % 5 == 0) {
          colors[v] = {double(random_() % 256), 1, 2};
          std::ranges::copy(colors[v],
                            patch.attributes().front().values.begin() + 3 * std::ptrdiff_t{sketch.vertex_was[v]});
        }
    return begin("patch", branch, base, sketch, std::move(colors),
                 [transaction](const CommitOptions& options) { return transaction->commit(options); });
  }

  std::optional<Work> begin_file(const std::string& branch, const std::string& stem) {
    static constexpr const char* kFormats[] = {".ply", ".obj", ".off", ".ply"};
    const std::string name = stem + kFormats[random_() % 4];
    const bool ids = name.ends_with(".ply");
    const std::filesystem::path file = folder_ / name;
    const Snapshot base = at(tips_.at(branch));
    const std::vector<ChartId> charts = pick_region(base);
    FileOptions file_options;
    file_options.local_origin = false;
    (void)repository_.checkout_file(base, charts, file, file_options);
    const RegionMesh region = base.read_with_attributes(charts);
    const mesh_file::MeshData read = mesh_file::read_mesh(file);
    if (random_() % 6 == 0) try_to_tear(branch, region, read.vertex_ids, file);
    const Sketch sketch = draw(region, ids, face_count(base));
    if (sketch.faces.empty() || sketch.points.empty()) return std::nullopt;
    auto colors = colors_of(sketch);
    if (colored_)
      for (auto& color : colors)
        if (color.empty() || color[0] < 0 || random_() % 50 == 0) color = {double(random_() % 256), 7, 9};
    write_sketch(sketch, colors, read.vertex_ids, file, !ids && random_() % 2);
    auto work = begin("file " + name, branch, base, sketch, std::move(colors),
                      [this, file](const CommitOptions& options) { return repository_.commit_file(file, options); });
    if (work) work->file = file;
    return work;
  }

  /// None where OpenMesh could not hold the sketch, or nothing would be left.
  std::optional<Work> begin(const std::string& what, const std::string& branch, const Snapshot& base,
                            const Sketch& sketch, std::vector<Model::Color> colors,
                            std::function<CommitReport(const CommitOptions&)> commit) {
    if (!sketch.outer_edges_intact()) return std::nullopt;
    const RegionMesh all = whole(base);
    const Model& model = history_.model(base.version());
    Work work{what, branch, base.version(), {}, {}, std::move(commit), {}};
    work.region.insert(sketch.region().charts.begin(), sketch.region().charts.end());
    work.ours = with_sketch(all, model, placed(sketch, std::move(colors), all, model, next_id_));
    if (work.ours.faces.empty()) return std::nullopt;
    return work;
  }

  void write_sketch(const Sketch& sketch, const std::vector<Model::Color>& colors,
                    const std::vector<std::uint64_t>& ids, const std::filesystem::path& file, bool shuffle) {
    mesh_file::MeshData data;
    std::vector<std::uint32_t> order(sketch.points.size()), place(order.size());
    for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
    std::vector<Triangle> faces = sketch.faces;
    if (shuffle) {
      std::shuffle(order.begin(), order.end(), random_);
      std::shuffle(faces.begin(), faces.end(), random_);
    }
    Attribute color = color_attribute();
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      const std::uint32_t v = order[i];
      place[v] = i;
      data.positions.push_back(repository_.snapshot("mesh").position(sketch.points[v]));
      if (!ids.empty()) data.vertex_ids.push_back(sketch.vertex_was[v] == Sketch::kNew ? 0 : ids[sketch.vertex_was[v]]);
      color.values.insert(color.values.end(), colors[v].begin(), colors[v].end());
    }
    for (const Triangle& t : faces)
      for (const std::uint32_t v : t) data.corners.push_back(place[v]);
    if (colored_) data.attributes = {color};
    (void)mesh_file::write_mesh(file, mesh_file::format_of(file),
                                mesh_file::output_of(data, mesh_file::Scalar::float64));
  }

  /// Faces that go at the region's outer border are refused, with the way out, and nothing is written.
  void try_to_tear(const std::string& branch, const RegionMesh& region, const std::vector<std::uint64_t>& ids,
                   const std::filesystem::path& file) {
    Sketch sketch(region);
    if (!sketch.tear(random_)) return;
    sketch.tidy();
    if (sketch.faces.empty()) return;
    auto colors = colors_of(sketch);
    for (auto& color : colors)
      if (colored_ && (color.empty() || color[0] < 0)) color = {0, 0, 0};
    write_sketch(sketch, colors, ids, file, false);
    try {
      (void)repository_.commit_file(file, options(branch));
      ADD_FAILURE() << "a torn border was taken (" << what_ << ")";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::invalid_argument);
      EXPECT_NE(std::string(error.what()).find("--grow 1"), std::string::npos) << error.what();
    }
    EXPECT_EQ(repository_.resolve(branch), tips_.at(branch));
  }

  /// A committed file is in step with the repository.
  void look_at_file(const Work& work) {
    if (!tips_.contains(work.branch) || tips_.at(work.branch) == work.base) return;
    if (file_merged_) return commit_again(work);
    what_ += ", looked at";
    EXPECT_TRUE(repository_.status_file(work.file).clean()) << what_;
    EXPECT_TRUE(repository_.commit_file(work.file, options(work.branch)).nothing_changed) << what_;
  }

  /// What a merged file brought is not brought twice. A file without ids may tell vertices at one place apart otherwise
  /// than before.
  void commit_again(const Work& work) {
    if (family_.weird && work.file.extension() != ".ply") return;
    what_ += ", sent again";
    CommitOptions committing = options(work.branch);
    committing.merge = true;
    const CommitReport report = repository_.commit_file(work.file, committing);
    if (report.nothing_changed || !report.conflicts.empty()) {
      EXPECT_EQ(repository_.resolve(work.branch), tips_.at(work.branch)) << what_;
      again_ += report.nothing_changed;
    } else {
      const Model same = history_.model(tips_.at(work.branch));
      std::set<ChartId> near = work.region;
      for (const ChartId id : changed_since(work.base, tips_.at(work.branch))) near.insert(id);
      accept(work.branch, same, near);
    }
  }

  /// Work that others overtake, once or twice.
  void edit_beside_others(const std::string& branch) {
    std::optional<Work> late = random_() % 3 ? begin_patch(branch) : begin_file(branch, "late");
    if (!late) return;
    for (auto i = 1 + random_() % 2; i > 0; --i) edit(begin_patch(branch));
    if (::testing::Test::HasFailure()) return;
    what_ = "late " + late->what + " on " + branch;
    if (finish(*late) && !late->file.empty()) look_at_file(*late);
  }

  // Commits.

  static std::vector<std::uint32_t> numbers_of(const std::vector<ChartId>& charts) {
    std::vector<std::uint32_t> numbers;
    for (const ChartId id : charts) numbers.push_back(id.value);
    return numbers;
  }

  /// Where several vertices lie at one place, a file without ids may seem to tear the region's border.
  bool is_refused(const Work& work) {
    if (!family_.weird || work.file.empty() || work.file.extension() == ".ply") return false;
    try {
      (void)repository_.status_file(work.file);
      return false;
    } catch (const Error& error) {
      if (std::string_view(error.what()).find("--grow 1") == std::string_view::npos) throw;
      ++refused_;
      return true;
    }
  }

  /// False when it was refused.
  bool finish(Work& work) {
    file_merged_ = false;
    if (is_refused(work)) return false;
    const VersionId tip = tips_.at(work.branch);
    if (tip == work.base) {
      const CommitReport report = work.commit(options(work.branch));
      EXPECT_TRUE(report.conflicts.empty()) << what_;
      accept(work.branch, work.ours, work.region);
      return true;
    }
    const ThreeWay sides(history_.model(work.base), work.ours, history_.model(tip));
    CommitOptions committing = options(work.branch);
    committing.merge = random_() % 2;
    CommitReport report = work.commit(committing);
    if (!report.conflicts.empty() && !committing.merge) {
      EXPECT_EQ(repository_.resolve(work.branch), tip) << what_;
      EXPECT_FALSE(sides.apart(charts_at(work.base), changed_since(work.base, tip)))
          << what_ << ": edits of charts of their own met in "
          << ::testing::PrintToString(numbers_of(report.conflicts));
      committing.merge = true;
      report = work.commit(committing);
    }
    file_merged_ = report.merged;
    if (settle(sides, work.branch, report.conflicts.empty(), work.region)) return true;
    committing.onto = "saved" + std::to_string(step_);
    report = work.commit(committing);
    EXPECT_TRUE(report.conflicts.empty()) << what_ << ": --onto";
    EXPECT_EQ(report.parent, work.base);
    tips_[committing.onto] = work.base;
    accept(committing.onto, work.ours, work.region);
    drop_branches();
    return true;
  }

  /// What came of a merge on a branch. False when it was refused.
  bool settle(const ThreeWay& sides, const std::string& branch, bool merged, const std::set<ChartId>& region,
              VersionId other = {}) {
    const VersionId tip = tips_.at(branch);
    ++(merged ? merges_ : conflicts_);
    if (!merged) {
      EXPECT_EQ(repository_.resolve(branch), tip) << what_;
      EXPECT_FALSE(sides.disjoint()) << what_ << ": edits that have nothing to do with each other are a conflict";
      return false;
    }
    const auto plain = sides.merged();
    EXPECT_TRUE(plain) << what_ << ": edits that contradict each other were merged: " << sides.contradiction();
    if (!plain) return true;
    std::set<ChartId> near = region;
    const auto charts = charts_at(tip);
    for (const std::uint64_t id : touched(history_.model(tip), *plain))
      near.insert(charts.at(id).begin(), charts.at(id).end());
    accept(branch, *plain, near, other, &sides);
    return true;
  }

  /// The charts of each vertex of a version.
  [[nodiscard]] ChartsOfVertices charts_at(VersionId version) const {
    return charts_of_vertices(whole(at(version)), history_.model(version));
  }

  // Branches.

  void change_branches() {
    what_ = "new branch";
    const VersionId from = history_.any(random_);
    const std::string name = "b" + std::to_string(step_);
    (void)repository_.create_branch(name, "v" + std::to_string(from.value));
    tips_[name] = from;
    drop_branches();
  }

  void drop_branches() {
    while (tips_.size() > 4) {
      auto it = tips_.begin();
      std::advance(it, static_cast<std::ptrdiff_t>(random_() % tips_.size()));
      if (it->first == "main") continue;
      (void)repository_.delete_branch(it->first, true);
      tips_.erase(it);
    }
  }

  void merge_branch(const std::string& branch) {
    const std::string other = some_branch();
    if (other == branch) return;
    what_ = "merge of " + other + " into " + branch;
    const VersionId tip = tips_.at(branch), theirs = tips_.at(other);
    const MergeReport report = repository_.merge(other, options(branch));
    EXPECT_EQ(report.nothing_changed, history_.leads_to(tip, theirs)) << what_;
    EXPECT_TRUE(history_.is_merge_base(report.base, tip, theirs)) << what_ << ": base " << report.base.value;
    if (report.nothing_changed || ::testing::Test::HasFailure()) return;
    const bool merged = report.commit.conflicts.empty();
    const ThreeWay sides(history_.model(report.base), history_.model(theirs), history_.model(tip));
    (void)settle(sides, branch, merged, changed_since(report.base, tip), theirs);
  }

  void revert(const std::string& branch) {
    const auto version = history_.to_revert(tips_.at(branch), random_);
    if (!version) return;
    what_ = "revert of v" + std::to_string(version->value) + " on " + branch;
    const VersionId tip = tips_.at(branch), before = history_.parents(*version).front();
    const CommitReport report = repository_.revert("v" + std::to_string(version->value), "mesh", options(branch));
    const ThreeWay sides(history_.model(*version), history_.model(before), history_.model(tip));
    (void)settle(sides, branch, report.conflicts.empty(), changed_since(*version, tip));
  }

  /// Charts of a version that have other blobs than in an older one.
  [[nodiscard]] std::set<ChartId> changed_since(VersionId before, VersionId now) const {
    const PageCounts old(at(before)), is(at(now));
    std::set<ChartId> changed;
    for (const auto& [id, chart] : is.charts)
      if (const auto it = old.charts.find(id);
          it == old.charts.end() || detail::state_of(it->second) != detail::state_of(chart))
        changed.insert(id);
    return changed;
  }

  // What has to hold.

  /// A version that was made, or not where nothing had to be, is what it ought to be.
  void accept(const std::string& branch, const Model& expected, const std::set<ChartId>& region, VersionId other = {},
              const ThreeWay* sides = nullptr) {
    const VersionId tip = tips_.at(branch);
    const Snapshot before = at(tip), after = repository_.snapshot("mesh", branch);
    const RegionMesh now = whole(after);
    Model is = model_of(now);
    const auto same = SameMesh(expected, is).run();
    EXPECT_TRUE(same) << what_ << ": another mesh";
    if (!same) explain(expected, is, what_, sides);
    EXPECT_TRUE(face_set(is.points, is.faces) == face_set(expected.points, expected.faces)) << what_ << ": faces";
    EXPECT_TRUE(is.sorted_points() == expected.sorted_points()) << what_ << ": vertices";
    if (colored_) {
      const auto wanted = expected.known_colors(), have = is.known_colors();
      EXPECT_TRUE(std::includes(have.begin(), have.end(), wanted.begin(), wanted.end())) << what_ << ": colours";
    }
    expect_counts(after, is, expected, what_);
    charts_.add(expect_charts(before, after, region, sides ? 1 : 0, family_.chart_faces, what_));
    check_repository(after, branch);
    if (!same || after.version() == tip) return;
    for (std::uint32_t v = 0; v < is.ids.size(); ++v) is.ids[v] = expected.ids[(*same)[v]];
    std::vector<VersionId> parents{tip};
    if (other) parents.push_back(other);
    history_.add(after.version(), parents, std::move(is));
    tips_[branch] = after.version();
    ++done_;
  }

  void check_repository(const Snapshot& after, const std::string& branch) {
    Repository::VerifyOptions verify;
    verify.quick = step_ % 10 != 0;
    for (const auto& problem : repository_.verify(verify).problems)
      ADD_FAILURE() << what_ << ": " << problem.object << " " << problem.text;
    if (step_ % 7 == 0) {
      auto edit = repository_.begin_edit("mesh", branch);
      (void)edit.checkout({{WholeMesh{}}, 0});
      EXPECT_TRUE(edit.commit(options(branch)).nothing_changed);
    }
    if (step_ % 5 == 0) {
      (void)repository_.export_mesh(after, folder_ / "export.ply", {});
      EXPECT_EQ(face_set_of_file(after.lattice(), folder_ / "export.ply"), face_set(whole(after))) << what_;
    }
  }

  /// Versions stay what they were, and branches where they are.
  void check_history() {
    for (const auto& [branch, tip] : tips_) EXPECT_EQ(repository_.resolve(branch), tip) << what_ << ": " << branch;
    const VersionId old = history_.any(random_);
    const Model is = model_of(whole(at(old))), &was = history_.model(old);
    EXPECT_TRUE(is.points == was.points && is.faces == was.faces && is.color == was.color)
        << what_ << ": version " << old.value << " is not what it was";
  }

  void compare_with_fresh_import() {
    const Snapshot last = repository_.snapshot("mesh");
    (void)repository_.export_mesh(last, folder_ / "last.ply", {});
    ImportOptions options = importing("fresh");
    options.lattice = last.lattice();
    const MeshInfo fresh = repository_.import(folder_ / "last.ply", options).info, info = last.info();
    const double ratio = static_cast<double>(info.bytes.payload) / static_cast<double>(fresh.bytes.payload);
    if (family_.fair) {
      EXPECT_LE(ratio, 1.15);
    }
    // Edits of a file keep to its charts; those that have only a few faces left wait for an edit beside them.
    EXPECT_LE(charts_.small, 5 + charts_.made / (family_.fair ? 10 : 7));
    std::cout << family_.name << ": " << done_ << " versions (" << merges_ << " merges, " << conflicts_
              << " conflicts), " << info.faces << " faces, " << info.charts << " charts (" << fresh.charts
              << " afresh), payload " << ratio << " of a fresh import; " << again_ << " merged files sent again, "
              << refused_ << " refused; of " << charts_.made << " charts made, " << charts_.small << " small\n";
  }

  const OracleFamily& family_;
  Sketch::Random random_;
  TempFolder folder_;
  Repository repository_;
  bool colored_;
  std::size_t faces_ = 0;  ///< about as many are there, in all versions
  std::uint64_t next_id_ = 0;
  History history_;
  std::map<std::string, VersionId> tips_;
  unsigned step_ = 0, done_ = 0, merges_ = 0, conflicts_ = 0, again_ = 0, refused_ = 0;
  MadeCharts charts_;
  bool file_merged_ = false;
  std::string what_;
};

class OracleTest : public ::testing::TestWithParam<OracleFamily> {};

TEST_P(OracleTest, HoldsWhatAPlainMeshHolds) {
  const unsigned seed = from_environment("RAMCDB_ORACLE_SEED", 1);
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  Oracle(GetParam(), seed).run(from_environment("RAMCDB_ORACLE_STEPS", kSteps));
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
                                                        60, true},
                                           OracleFamily{"large", [] { return scan(6000); }, 400, false, true}),
                         [](const auto& family) { return std::string(family.param.name); });

}  // namespace
}  // namespace ramcdb::test
