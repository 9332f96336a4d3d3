#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>

#include "api/mesh_file/gltf_json.h"
#include "ramcdb/error.h"
#include "tests/api/mesh_file/gltf_builder.h"

/// glTF files that are refused, each with the words that say why and where.
namespace ramcdb::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Bad {
  const char* words;
  const char* place;  ///< in the file
  std::function<void(GltfBuilder&)> spoil;
};

Json& primitive(GltfBuilder& f) { return f.json["meshes"][0]["primitives"][0]; }
Json& accessor(GltfBuilder& f, std::size_t i) { return f.json["accessors"][i]; }
Json& view(GltfBuilder& f, std::size_t i) { return f.json["bufferViews"][i]; }

constexpr std::uint64_t kHuge = 9007199254740992;  // 2^53

std::vector<Bad> bad_files() {
  return {
      // What the file is.
      {"'asset' is missing", "JSON", [](auto& f) { f.json.erase("asset"); }},
      {"version '1.0' is not read", "JSON asset", [](auto& f) { f.json["asset"]["version"] = "1.0"; }},
      {"'version' is no text", "JSON asset", [](auto& f) { f.json["asset"]["version"] = 2; }},
      {"this is no JSON object", "JSON asset", [](auto& f) { f.json["asset"] = 2; }},
      {"this is no JSON object", "JSON", [](auto& f) { f.json = Json::array(); }},
      {"KHR_draco_mesh_compression, which is not read; save it without", "JSON",
       [](auto& f) { f.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }},
      {"EXT_meshopt_compression, which is not read", "JSON",
       [](auto& f) {
         f.json["extensionsRequired"] = {"KHR_mesh_quantization", "EXT_meshopt_compression"};
       }},
      {"'extensionsRequired' holds what is no text", "JSON", [](auto& f) { f.json["extensionsRequired"] = {1}; }},
      {"'extensionsRequired' is no list", "JSON", [](auto& f) { f.json["extensionsRequired"] = "X"; }},
      // Lists.
      {"'nodes' is no list", "JSON", [](auto& f) { f.json["nodes"] = Json::object(); }},
      {"this is no JSON object", "node 1", [](auto& f) { f.json["nodes"].push_back(3); }},
      {"this is no JSON object", "mesh 0 primitive 1", [](auto& f) { f.json["meshes"][0]["primitives"].push_back(1); }},
      {"this is no JSON object", "mesh 0 primitive 0 attributes", [](auto& f) { primitive(f)["attributes"] = 1; }},
      // Numbers.
      {"'count' is missing", "accessor 0", [](auto& f) { accessor(f, 0).erase("count"); }},
      {"'count' is no whole number", "accessor 0", [](auto& f) { accessor(f, 0)["count"] = -1; }},
      {"'count' is no whole number", "accessor 0", [](auto& f) { accessor(f, 0)["count"] = 1.5; }},
      {"'count' is no whole number", "accessor 0", [](auto& f) { accessor(f, 0)["count"] = "4"; }},
      {"'count' is no whole number", "accessor 0", [](auto& f) { accessor(f, 0)["count"] = 1e300; }},
      {"'count' is no whole number", "accessor 0", [](auto& f) { accessor(f, 0)["count"] = 0xffffffffffffffffU; }},
      {"'componentType' is missing", "accessor 1", [](auto& f) { accessor(f, 1).erase("componentType"); }},
      {"'type' is no text", "accessor 1", [](auto& f) { accessor(f, 1)["type"] = 7; }},
      {"'normalized' is neither", "accessor 1", [](auto& f) { accessor(f, 1)["normalized"] = 7; }},
      {"'byteLength' is missing", "buffer view 0", [](auto& f) { view(f, 0).erase("byteLength"); }},
      {"'buffer' is missing", "buffer view 0", [](auto& f) { view(f, 0).erase("buffer"); }},
      // Accessors in views, views in buffers.
      {"do not fit into the 48 bytes", "accessor 0", [](auto& f) { accessor(f, 0)["count"] = 5; }},
      {"do not fit into the 48 bytes", "accessor 0", [](auto& f) { accessor(f, 0)["count"] = kHuge; }},
      {"do not fit into the 48 bytes", "accessor 0", [](auto& f) { accessor(f, 0)["byteOffset"] = 1; }},
      {"do not fit into the 48 bytes", "accessor 0", [](auto& f) { accessor(f, 0)["byteOffset"] = kHuge; }},
      {"do not fit into the 48 bytes", "accessor 0", [](auto& f) { view(f, 0)["byteStride"] = 13; }},
      {"do not fit into the 48 bytes", "accessor 0", [](auto& f) { view(f, 0)["byteStride"] = kHuge; }},
      {"values of 12 bytes stand 4 bytes apart", "accessor 0", [](auto& f) { view(f, 0)["byteStride"] = 4; }},
      {"there is no such buffer view", "buffer view 9", [](auto& f) { accessor(f, 0)["bufferView"] = 9; }},
      {"there is no such buffer", "buffer 1", [](auto& f) { view(f, 0)["buffer"] = 1; }},
      {"of a buffer of 60", "buffer view 1", [](auto& f) { view(f, 1)["byteLength"] = 13; }},
      {"of a buffer of 60", "buffer view 1", [](auto& f) { view(f, 1)["byteOffset"] = kHuge; }},
      {"of a buffer of 60", "buffer view 1", [](auto& f) { view(f, 1)["byteLength"] = kHuge; }},
      {"not one of glTF 2.0", "accessor 0", [](auto& f) { accessor(f, 0)["componentType"] = 5124; }},
      {"not one of glTF 2.0", "accessor 0", [](auto& f) { accessor(f, 0)["type"] = "VEC5"; }},
      {"matrices of integers", "accessor 0",
       [](auto& f) {
         accessor(f, 0).update({{"type", "MAT2"}, {"componentType", kUbyte}});
       }},
      {"are more than a mesh can have", "mesh 0 primitive 0",
       [](auto& f) {
         accessor(f, 0).erase("bufferView");
         accessor(f, 0)["count"] = kHuge;
       }},
      // Sparse accessors.
      {"'indices' or 'values' are missing", "accessor 0 sparse",
       [](auto& f) {
         accessor(f, 0)["sparse"] = {{"count", 1}};
       }},
      {"a sparse value stands at 4, there are 4", "accessor 0",
       [](auto& f) {
         const auto at = f.template view<std::uint8_t>({4});
         accessor(f, 0)["sparse"] = {{"count", 1},
                                     {"indices", {{"bufferView", at}, {"componentType", kUbyte}}},
                                     {"values", {{"bufferView", 0}}}};
       }},
      {"5 values for 4 places", "accessor 0 sparse",
       [](auto& f) {
         accessor(f, 0)["sparse"] = {{"count", 5},
                                     {"indices", {{"bufferView", 0}, {"componentType", kUbyte}}},
                                     {"values", {{"bufferView", 0}}}};
       }},
      {"2 values of 12 bytes do not fit into the 12 bytes", "accessor 0 sparse",
       [](auto& f) {
         accessor(f, 0)["sparse"] = {{"count", 2},
                                     {"indices", {{"bufferView", 0}, {"componentType", kUbyte}}},
                                     {"values", {{"bufferView", 1}}}};
       }},
      {"type of its indices is none", "accessor 0 sparse",
       [](auto& f) {
         accessor(f, 0)["sparse"] = {{"count", 1},
                                     {"indices", {{"bufferView", 0}, {"componentType", kFloat}}},
                                     {"values", {{"bufferView", 0}}}};
       }},
      // Primitives.
      {"there is no such accessor", "accessor 7", [](auto& f) { primitive(f)["attributes"]["POSITION"] = 7; }},
      {"there is no such accessor", "accessor 7", [](auto& f) { primitive(f)["indices"] = 7; }},
      {"there is no such accessor", "accessor 8", [](auto& f) { primitive(f)["attributes"]["NORMAL"] = 8; }},
      {"'NORMAL' is no whole number", "mesh 0 primitive 0 attributes",
       [](auto& f) { primitive(f)["attributes"]["NORMAL"] = "x"; }},
      {"NORMAL has 6 values for 4 vertices", "mesh 0 primitive 0",
       [](auto& f) { primitive(f)["attributes"]["NORMAL"] = 1; }},
      {"positions do not have three numbers", "mesh 0 primitive 0", [](auto& f) { accessor(f, 0)["type"] = "VEC2"; }},
      {"there is no mode 7", "mesh 0 primitive 0", [](auto& f) { primitive(f)["mode"] = 7; }},
      {"are of no type for indices", "mesh 0 primitive 0", [](auto& f) { accessor(f, 1)["componentType"] = kShort; }},
      {"are of no type for indices", "mesh 0 primitive 0",
       [](auto& f) {
         accessor(f, 1).update({{"type", "VEC2"}, {"count", 3}});
       }},
      {"vertex index 3 does not exist (3 vertices)", "mesh 0 primitive 0",
       [](auto& f) { accessor(f, 0)["count"] = 3; }},
      {"vertex index 65535 does not exist", "mesh 0 primitive 0",
       [](auto& f) {
         primitive(f)["indices"] = f.template add<std::uint16_t>({0, 1, 65535}, kUshort, "SCALAR");
       }},
      {"names material 2, which does not exist", "mesh 0 primitive 0", [](auto& f) { primitive(f)["material"] = 2; }},
      {"KHR_draco_mesh_compression, which is not read; save it without", "mesh 0 primitive 0",
       [](auto& f) {
         accessor(f, 0).erase("bufferView");
         primitive(f)["extensions"] = {{"KHR_draco_mesh_compression", {{"bufferView", 0}}}};
       }},
      {"EXT_meshopt_compression, which is not read; save it without", "buffer view 0",
       [](auto& f) {
         view(f, 0)["extensions"] = {{"EXT_meshopt_compression", {{"buffer", 0}}}};
       }},
      // Nodes.
      {"names mesh 5, which does not exist", "node 0", [](auto& f) { f.json["nodes"][0]["mesh"] = 5; }},
      {"there is no such node", "node 5", [](auto& f) { f.json["nodes"][0]["children"] = {5}; }},
      {"below itself or below two others", "node 0",
       [](auto& f) {
         f.json["nodes"][0]["children"] = {0};
         f.json["scenes"] = {{{"nodes", {0}}}};
       }},
      {"below itself or below two others", "node 0",
       [](auto& f) {
         f.json["nodes"].push_back({{"children", {0}}});
         f.json["nodes"].push_back({{"children", {0}}});
       }},
      {"below itself or below two others", "node 0",
       [](auto& f) {
         f.json["scenes"] = {{{"nodes", {0, 0}}}};
       }},
      {"'children' is no whole number", "node 0", [](auto& f) { f.json["nodes"][0]["children"] = {-1}; }},
      {"names node 3, which does not exist", "scene 0",
       [](auto& f) {
         f.json["scenes"] = {{{"nodes", {3}}}};
       }},
      {"'scene' 0 does not exist", "JSON", [](auto& f) { f.json["scene"] = 0; }},
      {"'matrix' has 3 numbers instead of 16", "node 0",
       [](auto& f) {
         f.json["nodes"][0]["matrix"] = {1, 2, 3};
       }},
      {"'rotation' holds what is no number", "node 0",
       [](auto& f) {
         f.json["nodes"][0]["rotation"] = {1, 2, 3, "4"};
       }},
      {"the last row of 'matrix'", "node 0",
       [](auto& f) { f.json["nodes"][0]["matrix"] = std::vector<double>(16, 1); }},
      {"the transform is not finite", "node 1",
       [](auto& f) {
         f.json["nodes"][0].update({{"scale", {1e300, 1, 1}}, {"children", {1}}});
         f.json["nodes"].push_back({{"scale", {1e300, 1, 1}}});
       }},
  };
}

