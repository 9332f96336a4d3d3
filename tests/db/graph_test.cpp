#include <map>
#include <set>

#include "db/version_graph.h"
#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

/// Versions 1..n, each with up to three parents among the few before it or anywhere; some are gone (pruned).
class RandomGraph {
 public:
  RandomGraph(std::uint64_t seed, std::uint32_t size) {
    for (std::uint32_t v = 1; v <= size; ++v) {
      if (mix(seed + 31 * v) % 17 == 0) continue;
      std::vector<VersionId>& parents = parents_[VersionId(v)];
      for (std::uint64_t k = mix(seed + 7 * v) % 4; v > 1 && k > 0; --k) {
        const std::uint64_t z = mix(seed + 1000 * v + k);
        const std::uint64_t back = 1 + (z % 5 == 0 ? (z >> 8) % (v - 1) : (z >> 8) % std::min(v - 1, 4U));
        parents.emplace_back(static_cast<std::uint32_t>(v - back));
      }
    }
    for (std::uint32_t v = 1; v <= size; ++v) {
      std::set<VersionId>& all = ancestors_[VersionId(v)];
      all.insert(VersionId(v));
      for (const VersionId p : parents_of(VersionId(v))) all.insert(ancestors_[p].begin(), ancestors_[p].end());
    }
  }

  [[nodiscard]] std::vector<VersionId> parents_of(VersionId v) const {
    const auto it = parents_.find(v);
    return it == parents_.end() ? std::vector<VersionId>{} : it->second;
  }
  [[nodiscard]] ParentsOf function() const {
    return [this](VersionId v) { return parents_of(v); };
  }
  [[nodiscard]] const std::set<VersionId>& ancestors(VersionId v) const { return ancestors_.at(v); }

  /// The best common ancestors, by the book.
  [[nodiscard]] std::set<VersionId> merge_bases(VersionId a, VersionId b) const {
    std::set<VersionId> common, best;
    for (const VersionId v : ancestors(a))
      if (ancestors(b).contains(v)) common.insert(v);
    for (const VersionId v : common)
      if (std::none_of(common.begin(), common.end(),
                       [&](VersionId other) { return other != v && ancestors(other).contains(v); }))
        best.insert(v);
    return best;
  }

 private:
  std::map<VersionId, std::vector<VersionId>> parents_;
  std::map<VersionId, std::set<VersionId>> ancestors_;
};

TEST(Graph, MergeBasesAncestorsAndDifferencesAreThoseOfTheBook) {
  std::size_t without = 0, several = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const std::uint32_t size = 4 + static_cast<std::uint32_t>(seed) % 24;
    const RandomGraph graph(mix(seed), size);
    for (std::uint32_t a = 1; a <= size; ++a) {
      for (std::uint32_t b = 1; b <= size; ++b) {
        const VersionId first(a), second(b);
        const auto best = graph.merge_bases(first, second);
        const VersionId found = merge_base(graph.function(), first, second);
        EXPECT_EQ(found, best.empty() ? VersionId() : *best.rbegin()) << "seed " << seed << ": " << a << ", " << b;
        EXPECT_EQ(found, merge_base(graph.function(), second, first));
        without += best.empty();
        several += best.size() > 1;
        EXPECT_EQ(is_ancestor(graph.function(), first, second), graph.ancestors(second).contains(first));

        const VersionId third(1 + (a * b) % size);
        std::vector<VersionId> left;
        for (const VersionId v : graph.ancestors(first))
          if (!graph.ancestors(second).contains(v) && !graph.ancestors(third).contains(v)) left.push_back(v);
        EXPECT_EQ(only_in(graph.function(), first, {second, third}), left) << "seed " << seed;
      }
    }
  }
  EXPECT_GT(without, 100U) << "the graphs are too tame";
  EXPECT_GT(several, 100U);
}

TEST(Graph, AnEmptyHistoryIsBeforeEverything) {
  const RandomGraph graph(5, 20);
  EXPECT_TRUE(is_ancestor(graph.function(), VersionId(), VersionId(7)));
  EXPECT_TRUE(is_ancestor(graph.function(), VersionId(), VersionId()));
  EXPECT_FALSE(is_ancestor(graph.function(), VersionId(7), VersionId()));
  EXPECT_EQ(merge_base(graph.function(), VersionId(), VersionId(7)), VersionId());
  EXPECT_TRUE(only_in(graph.function(), VersionId(), {VersionId(7)}).empty());
}

TEST(Graph, AParentThatIsNotOlderIsDamageAndNoEndlessWalk) {
  for (const std::uint32_t parent : {4U, 5U}) {
    const ParentsOf parents = [&](VersionId) { return std::vector{VersionId(parent)}; };
    expect_error(Errc::corrupt, "version 4 names a parent that is not older",
                 [&] { (void)merge_base(parents, VersionId(4), VersionId(1)); });
    expect_error(Errc::corrupt, "not older", [&] { (void)is_ancestor(parents, VersionId(1), VersionId(4)); });
    expect_error(Errc::corrupt, "not older", [&] { (void)only_in(parents, VersionId(4), {VersionId(1)}); });
  }
}

/// The same through a store, with merges published on it.
TEST(Graph, HistoryHasEveryVersionOnceAndTheStoreAnswers) {
  const TempStore temp;
  const auto store = temp.open();
  const RandomGraph graph(77, 40);
  for (std::uint32_t v = 1; v <= 40; ++v) {
    const auto writer = store->writer(10);
    CommitInfo info = commit_info(*writer, "b" + std::to_string(v) + "x");
    info.parents = graph.parents_of(VersionId(v));
    EXPECT_EQ(writer->publish(info), VersionId(v));
  }
  for (std::uint32_t v = 1; v <= 40; ++v) {
    std::vector<VersionId> listed;
    for (const VersionInfo& info : store->history(VersionId(v), 100)) listed.push_back(info.id);
    const auto& expected = graph.ancestors(VersionId(v));
    EXPECT_EQ(listed, std::vector<VersionId>(expected.rbegin(), expected.rend()));
    const VersionId other(1 + v * 7 % 40);
    const auto best = graph.merge_bases(VersionId(v), other);
    EXPECT_EQ(store->merge_base(VersionId(v), other), best.empty() ? VersionId() : *best.rbegin());
    EXPECT_EQ(store->is_ancestor(other, VersionId(v)), expected.contains(other));
    if (const auto parents = graph.parents_of(VersionId(v)); !parents.empty()) {
      EXPECT_EQ(store->resolve("b" + std::to_string(v) + "x~1"), parents.front()) << "~ follows first parents";
    }
  }
  EXPECT_TRUE(problems(*store).empty());
}

}  // namespace
}  // namespace ramcdb::db::test
