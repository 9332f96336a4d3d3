#pragma once

#include <iostream>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "tests/api/model.h"

namespace ramcdb::test {

using ChartsOfVertices = std::map<std::uint64_t, std::set<ChartId>>;

/// The charts of each vertex of a version, by its id.
[[nodiscard]] inline ChartsOfVertices charts_of_vertices(const RegionMesh& whole, const Model& model) {
  ChartsOfVertices charts;
  for (std::uint32_t f = 0; f < whole.faces.size(); ++f)
    for (const std::uint32_t v : whole.faces[f]) charts[model.ids[v]].insert(whole.charts[whole.chart_of_face[f]]);
  for (std::uint32_t v = 0; v < whole.keys.size(); ++v)
    if (whole.keys[v].where == VertexKey::Where::chart) charts[model.ids[v]].insert(ChartId(whole.keys[v].id));
  return charts;
}

/// Two edits of one version.
class ThreeWay {
 public:
  ThreeWay(const Model& base, const Model& ours, const Model& theirs)
      : base_(base), ours_(ours), theirs_(theirs), touched_(touched(base, ours)), by_theirs_(touched(base, theirs)) {}

  /// Neither changed anything at a vertex at which the other did, nor next to one. (A vertex that moved among faces of
  /// which most were replaced is taken for another, so that these faces, too, are new.)
  [[nodiscard]] bool disjoint() const { return !common(touched_, with_neighbours(by_theirs_)); }
  /// Nor in a chart in which the other did. New faces that share no edge with old ones go to any chart of their region.
  /// \param by_theirs the charts that theirs changed
  [[nodiscard]] bool apart(const ChartsOfVertices& charts, const std::set<ChartId>& by_theirs) const {
    const std::set<ChartId> by_ours = charts_of(touched_, charts);
    return !adds(ours_) && !common(by_ours, adds(theirs_) ? by_theirs : charts_of(by_theirs_, charts));
  }
  [[nodiscard]] std::optional<Model> merged() const { return PlainMerge(base_, ours_, theirs_).run(); }
  /// Who lies at a place in each of the three.
  void tell(LatticePoint place) const {
    for (const auto& [name, model] :
         {std::pair("base", &base_), std::pair("ours", &ours_), std::pair("theirs", &theirs_)})
      for (std::uint32_t v = 0; v < model->ids.size(); ++v) {
        if (model->points[v] != place) continue;
        const auto faces =
            std::ranges::count_if(model->faces, [&](const Triangle& t) { return std::ranges::count(t, v) > 0; });
        std::cout << "    " << name << ": vertex " << model->ids[v] << " of " << faces << " faces\n";
      }
  }
  [[nodiscard]] std::string contradiction() const {
    PlainMerge merge(base_, ours_, theirs_);
    (void)merge.run();
    return merge.contradiction();
  }

 private:
  template <class T>
  static bool common(const std::set<T>& a, const std::set<T>& b) {
    return std::ranges::any_of(a, [&](const T& x) { return b.contains(x); });
  }
  [[nodiscard]] std::set<std::uint64_t> with_neighbours(const std::set<std::uint64_t>& ids) const {
    std::set<std::uint64_t> all = ids;
    for (const Model* model : {&base_, &theirs_})
      for (const Triangle& t : model->faces)
        if (std::ranges::any_of(t, [&](std::uint32_t v) { return ids.contains(model->ids[v]); }))
          for (const std::uint32_t v : t) all.insert(model->ids[v]);
    return all;
  }
  [[nodiscard]] bool adds(const Model& side) const {
    return side.faces.size() > base_.faces.size() || side.ids.size() > base_.ids.size();
  }
  static std::set<ChartId> charts_of(const std::set<std::uint64_t>& ids, const ChartsOfVertices& charts) {
    std::set<ChartId> all;
    for (const std::uint64_t id : ids) all.insert(charts.at(id).begin(), charts.at(id).end());
    return all;
  }

  const Model &base_, &ours_, &theirs_;
  std::set<std::uint64_t> touched_, by_theirs_;
};

/// What each version ought to hold, and what it was made from.
class History {
 public:
  void add(VersionId version, std::vector<VersionId> parents, Model model) {
    versions_.emplace(version, Version{std::move(model), std::move(parents)});
  }
  [[nodiscard]] const Model& model(VersionId version) const { return versions_.at(version).model; }
  [[nodiscard]] const std::vector<VersionId>& parents(VersionId version) const { return versions_.at(version).parents; }

  [[nodiscard]] VersionId any(std::mt19937& random) const {
    auto it = versions_.begin();
    std::advance(it, static_cast<std::ptrdiff_t>(random() % versions_.size()));
    return it->first;
  }
  /// With itself.
  [[nodiscard]] std::set<VersionId> ancestors(VersionId version) const {
    std::set<VersionId> seen{version};
    std::vector<VersionId> open{version};
    while (!open.empty()) {
      const VersionId next = open.back();
      open.pop_back();
      for (const VersionId parent : parents(next))
        if (seen.insert(parent).second) open.push_back(parent);
    }
    return seen;
  }
  [[nodiscard]] bool leads_to(VersionId version, VersionId ancestor) const {
    return ancestors(version).contains(ancestor);
  }
  /// Whether it is a common ancestor that no other one descends from.
  [[nodiscard]] bool is_merge_base(VersionId base, VersionId a, VersionId b) const {
    const std::set<VersionId> of_a = ancestors(a), of_b = ancestors(b);
    if (!of_a.contains(base) || !of_b.contains(base)) return false;
    for (const VersionId common : of_a)
      if (common != base && of_b.contains(common) && leads_to(common, base)) return false;
    return true;
  }
  /// A version below a tip, as a rule one of the last, that was not taken back yet: a second time would be another edit
  /// that happens to make the same.
  [[nodiscard]] std::optional<VersionId> to_revert(VersionId tip, std::mt19937& random) {
    std::vector<VersionId> all;
    for (const VersionId version : ancestors(tip))
      if (versions_.at(version).may_be_reverted && !parents(version).empty()) all.push_back(version);
    if (all.empty()) return std::nullopt;
    std::sort(all.begin(), all.end());
    const std::size_t last = random() % 4 ? std::min<std::size_t>(6, all.size()) : all.size();
    const VersionId version = all[all.size() - 1 - random() % last];
    versions_.at(version).may_be_reverted = false;
    return version;
  }

 private:
  struct Version {
    Model model;
    std::vector<VersionId> parents;
    bool may_be_reverted = true;
  };
  std::map<VersionId, Version> versions_;
};

}  // namespace ramcdb::test