TEST(GltfRefusals, EachSaysWhatAndWhere) {
  for (const Bad& bad : bad_files()) {
    GltfBuilder file = gltf_square();
    bad.spoil(file);
    SCOPED_TRACE(fmt::format("{} ({})", bad.words, bad.place));
    if (file.json.is_array()) {
      EXPECT_THAT(refusal("a.gltf", "[]"), HasSubstr(bad.words));
      continue;
    }
    const std::string expected = fmt::format("a.glb, {}): ", bad.place);
    EXPECT_THAT(refusal("a.glb", file.glb()), AllOf(HasSubstr(bad.words), HasSubstr(expected)));
  }
}

TEST(GltfRefusals, CoordinatesThatAreNotFinite) {
  for (const float number : {HUGE_VALF, -HUGE_VALF, NAN}) {
    GltfBuilder file;
    file.add_mesh({{"attributes", {{"POSITION", file.add<float>({0, 0, 0, 1, number, 0}, kFloat, "VEC3")}}}});
    EXPECT_THAT(refusal("a.glb", file.glb()), HasSubstr("vertex 1 has a coordinate that is not finite"));
  }
  GltfBuilder file = gltf_square();
  file.json["nodes"][0]["matrix"] = {1e308, 1e308, 0, 0, 1e308, 1, 0, 0, 0, 0, 1, 0, 1e308, 0, 0, 1};
  EXPECT_THAT(refusal("a.glb", file.glb()), HasSubstr("not finite"));
}

