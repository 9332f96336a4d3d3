#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/cli/program.h"

namespace ramcdb::test {

/// A wavy square of 2 * cells * cells triangles over [0, 1] x [0, 1], as an ASCII PLY.
[[nodiscard]] std::string wavy_ply(int cells);

/// The PLY with the first vertex whose x and y lie within `from`..`to` lifted by `dz`. REQUIRES: an ASCII PLY whose
/// vertices are x y z first.
[[nodiscard]] std::string with_lifted_vertex(const std::string& ply, double from, double to, double dz);

/// The one JSON object of an output; fails the test when there is anything else.
[[nodiscard]] nlohmann::ordered_json only_object(const std::string& out);

/// Success: exit code 0 and nothing on standard error.
void expect_done(const Outcome& outcome);

/// Failure: this exit code, nothing on standard output, and one line `ramcdb: ...: ...` on standard error.
void expect_failure(const Outcome& outcome, int code);

/// A repository with one mesh, "wavy", in small charts.
class SceneTest : public testing::Test {
 protected:
  void SetUp() override;

  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path(name); }
  /// Checks out the charts around the middle to a file of this name, as text; returns its path.
  [[nodiscard]] std::string checked_out(const std::string& name) const;
  /// Lifts one vertex well inside the file's region.
  static void edit(const std::string& file, double dz = 0.05);

  TempFolder folder_;
  std::string repo_ = folder_.path("scene.ramcdb");
};

}  // namespace ramcdb::test
