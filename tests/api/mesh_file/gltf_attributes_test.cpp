#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/mesh_file/attribute_names.h"
#include "ramcdb/error.h"
#include "tests/api/mesh_file/gltf_builder.h"

/// Attributes, materials and objects of glTF, in and out.
namespace ramcdb::test {
namespace {

using mesh_file::Scalar;
using testing::ElementsAre;
using testing::HasSubstr;

/// The square with one more attribute.
mesh_file::MeshData with(GltfBuilder file, const char* name, std::size_t accessor, bool normalized = false) {
  file.json["accessors"][accessor]["normalized"] = normalized;
  file.json["meshes"][0]["primitives"][0]["attributes"][name] = accessor;
  return read_glb(file);
}

TEST(GltfAttributes, NamesTypesAndMeanings) {
  const auto mesh = read_glb(gltf_sample());
  struct Expected {
    const char* name;
    AttributeOf of;
    NumberType type;
    int components;
    Meaning meaning;
  };
  const Expected kExpected[] = {{"normal", AttributeOf::vertex, NumberType::float32, 3, Meaning::normal},
                                {"TANGENT", AttributeOf::vertex, NumberType::float32, 4, Meaning::other},
                                {"texture", AttributeOf::vertex, NumberType::float32, 2, Meaning::texture},
                                {"color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color},
                                {"JOINTS_0", AttributeOf::vertex, NumberType::uint8, 4, Meaning::other},
                                {"WEIGHTS_0", AttributeOf::vertex, NumberType::float32, 4, Meaning::other},
                                {"HEAT", AttributeOf::vertex, NumberType::int16, 1, Meaning::other},
                                {"object", AttributeOf::face, NumberType::uint32, 1, Meaning::group},
                                {"material", AttributeOf::face, NumberType::uint32, 1, Meaning::material}};
  ASSERT_EQ(mesh.attributes.size(), std::size(kExpected));
  for (std::size_t i = 0; i < std::size(kExpected); ++i) {
    const AttributeInfo& info = mesh.attributes[i].info;
    EXPECT_EQ(info.name, kExpected[i].name);
    EXPECT_EQ(info.of, kExpected[i].of) << info.name;
    EXPECT_EQ(info.type, kExpected[i].type) << info.name;
    EXPECT_EQ(info.components, kExpected[i].components) << info.name;
    EXPECT_EQ(info.meaning, kExpected[i].meaning) << info.name;
  }
  const auto heat = find(mesh, "HEAT").values;
  EXPECT_EQ((std::vector<double>{heat.begin(), heat.begin() + 4}), (std::vector<double>{-1, 2, -32768, 32767}));
  EXPECT_TRUE(std::isnan(heat[4])) << "the second mesh has none";
  EXPECT_EQ(heat[11], 32767);
  EXPECT_THAT(find(mesh, "object").info.names, ElementsAre("square", "", "again"));
  EXPECT_THAT(find(mesh, "object").values, ElementsAre(0, 0, 1, 1, 2, 2));
  EXPECT_THAT(find(mesh, "material").info.names, ElementsAre("red", "material_2"));
  EXPECT_THAT(find(mesh, "material").values, ElementsAre(0, 0, 1, 1, 0, 0));
}

TEST(GltfAttributes, NormalizedIntegersAreWhatTheyStandFor) {
  GltfBuilder file = gltf_square();
  const auto bytes = file.accessor(
      file.view<std::int8_t>({127, 0, -127, 0, -128, 1, 0, 0, 0, 0, 127, 0, 0, 0, 0, 0}, 4), kByte, "VEC3", 4);
  const auto normal = find(with(file, "NORMAL", bytes, true), "normal");
  EXPECT_EQ(normal.info.type, NumberType::float32);
  EXPECT_EQ(normal.values[2], -1);
  EXPECT_EQ(normal.values[3], -1);
  EXPECT_EQ(normal.values[4], static_cast<double>(static_cast<float>(1.0 / 127)));
  const auto words = file.add<std::uint16_t>({0, 65535, 1, 2, 3, 4, 5, 6}, kUshort, "VEC2");
  const auto texture = find(with(file, "TEXCOORD_0", words, true), "texture");
  EXPECT_EQ(texture.values[1], 1);
  EXPECT_EQ(texture.values[2], static_cast<double>(static_cast<float>(1.0 / 65535)));
  EXPECT_EQ(find(with(file, "TEXCOORD_0", words, false), "texture").values[1], 65535) << "KHR_mesh_quantization";
  const auto color = file.add<std::uint16_t>(std::vector<std::uint16_t>(16, 65535), kUshort, "VEC4");
  const auto kept = find(with(file, "COLOR_0", color, true), "color");
  EXPECT_EQ(kept.info.type, NumberType::uint16);
  EXPECT_EQ(kept.values[0], 65535);
}

TEST(GltfAttributes, TypesThatDiffer) {
  GltfBuilder file = gltf_square();
  const auto bytes = file.add<std::uint8_t>(std::vector<std::uint8_t>(16, 255), kUbyte, "VEC4");
  const auto floats = file.add<float>(std::vector<float>(12, 0.5F), kFloat, "VEC3");
  const auto words = file.add<std::uint32_t>({1, 2, 3, 0xffffffffU}, kUint, "SCALAR");
  const auto small = file.add<std::uint8_t>({1, 2, 3, 4}, kUbyte, "SCALAR");
  file.json["accessors"][bytes]["normalized"] = true;
  file.json["meshes"][0]["primitives"][0]["attributes"].update({{"COLOR_0", bytes}, {"_A", words}});
  file.add_mesh({{"attributes", {{"POSITION", 0}, {"COLOR_0", floats}, {"_A", small}}}});
  const auto mesh = read_glb(file);
  const Attribute color = find(mesh, "color"), a = find(mesh, "A");
  EXPECT_EQ(color.info.type, NumberType::float32);
  EXPECT_EQ(color.values[0], 1);
  EXPECT_EQ(color.values[16], 0.5);
  EXPECT_EQ(color.values[19], 1) << "opaque where there is no alpha";
  EXPECT_EQ(a.info.type, NumberType::float64);
  EXPECT_EQ(a.values[3], 4294967295.0);
}

TEST(GltfAttributes, DirectionsAreTurnedWithTheirNodes) {
  GltfBuilder file = gltf_square();
  const float s = std::sqrt(0.5F);
  const auto normals = file.add<float>({s, s, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, kFloat, "VEC3");
  const auto tangents = file.add<float>({1, 0, 0, 1, s, s, 0, -1, 0, 0, 0, 1, 0, 1, 0, 1}, kFloat, "VEC4");
  file.json["meshes"][0]["primitives"][0]["attributes"].update({{"NORMAL", normals}, {"TANGENT", tangents}});
  file.json["nodes"][0]["translation"] = {1, 2, 3};
  EXPECT_EQ(find(read_glb(file), "normal").values[0], static_cast<double>(s)) << "a translation leaves every bit";
  file.json["nodes"][0]["scale"] = {-2, 1, 1};
  const auto mesh = read_glb(file);
  const auto n = find(mesh, "normal").values, t = find(mesh, "TANGENT").values;
  EXPECT_NEAR(n[0], -1 / std::sqrt(5.0), 1e-7);
  EXPECT_NEAR(n[1], 2 / std::sqrt(5.0), 1e-7);
  EXPECT_EQ(n[6], 0) << "none stays none";
  EXPECT_EQ(t[0], -1);
  EXPECT_NEAR(t[4], -2 / std::sqrt(5.0), 1e-7);
  EXPECT_EQ(t[3], -1) << "a mirror turns the third direction";
  EXPECT_EQ(t[7], 1);
}

TEST(GltfAttributes, NamesOfOthersGoInAndComeOut) {
  GltfBuilder file = gltf_square();
  const auto one = file.add<float>({1, 2, 3, 4}, kFloat, "SCALAR");
  const auto two = file.add<float>({1, 2, 3, 4, 5, 6, 7, 8}, kFloat, "VEC2");
  const auto nine = file.add<float>(std::vector<float>(36, 2), kFloat, "MAT3");
  const auto sixteen = file.add<float>(std::vector<float>(64, 3), kFloat, "MAT4");
  Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
  for (int i = 0; i < 12; ++i) attributes[fmt::format("TEXCOORD_{}", i)] = two;
  attributes.update({{"_A", one},
                     {"_normal", one},
                     {"_color_2", one},
                     {"_JOINTS_0", one},
                     {"__b", one},
                     {"_", one},
                     {"_object", one},
                     {"_nine", nine},
                     {"_sixteen", sixteen},
                     {"_colorful", one}});
  auto mesh = read_glb(file);
  for (const char* name :
       {"A", "_normal", "_color_2", "_JOINTS_0", "_b", "_", "_object", "nine", "sixteen", "colorful"})
    EXPECT_EQ(find(mesh, name).info.meaning, Meaning::other) << name;
  EXPECT_EQ(find(mesh, "texture_11").info.meaning, Meaning::texture);
  auto again = write_and_read("b.glb", output_of(mesh, Scalar::float32), false);
  for (auto* both : {&again.attributes, &mesh.attributes})  // "_" is written as "__", which stands elsewhere
    std::sort(both->begin(), both->end(),
              [](const Attribute& a, const Attribute& b) { return a.info.name < b.info.name; });
  expect_same(again.attributes, mesh.attributes);
}

TEST(GltfAttributes, AllThatIsReadComesBack) {
  auto mesh = read_glb(gltf_sample());
  mesh.references.clear();
  // Vertices without a value, where those of all of an object have none, stay so; a material without a name has one.
  for (const char* name : {"b.glb", "b.gltf"}) {
    const auto again = write_and_read(name, output_of(mesh, Scalar::float64), false);
    EXPECT_EQ(bits(again.positions), bits(mesh.positions));
    EXPECT_EQ(again.corners, mesh.corners);
    expect_same(again.attributes, mesh.attributes);
  }
}

TEST(GltfAttributes, EqualNamesAreKeptApart) {
  GltfBuilder file = gltf_square();
  for (int i = 0; i < 3; ++i) file.json["nodes"].push_back({{"mesh", 0}, {"name", "bolt"}});
  file.json["nodes"].push_back({{"mesh", 0}, {"name", "bolt_2"}});
  file.json["nodes"].push_back({{"mesh", 0}});
  const auto names = find(read_glb(file), "object").info.names;
  EXPECT_THAT(names, ElementsAre("object_0", "bolt", "bolt_3", "bolt_4", "bolt_2", "object_5"));
}

TEST(GltfAttributes, MeshNamesWhereNodesHaveNone) {
  GltfBuilder file = gltf_square();
  file.json["meshes"][0]["name"] = "mesh";
  EXPECT_THAT(find(read_glb(file), "object").info.names, ElementsAre("mesh"));
  file.json["nodes"][0]["name"] = "node";
  const auto mesh = read_glb(file);
  EXPECT_THAT(find(mesh, "object").info.names, ElementsAre("node"));
  EXPECT_EQ(dropped(mesh, "names of meshes whose nodes have names"), 1U);
}

TEST(GltfAttributes, FacesWithoutMaterial) {
  GltfBuilder file = gltf_square();
  file.json["materials"] = {{{"name", "a"}}};
  file.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}});
  const auto mesh = read_glb(file);
  EXPECT_THAT(find(mesh, "material").info.names, ElementsAre("a", ""));
  EXPECT_THAT(find(mesh, "material").values, ElementsAre(1, 1, 0, 0));
  expect_same(write_and_read("b.glb", output_of(mesh, Scalar::float32), false).attributes, mesh.attributes);
}

TEST(GltfAttributes, VertexIdsComeBack) {
  auto mesh = read_glb(gltf_square());
  mesh.vertex_ids = {7, 0xffffffffffffffffU, 0x0123456789abcdefU, 0};
  EXPECT_EQ(write_and_read("b.glb", output_of(mesh, Scalar::float32), false).vertex_ids, mesh.vertex_ids);
}

TEST(GltfAttributes, IdsThatSomeLackAreAnAttribute) {
  GltfBuilder file = gltf_square();
  const auto ids = file.add<std::uint16_t>(std::vector<std::uint16_t>(16, 1), kUshort, "VEC4");
  file.json["meshes"][0]["primitives"][0]["attributes"]["_RAMCDB_ID"] = ids;
  EXPECT_EQ(read_glb(file).vertex_ids, (std::vector<std::uint64_t>(4, 0x0001000100010001U)));
  file.add_mesh({{"attributes", {{"POSITION", 0}}}});
  file.json["nodes"][1]["scale"] = {2, 2, 2};
  const auto mesh = read_glb(file);
  EXPECT_TRUE(mesh.vertex_ids.empty());
  EXPECT_EQ(find(mesh, "RAMCDB_ID").values[0], 1);
}

TEST(GltfAttributes, CornersThatDifferMakeVertices) {
  mesh_file::MeshData mesh = read_glb(gltf_square());
  mesh.attributes = {attribute("texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture,
                               {0, 0, 1, 0, 1, 1, 0, 0, 0.5, 1, 0, 1})};
  std::vector<mesh_file::Dropped> left_out;
  const auto again = write_and_read("b.glb", output_of(mesh, Scalar::float32), false, &left_out);
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_EQ(left_out[0].what, "vertices with corners that differ (written more than once)");
  EXPECT_EQ(left_out[0].count, 1U);
  EXPECT_EQ(again.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 3, 4}));
  EXPECT_EQ(again.positions[3], again.positions[2]);
  EXPECT_THAT(find(again, "texture").values, ElementsAre(0, 0, 1, 0, 1, 1, 0.5, 1, 0, 1));
}