TEST(GltfRefusals, NoVertex) {
  EXPECT_THAT(refusal("a.gltf", R"({"asset":{"version":"2.0"}})"), HasSubstr("holds no vertex"));
  GltfBuilder file = gltf_square();
  file.json["meshes"][0]["primitives"][0]["attributes"].erase("POSITION");
  EXPECT_THAT(refusal("a.glb", file.glb()), HasSubstr("holds no vertex"));
  file = gltf_square();
  file.json["accessors"][0]["count"] = 0;
  file.json["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_THAT(refusal("a.glb", file.glb()), HasSubstr("holds no vertex"));
}

TEST(GltfRefusals, ContainersThatAreBroken) {
  const std::string good = gltf_square().glb();
  const auto word = [&](std::size_t at, std::uint32_t value) {
    std::string bytes = good;
    return bytes.replace(at, 4, bytes_of(value));
  };
  EXPECT_THAT(refusal("a.glb", word(4, 1)), HasSubstr("version 1 is not read"));
  EXPECT_THAT(refusal("a.glb", word(8, 0xffffffff)), HasSubstr("is cut off: it announces 4294967295 bytes"));
  EXPECT_THAT(refusal("a.glb", word(8, 12)), HasSubstr("announces 12 bytes"));
  EXPECT_THAT(refusal("a.glb", word(12, 0xffffffff)), HasSubstr("a chunk announces 4294967295 bytes"));
  EXPECT_THAT(refusal("a.glb", word(16, 0)), HasSubstr("the first chunk is"));
  EXPECT_THAT(refusal("a.glb", word(8, static_cast<std::uint32_t>(good.size() - 62))),
              HasSubstr("cut off in the head"));
  EXPECT_THAT(refusal("a.glb", good.substr(0, 15)), HasSubstr("cut off"));
  EXPECT_THAT(refusal("a.glb", glb_of("", "")), HasSubstr("holds no JSON"));
  EXPECT_THAT(refusal("a.glb", ""), HasSubstr("holds no JSON"));
  EXPECT_THAT(refusal("a.gltf", "OFF\n3 0 0"), HasSubstr("no JSON"));
  EXPECT_THAT(refusal("a.gltf", "{\"asset\": \"\xff\"}"), HasSubstr("no JSON"));
  EXPECT_THAT(refusal("a.gltf", "{\"asset\": 1e999}"), HasSubstr("too large"));
}

TEST(GltfRefusals, BuffersThatAreTooShort) {
  GltfBuilder file = gltf_square();
  const auto with = [&](Json buffers) {
    Json whole = file.json;
    whole["buffers"] = std::move(buffers);
    return glb_of(whole.dump(), file.binary());
  };
  EXPECT_THAT(refusal("a.glb", with({{{"byteLength", 61}}})), HasSubstr("61 bytes announced, 60 there"));
  EXPECT_THAT(refusal("a.glb", with({{{"byteLength", kHuge}}})), HasSubstr("60 there (")) << "no overflow";
  EXPECT_THAT(refusal("a.glb", with({{{"byteLength", 60}, {"uri", "data:;base64,AAAA"}}})), HasSubstr("3 there"));
  EXPECT_THAT(refusal("a.glb", with({{{"byteLength", 60}, {"uri", 5}}})), HasSubstr("'uri' is no text"));
  EXPECT_THAT(refusal("a.glb", with({{{"byteLength", 8}}})), HasSubstr("of a buffer of 8"));
  EXPECT_THAT(refusal("a.glb", with(Json::array())), HasSubstr("there is no such buffer"));
  for (Json& view : file.json["bufferViews"]) view["buffer"] = 1;
  EXPECT_THAT(refusal("a.glb", with({{{"byteLength", 60}}, {{"byteLength", 60}}})),
              HasSubstr("the buffer has no data"));
}

TEST(GltfRefusals, JsonThatWouldTakeTheMemory) {
  using namespace mesh_file::gltf;
  const std::string deep(kDeepestJson + 1, '[');
  EXPECT_THAT(refusal("a.gltf", R"({"extras":)" + deep), HasSubstr("nests deeper than 128"));
  EXPECT_THAT(refusal("a.gltf", std::string(10'000'000, '[')), HasSubstr("nests deeper"));
  EXPECT_THAT(refusal("a.gltf", R"({"extras":[)" + std::string(kMostJsonValues, ',')), HasSubstr("more than 16777216"));
  // Brackets in texts are none.
  GltfBuilder file = gltf_square();
  file.json["extras"] = std::string(500, '[') + "\"\\";
  EXPECT_EQ(read_text("a.glb", file.glb()).face_count(), 2U);
}

TEST(GltfRefusals, SmallFilesThatAnnounceLargeMeshes) {
  GltfBuilder file = gltf_square();
  Json& positions = file.json["accessors"][0];
  positions.erase("bufferView");
  positions["count"] = 0xfffffff0U;
  EXPECT_THAT(refusal("a.glb", file.glb()), HasSubstr("4294967280 vertices and 2 faces in a file of"));
  // As many instances as the file has room for, each of as many zeros.
  positions["count"] = 1'000'000;
  for (int i = 0; i < 100; ++i) file.json["nodes"].push_back({{"mesh", 0}});
  EXPECT_THAT(refusal("a.glb", file.glb()), HasSubstr("101000000 vertices"));
  positions["count"] = 4;
  file.json["accessors"][1].erase("bufferView");
  file.json["accessors"][1]["count"] = 0xffffffffU;
  EXPECT_THAT(refusal("a.glb", file.glb()), HasSubstr("faces in a file of"));
}

/// Many attributes for few vertices each, many blocks on one accessor, many equal names: none takes quadratic time.
TEST(GltfRefusals, ManyOfEverythingTakesNoTime) {
  const auto begin = std::chrono::steady_clock::now();
  GltfBuilder file = gltf_square();
  Json& primitives = file.json["meshes"][0]["primitives"];
  for (std::size_t i = 0; i < 20'000; ++i) {
    file.json["accessors"].push_back(file.json["accessors"][0]);
    primitives.push_back({{"attributes", {{"POSITION", 0}, {"NORMAL", 2 + i}}}, {"indices", 1}});
    file.json["nodes"].push_back({{"mesh", 1}, {"name", "x"}});
  }
  file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}});
  const auto mesh = read_text("a.glb", file.glb());
  EXPECT_EQ(mesh.face_count(), 2U + 2 * 40'000);
  EXPECT_EQ(find(mesh, "object").info.names.back(), "x_20000");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace ramcdb::test
