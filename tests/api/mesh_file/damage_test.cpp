#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "ramcdb/error.h"
#include "tests/api/mesh_file/files.h"
#include "tests/api/mesh_file/samples.h"

/// Small files cut off at every byte and with every byte changed: an Error that names the file, or a sound mesh.
namespace ramcdb::test {
namespace {

class Damage : public testing::TestWithParam<Sample> {
 protected:
  /// The mesh, or nothing when reading threw an Error, which names the file and says how to go on.
  std::optional<mesh_file::MeshData> read(const std::string& bytes) {
    try {
      return read_text(GetParam().name, bytes);
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(GetParam().name), std::string::npos) << text;
      EXPECT_NE(text.find("): "), std::string::npos) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      return std::nullopt;
    }
  }
};

TEST_P(Damage, WholeFileIsRead) {
  const auto mesh = read(GetParam().bytes);
  ASSERT_TRUE(mesh);
  EXPECT_TRUE(is_sound(*mesh));
  EXPECT_EQ(mesh->positions.size(), GetParam().vertices);
  EXPECT_EQ(mesh->face_count(), GetParam().faces);
}

TEST_P(Damage, CutOffAtEveryByte) {
  const Sample& sample = GetParam();
  std::size_t refused = 0;
  for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
    const auto mesh = read(sample.bytes.substr(0, size));
    if (!mesh) {
      ++refused;
      continue;
    }
    EXPECT_TRUE(is_sound(*mesh)) << size;
    if (!sample.counted) continue;
    EXPECT_EQ(mesh->positions.size(), sample.vertices) << size;
    EXPECT_EQ(mesh->face_count(), sample.faces) << size;
  }
  // Blanks at the end, and digits or words that are shorter and still whole, may go unnoticed; no more.
  if (sample.counted) {
    EXPECT_GE(refused + sizeof " two words\n", sample.bytes.size());
  }
}

TEST_P(Damage, EveryByteChanged) {
  const Sample& sample = GetParam();
  std::vector<unsigned char> changes{0x01, 0x80, 0xff};
  for (const char c : {'\n', ' ', '9', '-', 'e', '\\', '#', '\0'}) changes.push_back(static_cast<unsigned char>(c));
  const std::size_t every = sample.bytes.size() > 2000 ? 4 : 1;  // of large files a quarter of the changes per byte
  for (std::size_t at = 0; at < sample.bytes.size(); ++at)
    for (std::size_t i = at % every; i < changes.size(); i += every) {
      std::string bytes = sample.bytes;
      const auto was = static_cast<unsigned char>(bytes[at]);
      bytes[at] = static_cast<char>(i < 3 ? was ^ changes[i] : changes[i]);
      const auto mesh = read(bytes);
      EXPECT_TRUE(!mesh || is_sound(*mesh)) << "byte " << at << " change " << int{changes[i]};
    }
}

TEST_P(Damage, EveryByteMissingOrTwice) {
  const Sample& sample = GetParam();
  for (std::size_t at = 0; at < sample.bytes.size(); ++at)
    for (const bool twice : {false, true}) {
      std::string bytes = sample.bytes;
      twice ? bytes.insert(at, 1, bytes[at]) : bytes.erase(at, 1);
      const auto mesh = read(bytes);
      EXPECT_TRUE(!mesh || is_sound(*mesh)) << "byte " << at;
    }
}

INSTANTIATE_TEST_SUITE_P(Samples, Damage, testing::ValuesIn(samples()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

/// glTF has float32 and triangles only, and writes vertices again where corners differ.
void expect_written_as_gltf(const mesh_file::MeshData& mesh, const std::filesystem::path& file) {
  (void)mesh_file::write_mesh(file, mesh_file::Format::glb, output_of(mesh, mesh_file::Scalar::float32));
  const auto again = mesh_file::read_mesh(file);
  ASSERT_TRUE(is_sound(again)) << file;
  EXPECT_GE(again.positions.size(), mesh.positions.size()) << file;
  EXPECT_EQ(again.face_count(), mesh_file::triangulate(mesh).corners.size()) << file;
}

/// What is read of damaged files can be written in every format, and comes back the same.
/// Half of the ids is an attribute like others, but is written under another name, so that it cannot become ids.
std::vector<Attribute> unreserved(std::vector<Attribute> attributes) {
  std::erase_if(attributes, [](const Attribute& a) { return a.info.name.starts_with("ramcdb_id_"); });
  return attributes;
}

TEST(Damaged, WhatIsReadIsWritten) {
  const TempFolder scratch;
  for (const Sample& sample : samples())
    for (std::size_t at = 0; at<sample.bytes.size(); at += sample.bytes.size()> 2000 ? 13 : 2) {
      std::string bytes = sample.bytes;
      bytes[at] = bytes[at] == '7' ? '-' : '7';
      try {
        const auto mesh = read_text(sample.name, bytes);
        for (const char* name : {"a.ply", "a.obj", "a.off"}) {
          const auto file = scratch / name;
          (void)mesh_file::write_mesh(file, mesh_file::format_of(file), output_of(mesh, mesh_file::Scalar::float64));
          const auto again = mesh_file::read_mesh(file);
          ASSERT_TRUE(is_sound(again)) << sample.name << ' ' << at << ' ' << name;
          ASSERT_EQ(bits(again.positions), bits(mesh.positions)) << sample.name << ' ' << at << ' ' << name;
          ASSERT_EQ(again.corners, mesh.corners) << sample.name << ' ' << at << ' ' << name;
          if (mesh_file::format_of(sample.name) == mesh_file::format_of(name))
            expect_same(unreserved(again.attributes), unreserved(mesh.attributes));
        }
        expect_written_as_gltf(mesh, scratch / (sample.name + ".glb"));
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(sample.name), std::string::npos) << error.what();
      }
    }
}

TEST(LineEnds, OfWindowsWithByteOrderMark) {
  for (const Sample& sample : samples()) {
    if (sample.bytes.find('\0') != std::string::npos) continue;  // binary
    std::string text = "\xef\xbb\xbf";
    for (const char c : sample.bytes) c == '\n' ? text += "\r\n" : text += c;
    const auto plain = read_text(sample.name, sample.bytes), windows = read_text(sample.name, text);
    EXPECT_EQ(bits(windows.positions), bits(plain.positions)) << sample.name;
    EXPECT_EQ(windows.corners, plain.corners) << sample.name;
    EXPECT_EQ(windows.references, plain.references) << sample.name;
    expect_same(windows.attributes, plain.attributes);
  }
}

}  // namespace
}  // namespace ramcdb::test
