#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <optional>

#include "ramcdb/error.h"
#include "tests/api/mesh_file/files.h"
#include "tests/support/meshes.h"

/// Real meshes of others: as many vertices and faces as the table in MESHES.md beside them says.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;

/// A facet of four vertices, on purpose; the table counts what a lenient reader makes of it.
constexpr std::string_view kRefused = "tiny/toomanyvertices.stl";

struct Counts {
  std::size_t vertices = 0, faces = 0;
};

/// "42,321", or nothing.
std::optional<std::size_t> count_of(std::string cell) {
  std::erase_if(cell, [](char c) { return c == ',' || c == ' '; });
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

/// Rows read | `folder/file` ... | format | V | F | ...
std::map<std::string, std::optional<Counts>> counts_by_file(const fs::path& table) {
  std::map<std::string, std::optional<Counts>> all;
  std::ifstream in(table);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| `")) continue;
    std::vector<std::string> cells;
    for (std::size_t begin = 1, end = 0; (end = line.find('|', begin)) != line.npos; begin = end + 1)
      cells.push_back(line.substr(begin, end - begin));
    if (cells.size() < 4) continue;
    const auto vertices = count_of(cells[2]), faces = count_of(cells[3]);
    auto& entry = all[cells[0].substr(2, cells[0].find('`', 2) - 2)];
    if (vertices && faces) entry = Counts{*vertices, *faces};
  }
  return all;
}

bool is_read(const fs::path& file) {
  try {
    (void)mesh_file::format_of(file);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// As the table counts: STL after welding.
void expect_counts(const mesh_file::MeshData& mesh, const Counts& expected, const std::string& name) {
  EXPECT_EQ(mesh.face_count(), expected.faces) << name;
  std::size_t vertices = mesh.positions.size();
  if (mesh.soup && vertices != expected.vertices) {
    auto welded = mesh;
    mesh_file::weld_exact(welded);
    vertices = welded.positions.size();
  }
  EXPECT_EQ(vertices, expected.vertices) << name;
}

/// Whether float32 holds every coordinate.
bool are_floats(const std::vector<Point>& positions) {
  return std::all_of(positions.begin(), positions.end(), [](const Point& p) {
    for (int a = 0; a < 3; ++a)
      if (static_cast<double>(static_cast<float>(p[a])) != p[a]) return false;
    return true;
  });
}

/// glTF has 32-bit floats: what nodes have turned is rounded, the rest comes back.
void expect_same_glb(const mesh_file::MeshData& mesh, const TempFolder& scratch, const std::string& name) {
  SCOPED_TRACE(name);
  const auto file = scratch / "again.glb";
  EXPECT_TRUE(mesh_file::write_mesh(file, mesh_file::Format::glb, output_of(mesh, mesh_file::Scalar::float32)).empty());
  const auto again = mesh_file::read_mesh(file);
  auto rounded = mesh.positions;
  for (Point& p : rounded)
    for (int a = 0; a < 3; ++a) p[a] = static_cast<double>(static_cast<float>(p[a]));
  EXPECT_TRUE(again.positions == rounded);
  EXPECT_TRUE(again.corners == mesh.corners);
  expect_same(again.attributes, mesh.attributes);
}

/// What comes back from a file of the same format that we wrote ourselves.
void expect_same_again(const mesh_file::MeshData& mesh, const TempFolder& scratch, const std::string& name) {
  for (const bool ascii : {false, true}) {
    const auto file = scratch / ("again" + fs::path(name).extension().string());
    // Binary floats stay floats; a float32's text is another double.
    const bool binary = !ascii && mesh_file::format_of(file) == mesh_file::Format::ply;
    const auto scalar = binary && are_floats(mesh.positions) ? mesh_file::Scalar::float32 : mesh_file::Scalar::float64;
    mesh_file::write_mesh(file, mesh_file::format_of(file), output_of(mesh, scalar), ascii);
    const auto again = mesh_file::read_mesh(file);
    EXPECT_EQ(again.face_count(), mesh.face_count()) << name;
    if (mesh.soup) continue;  // corners stand in the order of faces
    EXPECT_TRUE(again.positions == mesh.positions) << name;
    EXPECT_TRUE(again.corners == mesh.corners) << name;
    EXPECT_TRUE(again.face_sizes == mesh.face_sizes) << name;
    SCOPED_TRACE(name);
    expect_same(again.attributes, mesh.attributes);
    EXPECT_EQ(again.references, mesh.references);
  }
}

TEST(RealMeshes, CountsAreThoseOfTheTable) {
  const auto folder = meshes_folder();
  if (!folder || !fs::exists(*folder / "MESHES.md"))
    GTEST_SKIP() << "real meshes: set RAMCDB_MESHES to a folder with MESHES.md";
  const auto expected = counts_by_file(*folder / "MESHES.md");
  const TempFolder scratch;
  std::size_t read = 0;
  for (const auto& [name, counts] : expected) {
    const fs::path file = *folder / name;
    if (!is_read(file) || !fs::exists(file) || fs::file_size(file) > largest_real_file()) {
      fmt::print("skipped {}: {}\n", name, is_read(file) ? "missing or too large" : "another format");
      continue;
    }
    if (name == kRefused) {
      EXPECT_THROW((void)mesh_file::read_mesh(file), Error) << name;
      continue;
    }
    try {
      const auto mesh = mesh_file::read_mesh(file);
      EXPECT_TRUE(is_sound(mesh)) << name;
      if (counts) expect_counts(mesh, *counts, name);  // the table has none for binary OFF
      if (mesh_file::format_of(file) == mesh_file::Format::glb)
        expect_same_glb(mesh, scratch, name);
      else
        expect_same_again(mesh, scratch, name);
      ++read;
    } catch (const Error& error) {
      ADD_FAILURE() << name << ": " << error.what();
    }
  }
  fmt::print("{} real meshes read, of {} in the table\n", read, expected.size());
  EXPECT_GT(read, 0U);
}

}  // namespace
}  // namespace ramcdb::test
