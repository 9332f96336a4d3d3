#include "tests/cli/scene.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <stdexcept>

namespace ramcdb::test {

std::string wavy_ply(int cells) {
  std::ostringstream ply;
  const int side = cells + 1;
  ply << "ply\nformat ascii 1.0\nelement vertex " << side * side
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << 2 * cells * cells
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      ply << x / double(cells) << ' ' << y / double(cells) << ' ' << ((x * 7 + y * 5) % 11) / (20.0 * cells) << '\n';
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      const int v = y * side + x;
      ply << "3 " << v << ' ' << v + 1 << ' ' << v + side + 1 << "\n3 " << v << ' ' << v + side + 1 << ' ' << v + side
          << '\n';
    }
  return ply.str();
}

std::string with_lifted_vertex(const std::string& ply, double from, double to, double dz) {
  std::istringstream in(ply);
  std::ostringstream out;
  out.precision(17);
  bool in_vertices = false, lifted = false;
  for (std::string line; std::getline(in, line);) {
    double x = 0, y = 0, z = 0;
    std::istringstream numbers(line);
    if (in_vertices && !lifted && numbers >> x >> y >> z && std::min(x, y) >= from && std::max(x, y) <= to) {
      std::string rest;
      std::getline(numbers, rest);
      out << x << ' ' << y << ' ' << z + dz << rest << '\n';
      lifted = true;
    } else {
      out << line << '\n';
    }
    in_vertices = in_vertices || line == "end_header";
  }
  if (!lifted) throw std::runtime_error("no vertex to lift");
  return out.str();
}

nlohmann::ordered_json only_object(const std::string& out) {
  auto json = nlohmann::ordered_json::parse(out, nullptr, false);
  EXPECT_TRUE(json.is_object()) << out;
  EXPECT_EQ(out.find_first_of('{'), 0U);
  return json;
}

void expect_done(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
}

void expect_failure(const Outcome& outcome, int code) {
  EXPECT_EQ(outcome.code, code) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const std::string& err = outcome.err;
  EXPECT_EQ(err.rfind("ramcdb: ", 0), 0U) << err;
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
  EXPECT_TRUE(!err.empty() && err.back() == '\n') << err;
  EXPECT_NE(err.find(": ", 8), std::string::npos) << "no word on how to go on: " << err;
}

void SceneTest::SetUp() {
  write_text(path("wavy.ply"), wavy_ply(60));
  expect_done(run_ramcdb({"init", repo_, "-q"}));
  expect_done(run_ramcdb({"import", repo_, path("wavy.ply"), "--chart-faces", "300", "-q", "--author", "Ada"}));
}

std::string SceneTest::checked_out(const std::string& name) const {
  expect_done(run_ramcdb({"checkout", repo_, "--sphere", "0.5,0.5,0,0.1", "-o", path(name), "--ascii", "-q"}));
  return path(name);
}

void SceneTest::edit(const std::string& file, double dz) {
  write_text(file, with_lifted_vertex(read_text(file), 0.4, 0.6, dz));
}

}  // namespace ramcdb::test
