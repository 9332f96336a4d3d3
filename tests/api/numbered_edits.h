#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ramcdb/edit_transaction.h"
#include "tests/api/temp_repository.h"

namespace ramcdb::test {

/// Edits with numbers for messages, so that what a version holds is known from the numbers up to it: edit n lifts every
/// vertex of chart 1 + 7 n % charts by one step of the lattice. REQUIRES: a terrain, whose x and y name its vertices.
class NumberedEdits {
 public:
  explicit NumberedEdits(const Repository& repository) {
    const Snapshot first = repository.snapshot({}, "v1");
    for (const ChartId id : first.find({{WholeMesh{}}, 0})) {
      std::vector<Name>& names = vertices_.emplace_back();
      const RegionMesh chart = first.read({id});
      for (const LatticePoint p : chart.points) {
        names.push_back({p.x, p.y});
        height_[{p.x, p.y}] = p.z;
      }
    }
  }

  [[nodiscard]] std::uint32_t charts() const { return static_cast<std::uint32_t>(vertices_.size()); }

  CommitReport commit(Repository& repository, std::uint32_t number) const {
    auto edit = repository.begin_edit();
    Patch& patch = edit.checkout({{OfCharts{{ChartId(1 + chart_of(number))}}}, 0});
    const double step = edit.base().lattice().step;
    for (const auto v : patch.mesh().all_vertices())
      patch.mesh().set_point(v, patch.mesh().point(v) + Patch::Mesh::Point(0, 0, step));
    CommitOptions options;
    options.message = std::to_string(number);
    return edit.commit(options);
  }

  /// Expects some charts of a version to hold just what the edits up to it made.
  void check(const Repository& repository, VersionId version, const std::vector<ChartId>& charts) const {
    const std::string name = std::to_string(version.value);
    std::map<Name, std::int32_t> lifted;
    for (const VersionRecord& record : repository.log(name))
      if (record.id != VersionId(1))
        for (const Name& vertex : vertices_[chart_of(static_cast<std::uint32_t>(std::stoul(record.message)))])
          ++lifted[vertex];
    const RegionMesh region = repository.snapshot({}, name).read(charts);
    std::size_t wrong = 0;
    for (const LatticePoint p : region.points) {
      const auto it = lifted.find({p.x, p.y});
      wrong += p.z != height_.at({p.x, p.y}) + (it == lifted.end() ? 0 : it->second);
    }
    EXPECT_EQ(wrong, 0U) << "version " << version.value;
    EXPECT_GT(region.points.size(), 0U);
  }

 private:
  using Name = std::pair<std::int32_t, std::int32_t>;

  [[nodiscard]] std::uint32_t chart_of(std::uint32_t number) const { return number * 7 % charts(); }

  std::vector<std::vector<Name>> vertices_;  ///< by chart
  std::map<Name, std::int32_t> height_;      ///< in the first version
};

/// Makes a repository with one terrain in `folder` and leaves nothing open.
inline void make_terrain_repository(const std::filesystem::path& folder, int cells, std::uint32_t chart_faces) {
  const std::filesystem::path file = folder.string() + ".ply";
  write_test_mesh(terrain(cells, cells), file);
  Repository::create(folder);
  ImportOptions options;
  options.chart_faces = chart_faces;
  options.bits = 14;
  (void)Repository::open(folder).import(file, options);
}

}  // namespace ramcdb::test