/// A fan of so many triangles around one vertex, every corner with a value of its own.
TEST(GltfAttributes, ManyCornersOfOneVertexTakeNoTime) {
  mesh_file::MeshData mesh;
  constexpr std::uint32_t kFaces = 200'000;
  mesh.positions.assign(3, Point{});
  mesh.positions[1].x = mesh.positions[2].y = 1;
  std::vector<double> values;
  for (std::uint32_t f = 0; f < kFaces; ++f) {
    mesh.corners.insert(mesh.corners.end(), {0, 1, 2});
    for (int c = 0; c < 3; ++c) values.push_back(f);
  }
  mesh.attributes = {attribute("q", AttributeOf::corner, NumberType::float32, 1, Meaning::other, values)};
  std::vector<mesh_file::Dropped> left_out;
  const auto again = write_and_read("b.glb", output_of(mesh, Scalar::float32), false, &left_out);
  EXPECT_EQ(again.positions.size(), 3 * kFaces);
  EXPECT_EQ(find(again, "q").values.at(again.corners[5]), 1);
}

TEST(GltfAttributes, WhatCannotBeHeldIsLeftOutOrSaid) {
  mesh_file::MeshData mesh = read_glb(gltf_square());
  mesh.references = {"mtllib a.mtl"};
  using enum AttributeOf;
  using enum NumberType;
  mesh.attributes = {
      attribute("normal", vertex, float64, 3, Meaning::normal, {0.1, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}),
      attribute("texture", vertex, float64, 3, Meaning::texture, {0, 0, 1, 0, kNan, 1, 0, 0, 1, 0, 0, 1}),
      attribute("color", vertex, int16, 3, Meaning::color, std::vector<double>(12, 32767)),
      attribute("large", vertex, float64, 1, Meaning::other, {1e300, 0, 0, 0}),
      attribute("exact", vertex, int32, 1, Meaning::other, {1 << 24, -5, 0, 1}),
      attribute("inexact", vertex, int32, 1, Meaning::other, {(1 << 24) + 1, 0, 0, 0}),
      attribute("infinite", vertex, float32, 1, Meaning::other, {HUGE_VAL, 1, 2, 3}),
      attribute("none", vertex, float32, 1, Meaning::other, std::vector<double>(4, kNan)),
      attribute("five", vertex, float32, 5, Meaning::other, std::vector<double>(20, 1)),
      attribute("group", face, uint32, 1, Meaning::group, {0, 0}),
      attribute("smoothing", face, uint32, 1, Meaning::other, {1, 2}),
  };
  mesh.attributes[9].info.names = {"g"};
  std::vector<mesh_file::Dropped> left_out;
  const auto again = write_and_read("b.glb", output_of(mesh, Scalar::float32), false, &left_out);
  std::vector<std::string> said;
  for (const auto& d : left_out) said.push_back(fmt::format("{} {}", d.count, d.what));
  EXPECT_THAT(said, testing::UnorderedElementsAre(
                        "4 vertex attribute 'large'", "4 vertex attribute 'inexact'", "4 vertex attribute 'five'",
                        "2 face attribute 'group'", "2 face attribute 'smoothing'", "1 reference 'mtllib a.mtl'",
                        "4 third number of attribute 'texture'",
                        "1 values of attribute 'normal' that are no 32-bit floats (rounded)",
                        "1 vertices without attribute 'texture' (0 to other programs)",
                        "1 values of attribute 'infinite' that are not finite (written as 0)"));
  EXPECT_EQ(find(again, "color").values[0], 1);
  EXPECT_THAT(find(again, "exact").values, ElementsAre(1 << 24, -5, 0, 1));
  EXPECT_EQ(find(again, "infinite").values[0], 0);
  EXPECT_EQ(again.attributes.size(), 5U);
}

