#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "ramcdb/error.h"
#include "tests/api/mesh_file/gltf_builder.h"

/// Geometry that the glTF reader takes: containers, buffers, accessors, modes, and scenes.
namespace ramcdb::test {
namespace {

using testing::HasSubstr;
using Corners = std::vector<std::uint32_t>;

TEST(Gltf, BothContainersSayTheSame) {
  const GltfBuilder file = gltf_sample();
  const auto binary = read_glb(file);
  EXPECT_EQ(binary.positions.size(), 12U);
  EXPECT_EQ(binary.face_count(), 6U);
  EXPECT_TRUE(binary.face_sizes.empty());
  for (const char* name : {"a.gltf", "a.GLTF", "a.GlB"})
    for (const std::string& bytes : {file.gltf(), file.glb(), "\xef\xbb\xbf" + file.gltf()}) {
      const auto other = read_text(name, bytes);
      EXPECT_EQ(bits(other.positions), bits(binary.positions)) << name;
      EXPECT_EQ(other.corners, binary.corners) << name;
      expect_same(other.attributes, binary.attributes);
    }
}

TEST(Gltf, BufferBesideTheFile) {
  const TempFolder scratch;
  const GltfBuilder file = gltf_square();
  std::filesystem::create_directory(scratch / "sub folder");
  write_bytes(scratch / "sub folder/a b.bin", file.binary() + "more");
  write_bytes(scratch / "a.gltf", file.gltf("sub%20folder/a%20b.bin"));
  EXPECT_EQ(mesh_file::read_mesh(scratch / "a.gltf").face_count(), 2U);
  // As the command line names files: without a folder.
  const auto here = std::filesystem::current_path();
  std::filesystem::current_path(scratch.folder());
  EXPECT_EQ(mesh_file::read_mesh("a.gltf").face_count(), 2U);
  std::filesystem::current_path(here);
}

TEST(Gltf, OnlyFilesBelowTheFoldersAreOpened) {
  const TempFolder scratch;
  const GltfBuilder file = gltf_square();
  std::filesystem::create_directory(scratch / "in");
  write_bytes(scratch / "a.bin", file.binary());
  std::filesystem::create_symlink(scratch / "a.bin", scratch / "in/link.bin");
  std::filesystem::create_directory(scratch / "in/folder.bin");
  const std::string absolute = (scratch / "a.bin").string();
  for (const std::string& uri :
       {std::string("../a.bin"), std::string("%2e%2e/a.bin"), std::string("x/../../a.bin"), absolute,
        "file://" + absolute, std::string("http://example.org/a.bin"), std::string("..\\a.bin"), std::string("C:a.bin"),
        std::string("link.bin"), std::string("folder.bin"), std::string("none.bin"), std::string("a%00.bin"),
        std::string("")}) {
    write_bytes(scratch / "in/a.gltf", uri.empty() ? file.gltf("%") : file.gltf(uri));
    try {
      (void)mesh_file::read_mesh(scratch / "in/a.gltf");
      ADD_FAILURE() << uri << " was opened";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::invalid_argument) << uri;
      EXPECT_THAT(error.what(), HasSubstr("a.gltf, buffer 0)")) << uri;
    }
  }
}

TEST(Gltf, AllWaysOfBase64) {
  const GltfBuilder file = gltf_square();
  std::string plain = file.gltf();
  for (const std::string end : {"=\"", "==\""})
    if (const auto at = plain.find(end); at != plain.npos) plain.erase(at, end.size() - 1);
  EXPECT_EQ(read_text("a.gltf", plain).face_count(), 2U) << "without padding";
  std::string octets = file.gltf();
  octets.replace(octets.find("application/octet-stream"), 24, "application/gltf-buffer;name=x");
  EXPECT_EQ(read_text("a.gltf", octets).face_count(), 2U);
  for (const auto& [what, with] : {std::pair<std::string, std::string>{";base64,", ";base6,"},
                                   {";base64,", ";base64"},
                                   {"base64,", "base64,!"},
                                   {"base64,", "base64,="}})
    EXPECT_THAT(refusal("a.gltf",
                        [&, &w = what, &x = with] {
                          std::string bytes = file.gltf();
                          return bytes.replace(bytes.find(w), w.size(), x);
                        }()),
                HasSubstr("base64"));
}

TEST(Gltf, ModesBecomeTriangles) {
  const std::vector<float> five{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
  const std::pair<int, Corners> kModes[] = {
      {4, {0, 1, 2}}, {5, {0, 1, 2, 1, 3, 2, 2, 3, 4}}, {6, {1, 2, 0, 2, 3, 0, 3, 4, 0}}, {0, {}}, {1, {}}, {2, {}},
      {3, {}}};
  for (const auto& [mode, corners] : kModes)
    for (const bool indexed : {false, true}) {
      GltfBuilder file;
      file.add_mesh({{"attributes", {{"POSITION", file.add(five, kFloat, "VEC3")}}}, {"mode", mode}});
      Json& primitive = file.json["meshes"][0]["primitives"][0];
      if (indexed) primitive["indices"] = file.add<std::uint8_t>({0, 1, 2, 3, 4}, kUbyte, "SCALAR");
      const auto mesh = read_glb(file);
      EXPECT_EQ(mesh.positions.size(), 5U) << mode;
      EXPECT_EQ(mesh.corners, corners) << mode;
      EXPECT_EQ(dropped(mesh, "corners that make no whole triangle"), mode == 4 ? 2U : 0U);
      EXPECT_EQ(dropped(mesh, "points (their vertices are kept)"), mode == 0 ? 5U : 0U);
      const std::uint64_t lines[] = {0, 2, 5, 4, 0, 0, 0};
      EXPECT_EQ(dropped(mesh, "lines (their vertices are kept)"), lines[mode]);
    }
}

TEST(Gltf, IndicesOfAllTypes) {
  const auto expect = [](GltfBuilder file, std::size_t indices) {
    file.json["meshes"][0]["primitives"][0]["indices"] = indices;
    EXPECT_EQ(read_glb(file).corners, (Corners{3, 2, 1}));
  };
  GltfBuilder file = gltf_square();
  expect(file, file.add<std::uint8_t>({3, 2, 1}, kUbyte, "SCALAR"));
  expect(file, file.add<std::uint16_t>({3, 2, 1}, kUshort, "SCALAR"));
  expect(file, file.add<std::uint32_t>({3, 2, 1}, kUint, "SCALAR"));
  const auto strided = file.view<std::uint16_t>({3, 9, 2, 9, 1}, 4);
  expect(file, file.accessor(strided, kUshort, "SCALAR", 3));
}

TEST(Gltf, PositionsOfAllTypes) {
  const auto positions = [](auto add) {
    GltfBuilder file = gltf_square();
    file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = add(file);
    return read_glb(file).positions;
  };
  EXPECT_EQ(positions([](GltfBuilder& f) {
              return f.accessor(f.view<std::int16_t>({1, -2, 3, 0, -32768, 32767, 7, 0, 4, 5, 6, 0, 7, 8, 9, 0}, 8),
                                kShort, "VEC3", 4);
            }),
            (std::vector<Point>{{1, -2, 3}, {-32768, 32767, 7}, {4, 5, 6}, {7, 8, 9}}));
  const auto normalized = positions([](GltfBuilder& f) {
    const auto a =
        f.accessor(f.view<std::int8_t>({127, -127, -128, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4), kByte, "VEC3", 4);
    f.json["accessors"][a]["normalized"] = true;
    return a;
  });
  EXPECT_EQ(normalized[0], (Point{1, -1, -1}));
  EXPECT_EQ(normalized[1], (Point{1.0 / 127, 0, 0}));
  // One element after another in one buffer, and an offset of the accessor beside that of the view.
  EXPECT_EQ(positions([](GltfBuilder& f) {
              const auto a =
                  f.accessor(f.view<float>({9, 9, 1, 2, 3, 9, 4, 5, 6, 9, 7, 8, 9, 9, 0, 0, 0}, 16), kFloat, "VEC3", 4);
              f.json["accessors"][a]["byteOffset"] = 8;
              return a;
            }),
            (std::vector<Point>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {0, 0, 0}}));
}

TEST(Gltf, SparseAndMissingData) {
  GltfBuilder file = gltf_square();
  const auto indices = file.view<std::uint16_t>({3, 1});
  const auto values = file.view<float>({7, 8, 9, -1, -2, -3});
  file.json["accessors"][0]["sparse"] = {{"count", 2},
                                         {"indices", {{"bufferView", indices}, {"componentType", kUshort}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(read_glb(file).positions, (std::vector<Point>{{0, 0, 0}, {-1, -2, -3}, {1, 1, 0}, {7, 8, 9}}));
  file.json["accessors"][0].erase("bufferView");
  EXPECT_EQ(read_glb(file).positions, (std::vector<Point>{{0, 0, 0}, {-1, -2, -3}, {0, 0, 0}, {7, 8, 9}}));
  file.json["accessors"][0].erase("sparse");
  EXPECT_EQ(read_glb(file).positions, std::vector<Point>(4));
}

TEST(Gltf, PrimitivesShareVerticesWhereTheyCan) {
  GltfBuilder file = gltf_square();
  const auto normals = file.add<float>(std::vector<float>(12, 1), kFloat, "VEC3");
  const auto other = file.add<float>(std::vector<float>(12, 2), kFloat, "VEC3");
  const auto texture = file.add<float>(std::vector<float>(8, 3), kFloat, "VEC2");
  Json& primitives = file.json["meshes"][0]["primitives"];
  primitives.push_back({{"attributes", {{"POSITION", 0}, {"NORMAL", normals}}}, {"indices", 1}});
  primitives.push_back({{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", texture}}}, {"indices", 1}, {"mode", 0}});
  primitives.push_back({{"attributes", {{"POSITION", 0}, {"NORMAL", other}}}, {"indices", 1}});
  const auto mesh = read_glb(file);
  EXPECT_EQ(mesh.positions.size(), 8U);
  EXPECT_EQ(mesh.corners, (Corners{0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}));
  EXPECT_EQ(dropped(mesh, "points (their vertices are kept)"), 6U);
  const Attribute normal = find(mesh, "normal");
  EXPECT_EQ(normal.values[0], 1);
  EXPECT_EQ(normal.values[12], 2);
  EXPECT_TRUE(std::isnan(find(mesh, "texture").values[8]));
}

TEST(Gltf, InstancesHaveVerticesOfTheirOwn) {
  GltfBuilder file = gltf_square();
  file.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 5}}});
  file.json["nodes"].push_back({{"mesh", 0}});
  // Another mesh of the same vertices in the same place is part of the same surface.
  file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}});
  file.json["nodes"].push_back({{"mesh", 1}});
  const auto mesh = read_glb(file);
  EXPECT_EQ(mesh.positions.size(), 12U);
  EXPECT_EQ(mesh.positions[5], (Point{1, 0, 5}));
  EXPECT_EQ(mesh.positions[9], (Point{1, 0, 0}));
  EXPECT_EQ((Corners{mesh.corners.end() - 3, mesh.corners.end()}), (Corners{0, 1, 2}));
}

TEST(Gltf, TransformsOfParentsAndChildren) {
  GltfBuilder file = gltf_square();
  file.json["nodes"][0]["translation"] = {1, 2, 3};
  file.json["nodes"][0]["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // x becomes y
  file.json["nodes"][0]["scale"] = {2, 3, 4};
  file.json["nodes"].push_back({{"children", {0}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 100, 0, 0, 1}}});
  const auto mesh = read_glb(file);
  const Point expected[] = {{101, 2, 6}, {101, 4, 6}, {98, 4, 6}, {98, 2, 8}};
  for (std::size_t v = 0; v < 4; ++v)
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(mesh.positions[v][a], expected[v][a], 1e-12) << v;
  EXPECT_EQ(mesh.corners, (Corners{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(dropped(mesh, "nodes without a mesh"), 1U);
}

TEST(Gltf, TranslationsRoundOnce) {
  GltfBuilder file = gltf_square();
  file.json["nodes"][0]["translation"] = {0.1, 0, -0.3};
  const auto mesh = read_glb(file);
  EXPECT_EQ(mesh.positions[2], (Point{1 + 0.1, 1, -0.3}));
  EXPECT_EQ(mesh.positions[3], (Point{0.1, 1, 0.25 - 0.3}));
}

TEST(Gltf, MirroredFacesAreTurned) {
  GltfBuilder file = gltf_square();
  file.json["nodes"][0]["scale"] = {-1, 1, 1};
  const auto mesh = read_glb(file);
  EXPECT_EQ(mesh.positions[1], (Point{-1, 0, 0}));
  EXPECT_EQ(mesh.corners, (Corners{0, 2, 1, 0, 3, 2}));
}

TEST(Gltf, SkinnedMeshesStayAsTheyWereMade) {
  GltfBuilder file = gltf_square();
  file.json["nodes"][0].update({{"scale", {9, 9, 9}}, {"skin", 0}});
  file.json["skins"] = {{{"joints", {0}}}};
  const auto mesh = read_glb(file);
  EXPECT_EQ(mesh.positions[1], (Point{1, 0, 0}));
  EXPECT_EQ(dropped(mesh, "skins"), 1U);
}

TEST(Gltf, ScenesSayWhichNodes) {
  GltfBuilder file = gltf_square();
  file.json["nodes"].push_back({{"mesh", 0}, {"name", "left"}, {"translation", {5, 0, 0}}});
  file.json["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0}}}};
  EXPECT_EQ(read_glb(file).positions.size(), 8U) << "no default scene";
  EXPECT_EQ(dropped(read_glb(file), "which nodes a scene has"), 2U);
  file.json["scene"] = 1;
  const auto one = read_glb(file);
  EXPECT_EQ(one.positions.size(), 4U);
  EXPECT_EQ(dropped(one, "node 'left' outside the scene"), 1U);
  file.json["scenes"].erase(1);
  file.json.erase("scene");
  EXPECT_EQ(read_glb(file).positions[1], (Point{6, 0, 0})) << "the only scene";
}

TEST(Gltf, DeepTreesAreNoProblem) {
  GltfBuilder file = gltf_square();
  constexpr std::size_t kDeep = 100'000;
  for (std::size_t i = 1; i < kDeep; ++i) file.json["nodes"].push_back({{"children", {i - 1}}});
  EXPECT_EQ(read_glb(file).face_count(), 2U);
}

TEST(Gltf, WhatIsNotKeptIsNamed) {
  const auto mesh = read_glb(gltf_sample());
  EXPECT_EQ(mesh.references, (std::vector<std::string>{"texture skin%20a.png"}));
  EXPECT_EQ(dropped(mesh, "bytes of embedded image 'inside'"), 48U);
  EXPECT_EQ(dropped(mesh, "materials that no face has"), 1U);
  EXPECT_EQ(dropped(mesh, "properties of materials"), 1U);
  EXPECT_EQ(dropped(mesh, "nodes without a mesh"), 1U);
  GltfBuilder file = gltf_square();
  Json& json = file.json;
  for (const char* list : {"animations", "cameras", "samplers", "textures"}) json[list] = {Json::object()};
  json["asset"].update({{"generator", "hand"}, {"copyright", "nobody"}});
  json["extras"] = {{"extras", 1}};
  json["nodes"][0].update({{"extras", {1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}, {"X", 1}}}});
  json["nodes"][0]["weights"] = {0, 1};
  json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
  json["meshes"].push_back({{"name", "none"}, {"primitives", Json::array()}});
  const auto more = read_glb(file);
  for (const char* what : {"animations", "cameras", "samplers", "textures", "asset 'generator'", "asset 'copyright'",
                           "extension 'KHR_lights_punctual'", "extension 'X'", "meshes that no node of the scene has"})
    EXPECT_EQ(dropped(more, what), 1U) << what;
  for (const char* what : {"'extras'", "morph targets", "morph weights"}) EXPECT_EQ(dropped(more, what), 2U) << what;
}

TEST(Gltf, ChunksAndBytesBeyondAreNamed) {
  std::string bytes = gltf_square().glb();
  std::string chunk = bytes_of(std::uint32_t{4}) + "MOREdata";
  const auto size = static_cast<std::uint32_t>(bytes.size() + chunk.size());
  const auto mesh = read_text("a.glb", bytes.substr(0, 8) + bytes_of(size) + bytes.substr(12) + chunk + "tail");
  EXPECT_EQ(mesh.face_count(), 2U);
  EXPECT_EQ(dropped(mesh, "chunk 'MORE'"), 1U);
  EXPECT_EQ(dropped(mesh, "bytes behind the file's announced end"), 4U);
}

TEST(Gltf, HarmlessExtensionsMayBeRequired) {
  GltfBuilder file = gltf_square();
  file.json["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_materials_unlit", "KHR_texture_transform"};
  EXPECT_EQ(read_glb(file).face_count(), 2U);
}

}  // namespace
}  // namespace ramcdb::test
