#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/api/mesh_file/files.h"
#include "tests/api/mesh_file/samples.h"

/// Binary OFF, in both byte orders, with colours of faces and without.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;

/// The counts as they are said, then the bytes of two faces.
std::string with_counts(std::uint32_t vertices, std::uint32_t faces) {
  return sample_off(true, false).replace(11, 8, bytes_of(vertices, true) + bytes_of(faces, true));
}

TEST(OffBinary, AllKindsSayTheSame) {
  for (const bool big_endian : {true, false})
    for (const bool colors : {true, false}) {
      const auto mesh = read_text("a.off", sample_off(big_endian, colors));
      EXPECT_EQ(mesh.positions, (std::vector<Point>{{0, 0, 0}, {1.5, 0, 0.25}, {0, -2, 0}, {0.25, 1, 3}}));
      EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3, 0}));
      EXPECT_EQ(mesh.face_sizes, (std::vector<std::uint32_t>{3, 4}));
      EXPECT_EQ(dropped(mesh, "face colours"), colors ? 1U : 0U);
    }
}

TEST(OffBinary, BytesBehindTheLastFaceAreNamed) {
  for (const bool colors : {true, false}) {
    const auto mesh = read_text("a.off", sample_off(true, colors) + "tail");
    EXPECT_EQ(mesh.face_count(), 2U);
    EXPECT_EQ(dropped(mesh, "bytes behind the last face"), 4U);
  }
}

TEST(OffBinary, CountsThatCannotBe) {
  for (const auto& [vertices, faces] : {std::pair(5U, 2U),
                                        {4U, 5U},
                                        {0xffffffffU, 0U},
                                        {0U, 0xffffffffU},
                                        {0x55555556U, 0x10000000U},
                                        {0x80000000U, 0x80000000U}})
    EXPECT_THAT(refusal("a.off", with_counts(vertices, faces)), HasSubstr("(")) << vertices << ' ' << faces;
  EXPECT_THAT(refusal("a.off", with_counts(0xffffffffU, 0)), HasSubstr("too short for the vertices and faces"));
  EXPECT_THAT(refusal("a.off", with_counts(0, 0)), HasSubstr("no vertex"));
}

TEST(OffBinary, FacesThatCannotBe) {
  const std::string good = sample_off(true, false);
  const std::size_t face = 11 + 12 + 4 * 12;
  const auto word = [&](std::size_t at, std::uint32_t value) {
    std::string bytes = good;
    return bytes.replace(face + at, 4, bytes_of(value, true));
  };
  EXPECT_THAT(refusal("a.off", word(0, 2)), HasSubstr("a face has 2 corners"));
  EXPECT_THAT(refusal("a.off", word(0, 0xffffffff)), HasSubstr("cut off in face 0"));
  EXPECT_THAT(refusal("a.off", word(16, 5)), HasSubstr("cut off in face 1"));
  EXPECT_THAT(refusal("a.off", word(12, 4)), HasSubstr("vertex index 4 does not exist (4 vertices)"));
}

}  // namespace
}  // namespace ramcdb::test