TEST(GltfAttributes, NoneStaysNone) {
  mesh_file::MeshData mesh = read_glb(gltf_square());
  mesh.attributes = {
      attribute("color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color,
                {1, 2, 3, kNan, kNan, kNan, 0, 0, 0, 4, 5, 6}),
      attribute("q", AttributeOf::vertex, NumberType::float32, 4, Meaning::other,
                {1, 2, 3, 4, 5, 6, kNan, 8, kNan, 0, 0, 0, 0, 0, 0, kNan}),
  };
  std::vector<mesh_file::Dropped> left_out;
  auto again = write_and_read("b.glb", output_of(mesh, Scalar::float32), false, &left_out);
  expect_same(again.attributes, mesh.attributes);
  EXPECT_EQ(left_out.size(), 2U) << "other programs see 0";
  // Corners without values, where others of the same vertex have some.
  mesh.attributes = {attribute("texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture,
                               {kNan, kNan, 1, 0, 1, 1, 0, 0, 1, 1, kNan, kNan})};
  again = write_and_read("b.gltf", output_of(mesh, Scalar::float32), false, &left_out);
  ASSERT_EQ(again.positions.size(), 5U);
  const auto texture = find(again, "texture");
  for (std::size_t c = 0; c < mesh.corners.size(); ++c)
    for (std::size_t k = 0; k < 2; ++k) {
      const double written = mesh.attributes[0].values[2 * c + k], found = texture.values[2 * again.corners[c] + k];
      EXPECT_TRUE(written == found || (std::isnan(written) && std::isnan(found))) << c;
    }
}

TEST(GltfAttributes, NamesThatAreNoUtf8AreReplaced) {
  mesh_file::MeshData mesh = read_glb(gltf_square());
  mesh.attributes = {attribute("material", AttributeOf::face, NumberType::uint32, 1, Meaning::material, {0, 0})};
  mesh.attributes[0].info.names = {
      "m\xe4"
      "c"};
  std::vector<mesh_file::Dropped> left_out;
  const auto again = write_and_read("b.gltf", output_of(mesh, Scalar::float32), false, &left_out);
  EXPECT_THAT(find(again, "material").info.names, ElementsAre("m\xef\xbf\xbd"
                                                              "c"));
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_THAT(left_out[0].what, HasSubstr("UTF-8"));
}

}  // namespace
}  // namespace ramcdb::test
