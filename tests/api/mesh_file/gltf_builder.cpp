#include "tests/api/mesh_file/gltf_builder.h"

namespace ramcdb::test {

std::size_t GltfBuilder::view_of_bytes(const std::string& bytes, std::size_t stride) {
  binary_.resize((binary_.size() + 3) / 4 * 4);
  Json view{{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (stride) view["byteStride"] = stride;
  binary_ += bytes;
  json["bufferViews"].push_back(view);
  return json["bufferViews"].size() - 1;
}

std::size_t GltfBuilder::accessor(std::size_t view, int type, const char* shape, std::size_t count) {
  json["accessors"].push_back(Json{{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
  return json["accessors"].size() - 1;
}

Json& GltfBuilder::add_mesh(Json primitive) {
  json["meshes"].push_back(Json{{"primitives", Json::array({std::move(primitive)})}});
  json["nodes"].push_back(Json{{"mesh", json["meshes"].size() - 1}});
  return json["nodes"].back();
}

std::string GltfBuilder::glb() const {
  Json whole = json;
  whole["buffers"] = Json::array({Json{{"byteLength", binary_.size()}}});
  return glb_of(whole.dump(), binary_);
}

std::string GltfBuilder::gltf(const std::string& uri) const {
  Json whole = json;
  whole["buffers"] = Json::array({Json{
      {"byteLength", binary_.size()},
      {"uri", uri.empty() ? "data:application/octet-stream;base64," + base64(binary_) : uri},
  }});
  return whole.dump();
}

std::size_t GltfBuilder::components(std::string_view shape) {
  return shape == "SCALAR" ? 1 : shape == "MAT3" ? 9 : shape == "MAT4" ? 16 : static_cast<std::size_t>(shape[3] - '0');
}

std::string glb_of(const std::string& json_text, const std::string& binary) {
  const auto padded = [](std::string bytes, char with) {
    bytes.resize((bytes.size() + 3) / 4 * 4, with);
    return bytes;
  };
  const std::string json = padded(json_text, ' '), bytes = padded(binary, '\0');
  const auto size = [](const std::string& text) { return bytes_of(static_cast<std::uint32_t>(text.size())); };
  std::string chunks = size(json) + "JSON" + json;
  if (!bytes.empty()) chunks += size(bytes) + std::string("BIN\0", 4) + bytes;
  return "glTF" + bytes_of(std::uint32_t{2}) + bytes_of(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

GltfBuilder gltf_square() {
  GltfBuilder file;
  const auto positions = file.add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.25F}, kFloat, "VEC3");
  const auto indices = file.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, kUshort, "SCALAR");
  file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  return file;
}

GltfBuilder gltf_sample() {
  GltfBuilder file = gltf_square();
  Json& json = file.json;
  const auto normals = file.add<float>({0, 0, 1, 0, 0, 1, 0, 1, 0, 1, 0, 0}, kFloat, "VEC3");
  const auto tangents = file.add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1, 0, 1, 0, 1}, kFloat, "VEC4");
  const auto texture = file.accessor(file.view<float>({0, 0, 9, 1, 0, 9, 1, 1, 9, 0, 1, 9}, 12), kFloat, "VEC2", 4);
  const auto color =
      file.accessor(file.view<std::uint8_t>({1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 255, 0, 9, 0}, 4), kUbyte, "VEC3", 4);
  json["accessors"][color]["normalized"] = true;
  const auto joints = file.add<std::uint8_t>({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, kUbyte, "VEC4");
  const auto weights = file.add<float>(std::vector<float>(16, 0.25F), kFloat, "VEC4");
  const auto heat = file.add<std::int16_t>({-1, 2, -32768, 32767}, kShort, "SCALAR");
  Json& first = json["meshes"][0]["primitives"][0];
  first["attributes"].update({{"NORMAL", normals},
                              {"TANGENT", tangents},
                              {"TEXCOORD_0", texture},
                              {"COLOR_0", color},
                              {"JOINTS_0", joints},
                              {"WEIGHTS_0", weights},
                              {"_HEAT", heat}});
  first["material"] = 1;
  json["materials"] = {{{"name", "unused"}}, {{"name", "red"}}, {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}};
  const auto sparse = file.accessor(0, kFloat, "VEC3", 4);
  json["accessors"][sparse]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", file.view<std::uint8_t>({2})}, {"componentType", kUbyte}}},
      {"values", {{"bufferView", file.view<float>({0.5F, 0.5F, 2})}}}};
  file.add_mesh({{"attributes", {{"POSITION", sparse}}}, {"mode", 5}, {"material", 2}});
  json["nodes"][0]["name"] = "square";
  json["nodes"][1].update({{"translation", {10, 0, 0.5}}, {"scale", {-1, 2, 1}}});
  json["nodes"].push_back({{"name", "again"}, {"mesh", 0}, {"rotation", {0, 0, 1, 0}}});
  json["nodes"].push_back({{"children", {1, 2}}});
  json["scenes"] = {{{"nodes", {0, 3}}}};
  json["scene"] = 0;
  json["images"] = {{{"uri", "skin%20a.png"}}, {{"name", "inside"}, {"bufferView", 0}, {"mimeType", "image/png"}}};
  return file;
}

}  // namespace ramcdb::test
