#include "db/version_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>

#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

/// Versions by descending number, each once, with the marks of all that lead to it.
class Walk {
 public:
  explicit Walk(const ParentsOf& parents) : parents_(parents) {}

  void add(VersionId version, unsigned marks) {
    if (version) open_[version] |= marks;
  }
  /// Whether a version waits that lacks one of `marks`.
  [[nodiscard]] bool any_without(unsigned marks) const {
    return std::any_of(open_.begin(), open_.end(), [&](const auto& v) { return (v.second & marks) != marks; });
  }
  [[nodiscard]] bool done() const { return open_.empty(); }

  struct Step {
    VersionId version;
    unsigned marks = 0;
  };
  /// Takes the newest version and lets its parents wait with its marks.
  Step next() {
    const auto newest = std::prev(open_.end());
    const Step step{newest->first, newest->second};
    open_.erase(newest);
    for (const VersionId parent : parents_(step.version)) {
      if (parent >= step.version)
        throw Error(Errc::corrupt, fmt::format("version {} names a parent that is not older", step.version.value), {},
                    "run `ramcdb verify`");
      add(parent, step.marks);
    }
    return step;
  }

 private:
  const ParentsOf& parents_;
  std::map<VersionId, unsigned> open_;
};

constexpr unsigned kFirst = 1, kSecond = 2, kBoth = 3;

}  // namespace

VersionId merge_base(const ParentsOf& parents, VersionId a, VersionId b) {
  Walk walk(parents);
  walk.add(a, kFirst);
  walk.add(b, kSecond);
  // The newest common ancestor is the first that both lead to; it descends from no later one.
  while (!walk.done())
    if (const Walk::Step step = walk.next(); step.marks == kBoth) return step.version;
  return {};
}

bool is_ancestor(const ParentsOf& parents, VersionId old, VersionId version) {
  if (!old) return true;
  Walk walk(parents);
  walk.add(version, kFirst);
  while (!walk.done()) {
    const Walk::Step step = walk.next();
    if (step.version <= old) return step.version == old;
  }
  return false;
}

std::vector<VersionId> only_in(const ParentsOf& parents, VersionId from, const std::vector<VersionId>& others) {
  Walk walk(parents);
  walk.add(from, kFirst);
  for (const VersionId other : others) walk.add(other, kSecond);
  std::vector<VersionId> versions;
  while (walk.any_without(kSecond))
    if (const Walk::Step step = walk.next(); step.marks == kFirst) versions.push_back(step.version);
  std::reverse(versions.begin(), versions.end());
  return versions;
}

}  // namespace ramcdb::db
