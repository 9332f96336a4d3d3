#include <gtest/gtest.h>

#include "tests/api/mesh_file/files.h"

/// What the PLY reader takes, by hand-made files.
namespace ramcdb::test {
namespace {

TEST(Ply, AsciiWithoutNewlineAtTheEnd) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
  for (const char* end : {"", "\n", "\r\n", "\n\n\n"}) {
    const auto mesh = read_text("a.ply", text + end);
    EXPECT_TRUE(is_sound(mesh));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(mesh.dropped.empty());
  }
}

}  // namespace
}  // namespace ramcdb::test
