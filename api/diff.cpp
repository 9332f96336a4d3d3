#include "api/diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "api/chart_loader.h"
#include "api/face_matching.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using PageKey = std::pair<PageId, VersionId>;

/// Pages of one level of a tree, and the leaves found on the way.
struct Frontier {
  const PageIndex& index;
  std::set<PageKey> pages;
  std::map<ChartId, ChartState> charts;  ///< of leaves that the other version does not share

  void open_all() {
    std::set<PageKey> below;
    for (const auto& [id, version] : pages) {
      const auto loaded = index.page(id, version);
      if (const auto* inner = std::get_if<InnerPage>(&*loaded.page))
        for (const PageEntry& e : inner->pages) below.insert({e.id, e.version});
      else
        for (const PageChart& c : std::get<LeafPage>(*loaded.page).charts) charts.emplace(c.id, state_of(c));
    }
    pages = std::move(below);
  }
};

void drop_equal(std::set<PageKey>& a, std::set<PageKey>& b) {
  std::set<PageKey> only_a, only_b;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(only_a, only_a.end()));
  std::set_difference(b.begin(), b.end(), a.begin(), a.end(), std::inserter(only_b, only_b.end()));
  a = std::move(only_a);
  b = std::move(only_b);
}

/// Sums up displacements over vertices, each counted once though several charts share it.
class Displacements {
 public:
  /// Returns the displacement.
  double add(const VertexKey& key, const Point& from, const Point& to) {
    double sum = 0;
    for (int a = 0; a < 3; ++a) sum += (to[a] - from[a]) * (to[a] - from[a]);
    if (seen_.insert(key.packed()).second) squares_ += sum;
    return std::sqrt(sum);
  }
  [[nodiscard]] std::uint64_t count() const { return seen_.size(); }
  [[nodiscard]] double rms() const {
    return seen_.empty() ? 0 : std::sqrt(squares_ / static_cast<double>(seen_.size()));
  }

 private:
  double squares_ = 0;
  std::set<std::uint64_t> seen_;
};

/// Positions in model units: of a lossless mesh to the last bit.
std::vector<Point> positions_of(const LoadedChart& loaded, const Lattice& lattice) {
  if (!loaded.exact.empty()) return loaded.exact;
  std::vector<Point> positions;
  for (const LatticePoint p : loaded.chart.positions) positions.push_back(lattice.position(p));
  return positions;
}

/// The new position of every vertex of a chart; empty when the two do not have the same connectivity. Border vertices
/// are told apart by their keys, inner ones by the faces around them, for re-encoding renumbers them.
std::vector<Point> targets_of(const LoadedChart& a, const LoadedChart& b, const Lattice& lattice) {
  if (a.chart.faces.size() != b.chart.faces.size() || a.chart.positions.size() != b.chart.positions.size()) return {};
  const TriangleCorners faces_a(a.chart.faces), faces_b(b.chart.faces);
  const Matching matching = match_faces(faces_a.over(a.chart.positions), faces_b.over(b.chart.positions));
  if (matching.unmatched) return {};
  const std::vector<Point> there = positions_of(b, lattice);
  std::vector<Point> to = positions_of(a, lattice);
  std::vector<bool> known(to.size(), false);
  for (std::size_t f = 0; f < a.chart.faces.size(); ++f)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t v = a.chart.faces[f][i];
      const FaceMatch m = matching.matches[f];
      const Point& p = there[b.chart.faces[m.face][(i + m.turn) % 3]];
      if (known[v] && to[v] != p) return {};
      to[v] = p;
      known[v] = true;
    }
  return to;
}

void compare_charts(const LoadedChart& a, const LoadedChart& b, const Lattice& lattice, Displacements& sum,
                    DiffReport& report) {
  ChangeReport::ChartChange change{a.entry.id, 0, 0};
  const std::vector<Point> from = positions_of(a, lattice), to = targets_of(a, b, lattice);
  std::set<std::uint64_t> counted;
  for (std::size_t v = 0; v < to.size(); ++v) {
    if (to[v] == from[v]) continue;
    change.vertices_moved += counted.insert(a.keys[v].packed()).second;
    change.max_displacement = std::max(change.max_displacement, sum.add(a.keys[v], from[v], to[v]));
  }
  report.max_displacement = std::max(report.max_displacement, change.max_displacement);
  report.per_chart.push_back(change);
}

}  // namespace

DiffReport diff_versions(const Snapshot::Impl& from, const Snapshot::Impl& to, unsigned threads) {
  if (from.root().mesh != to.root().mesh || !(from.record().lattice == to.record().lattice))
    throw Error(Errc::invalid_argument, "these versions do not hold the same mesh",
                fmt::format("{} and {}", from.root().name, to.root().name), "name one mesh with --mesh");
  DiffReport report{from.version(), to.version(), {}, {}, {}, 0, 0, 0, {}};
  Frontier a{from.pages(), {{from.root().root_page, from.root().root_version}}, {}};
  Frontier b{to.pages(), {{to.root().root_page, to.root().root_version}}, {}};
  for (drop_equal(a.pages, b.pages); !a.pages.empty() || !b.pages.empty(); drop_equal(a.pages, b.pages)) {
    a.open_all();
    b.open_all();
  }
  for (const auto& [id, version] : a.charts) {
    const auto other = b.charts.find(id);
    if (other == b.charts.end())
      report.removed.push_back(id);
    else if (other->second != version)
      report.changed.push_back(id);
  }
  for (const auto& [id, version] : b.charts)
    if (!a.charts.contains(id)) report.added.push_back(id);

  const auto before = ChartLoader(from).load(report.changed, threads);
  const auto after = ChartLoader(to).load(report.changed, threads);
  Displacements sum;
  for (std::size_t i = 0; i < before.size(); ++i)
    compare_charts(before[i], after[i], from.record().lattice, sum, report);
  report.vertices_moved = sum.count();
  report.rms_displacement = sum.rms();
  return report;
}

}  // namespace ramcdb::detail
