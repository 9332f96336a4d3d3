#include <set>

#include "tests/api/numbered_edits.h"

/// Which versions touched a place: against what is known of every edit.
namespace ramcdb::test {
namespace {

std::vector<std::uint32_t> numbers(const std::vector<VersionRecord>& records) {
  std::vector<std::uint32_t> ids;
  for (const VersionRecord& record : records) ids.push_back(record.id.value);
  return ids;
}

using Numbers = std::vector<std::uint32_t>;

class RegionLog : public ::testing::Test {
 protected:
  /// Moves all inner vertices of a chart.
  void move(std::uint32_t chart, const Patch::Mesh::Point& by, const std::string& branch = "main") {
    auto edit = repo_->begin_edit({}, branch);
    Patch& patch = edit.checkout({{OfCharts{{ChartId(chart)}}}, 0});
    for (const auto v : patch.mesh().all_vertices())
      if (!patch.mesh().is_boundary(v)) patch.mesh().set_point(v, patch.mesh().point(v) + by);
    CommitOptions options = message("move");
    options.branch = branch;
    (void)edit.commit(options);
  }

  [[nodiscard]] Numbers touched(const Region& region, std::string_view at = {}, std::size_t limit = ~std::size_t{0}) {
    return numbers(repo_->log_of_region(region, at, limit));
  }

  /// What log_of_region() must find for a box or ball, by way of describe() at every version.
  [[nodiscard]] Numbers by_the_book(const RegionShape& shape) {
    Numbers found;
    for (const VersionRecord& record : repo_->log()) {
      std::vector<std::string> states{std::to_string(record.id.value)};
      for (const VersionId parent : record.parents) states.push_back(std::to_string(parent.value));
      bool touches = false;
      for (const std::string& state : states) {
        std::vector<ChartId> there;
        try {
          there = repo_->snapshot({}, state).find({{shape}, 0});
        } catch (const Error&) {
          continue;  // nothing there
        }
        for (const ChartId id : record.changes.at(0).charts)
          touches = touches || std::binary_search(there.begin(), there.end(), id);
      }
      if (touches) found.push_back(record.id.value);
    }
    return found;
  }

  TempRepository repo_{terrain(40, 40), 200};
};

TEST_F(RegionLog, FindsWhatTouchedABoxOrABallAndNothingElse) {
  const Snapshot first = repo_->snapshot();
  const auto charts = static_cast<std::uint32_t>(first.find({{WholeMesh{}}, 0}).size());
  ASSERT_GT(charts, 8U);
  const double step = first.lattice().step;
  for (std::uint32_t i = 0; i < 12; ++i) move(1 + i * 5 % charts, {0, 0, (i % 3 ? 1 : 40) * step});
  std::set<Numbers> answers;
  for (const ChartSummary& chart : first.describe(first.find({{WholeMesh{}}, 0}))) {
    if (chart.id.value % 2 == 0) continue;  // the test is to be quick
    const Point& lo = chart.lo;
    const Point& hi = chart.hi;
    const Point middle{(lo.x + hi.x) / 2, (lo.y + hi.y) / 2, (lo.z + hi.z) / 2};
    for (const RegionShape& shape : {RegionShape(InBox{middle, middle}), RegionShape(InBox{lo, middle}),
                                     RegionShape(InSphere{hi, (hi.x - lo.x) / 4})}) {
      const Numbers found = touched({{shape}, 0});
      EXPECT_EQ(found, by_the_book(shape)) << "chart " << chart.id.value;
      answers.insert(found);
    }
  }
  EXPECT_GT(answers.size(), 8U) << "places differ";
}

TEST_F(RegionLog, AChartThatMovedAwayCountsWhereItWasAndWhereItIs) {
  const Snapshot first = repo_->snapshot();
  const ChartSummary chart = first.describe({ChartId(3)}).front();
  const double up = 10 * (first.info().hi.z - first.info().lo.z + 1);
  move(3, {0, 0, up});   // v2
  move(3, {0, 0, -up});  // v3
  move(5, {0, 0, 1});    // v4
  const Point middle{(chart.lo.x + chart.hi.x) / 2, (chart.lo.y + chart.hi.y) / 2, 0};
  const InBox high{{middle.x, middle.y, up / 2}, {middle.x, middle.y, 2 * up}};
  EXPECT_EQ(touched({{high}, 0}), (Numbers{3, 2})) << "there in 2, gone from there in 3";
  EXPECT_EQ(touched({{high}, 0}, "1"), Numbers{});
  EXPECT_EQ(touched({{high}, 0}, "2"), Numbers{2});
  EXPECT_EQ(touched({{high}, 0}, {}, 1), Numbers{3});
  EXPECT_EQ(touched({{high}, 0}, {}, 0), Numbers{});
}

TEST_F(RegionLog, NamedAndNearestChartsAndAllOfThem) {
  move(3, {0, 0, 0.25});
  move(5, {0, 0, 0.25});
  move(3, {0, 0, 0.25});
  EXPECT_EQ(touched({{OfCharts{{ChartId(3)}}}, 0}), (Numbers{4, 2, 1}));
  EXPECT_EQ(touched({{OfCharts{{ChartId(3), ChartId(5)}}}, 0}), (Numbers{4, 3, 2, 1}));
  EXPECT_EQ(touched({{OfCharts{{ChartId(999)}}}, 0}), Numbers{}) << "one that is gone or never was";
  EXPECT_EQ(touched({{WholeMesh{}}, 0}), (Numbers{4, 3, 2, 1}));
  const Snapshot now = repo_->snapshot();
  const RegionMesh chart = now.read({ChartId(5)});
  for (std::size_t v = 0; v < chart.points.size(); ++v)
    if (chart.keys[v].where == VertexKey::Where::chart) {
      EXPECT_EQ(touched({{NearestTo{now.position(chart, v)}}, 0}), (Numbers{3, 1}));
      break;
    }
  const auto ring = now.find({{OfCharts{{ChartId(5)}}}, 1});
  const bool has_three = std::binary_search(ring.begin(), ring.end(), ChartId(3));
  EXPECT_EQ(touched({{OfCharts{{ChartId(5)}}}, 1}), has_three ? (Numbers{4, 3, 2, 1}) : (Numbers{3, 1}));
}

TEST_F(RegionLog, GoesAlongTheBranchThatIsAskedFor) {
  (void)repo_->create_branch("side");
  move(3, {0, 0, 0.25}, "side");
  move(3, {0, 0, 0.25}, "main");
  EXPECT_EQ(touched({{OfCharts{{ChartId(3)}}}, 0}, "side"), (Numbers{2, 1}));
  EXPECT_EQ(touched({{OfCharts{{ChartId(3)}}}, 0}), (Numbers{3, 1}));
}

TEST_F(RegionLog, SeveralMeshesAreToldApart) {
  ImportOptions options;
  options.name = "second";
  options.chart_faces = 200;
  (void)repo_->import(repo_ / "input.ply", options);
  EXPECT_THROW((void)repo_->log_of_region({{WholeMesh{}}, 0}), Error);
  EXPECT_EQ(numbers(repo_->log_of_region({{WholeMesh{}}, 0}, {}, 9, "second")), Numbers{2});
  EXPECT_EQ(numbers(repo_->log_of_region({{WholeMesh{}}, 0}, {}, 9, "mesh")), Numbers{1});
  EXPECT_EQ(numbers(repo_->log_of_region({{InBox{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}}}, 0}, {}, 9, "second")),
            Numbers{2});
}

}  // namespace
}  // namespace ramcdb::test
