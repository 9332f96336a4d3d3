#include "api/mesh_file/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "api/mesh_file/gltf_json.h"
#include "api/mesh_file/gltf_transform.h"

/// The JSON of glTF as plain values. nlohmann-json parses it; a whole glTF loader would not do: tinygltf 2.7 follows
/// "extras" by recursion, opens whatever path a file names, and copies every buffer.
namespace ramcdb::mesh_file::gltf {
namespace {

using Json = nlohmann::json;

constexpr double kLargestWhole = 9007199254740992;  // 2^53: beyond, JSON's numbers are not whole ones any more

/// An object of the file, and what to call it in messages.
class Part {
 public:
  Part(const FileBytes& file, Json& json, std::string name) : file_(file), json_(json), name_(std::move(name)) {
    if (!json.is_object()) throw bad("this is no JSON object");
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] Json& json() const { return json_; }
  [[nodiscard]] Error bad(std::string_view what) const { return bad_part(file_, name_, what); }
  [[nodiscard]] bool has(const char* key) const { return json_.contains(key); }

  [[nodiscard]] std::optional<std::size_t> whole(const char* key) const {
    const auto it = json_.find(key);
    if (it == json_.end()) return std::nullopt;
    return whole_of(*it, key);
  }
  [[nodiscard]] std::size_t whole(const char* key, std::size_t otherwise) const {
    return whole(key).value_or(otherwise);
  }
  [[nodiscard]] std::size_t needed(const char* key) const {
    const auto value = whole(key);
    if (!value) throw bad(fmt::format("'{}' is missing", key));
    return *value;
  }
  [[nodiscard]] std::string text(const char* key) const {
    const auto it = json_.find(key);
    if (it == json_.end()) return {};
    if (!it->is_string()) throw bad(fmt::format("'{}' is no text", key));
    return it->get<std::string>();
  }
  [[nodiscard]] bool flag(const char* key) const {
    const auto it = json_.find(key);
    if (it == json_.end()) return false;
    if (!it->is_boolean()) throw bad(fmt::format("'{}' is neither true nor false", key));
    return it->get<bool>();
  }
  [[nodiscard]] std::vector<Index> indices(const char* key) const {
    std::vector<Index> all;
    if (Json* list = array(key))
      for (const Json& value : *list) all.push_back(whole_of(value, key));
    return all;
  }
  /// So many numbers, or none.
  template <std::size_t n>
  [[nodiscard]] std::optional<std::array<double, n>> numbers(const char* key) const {
    Json* list = array(key);
    if (!list) return std::nullopt;
    std::array<double, n> values{};
    if (list->size() != n) throw bad(fmt::format("'{}' has {} numbers instead of {}", key, list->size(), n));
    for (std::size_t i = 0; i < n; ++i) {
      if (!(*list)[i].is_number()) throw bad(fmt::format("'{}' holds what is no number", key));
      values[i] = (*list)[i].get<double>();
    }
    return values;
  }
  [[nodiscard]] Json* array(const char* key) const {
    const auto it = json_.find(key);
    if (it == json_.end()) return nullptr;
    if (!it->is_array()) throw bad(fmt::format("'{}' is no list", key));
    return &*it;
  }
  [[nodiscard]] Part part(const char* key) const { return {file_, json_.at(key), fmt::format("{} {}", name_, key)}; }
  /// Calls visit(Part) for every object of a list; `kind` names them: "accessor 3".
  template <class Visit>
  void each(const char* key, std::string_view kind, Visit visit) const {
    Json* list = array(key);
    for (std::size_t i = 0; list && i < list->size(); ++i)
      visit(Part(file_, (*list)[i],
                 name_ == "JSON" ? fmt::format("{} {}", kind, i) : fmt::format("{} {} {}", name_, kind, i)));
  }

 private:
  [[nodiscard]] std::size_t whole_of(const Json& value, const char* key) const {
    if (value.is_number_unsigned() && value.get<std::uint64_t>() <= static_cast<std::uint64_t>(kLargestWhole))
      return value.get<std::size_t>();
    if (value.is_number_float()) {  // 3.0, as some write
      const double number = value.get<double>();
      if (number >= 0 && number <= kLargestWhole && number == static_cast<double>(static_cast<std::size_t>(number)))
        return static_cast<std::size_t>(number);
    }
    throw bad(fmt::format("'{}' is no whole number that can be", key));
  }

  const FileBytes& file_;
  Json& json_;
  std::string name_;
};

std::optional<NumberType> number_type(std::size_t component_type) {
  switch (component_type) {
    case 5120:
      return NumberType::int8;
    case 5121:
      return NumberType::uint8;
    case 5122:
      return NumberType::int16;
    case 5123:
      return NumberType::uint16;
    case 5125:
      return NumberType::uint32;
    case 5126:
      return NumberType::float32;
    default:
      return std::nullopt;
  }
}

std::size_t components_of(std::string_view type) {
  constexpr std::pair<std::string_view, std::size_t> kTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                                 {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [name, components] : kTypes)
    if (name == type) return components;
  return 0;
}

bool has_extension(const Part& part, const char* name) {
  const auto it = part.json().find("extensions");
  return it != part.json().end() && it->is_object() && it->contains(name);
}

class DocumentReader {
 public:
  DocumentReader(const FileBytes& file, Json& json, DroppedCounter& dropped)
      : root_(file, json, "JSON"), dropped_(dropped) {}

  Document run() {
    check_asset();
    check_extensions();
    root_.each("buffers", "buffer", [&](const Part& part) { add_buffer(part); });
    root_.each("bufferViews", "buffer view", [&](const Part& part) { add_view(part); });
    root_.each("accessors", "accessor", [&](const Part& part) { add_accessor(part); });
    root_.each("materials", "material", [&](const Part& part) { document_.materials.push_back(part.text("name")); });
    root_.each("meshes", "mesh", [&](const Part& part) { add_mesh(part); });
    root_.each("nodes", "node", [&](const Part& part) { add_node(part); });
    root_.each("images", "image", [&](const Part& part) { add_image(part); });
    choose_roots();
    return std::move(document_);
  }

 private:
  void check_asset() {
    if (!root_.has("asset")) throw root_.bad("'asset' is missing: this is no glTF");
    const Part asset = root_.part("asset");
    const std::string version = asset.text("version");
    if (!version.starts_with("2.")) throw asset.bad(fmt::format("version '{}' is not read, only 2", shown(version)));
  }

  /// Extensions that geometry cannot be read without.
  void check_extensions() {
    Json* required = root_.array("extensionsRequired");
    for (std::size_t i = 0; required && i < required->size(); ++i) {
      if (!(*required)[i].is_string()) throw root_.bad("'extensionsRequired' holds what is no text");
      const auto name = (*required)[i].get<std::string>();
      // Materials, lights and textures do not touch geometry, of which only these are read.
      const bool harmless = name == "KHR_mesh_quantization" || name.starts_with("KHR_materials_") ||
                            name.starts_with("KHR_texture_") || name.starts_with("EXT_texture_") ||
                            name == "KHR_lights_punctual";
      if (!harmless)
        throw root_.bad(
            fmt::format("the file requires the extension {}, which is not read; save it without, with "
                        "'gltf-transform copy' or from Blender",
                        shown(name)));
    }
  }

  void add_buffer(const Part& part) {
    Buffer buffer{part.needed("byteLength"), std::nullopt};
    if (part.has("uri")) {
      (void)part.text("uri");
      buffer.uri = std::move(part.json().at("uri").get_ref<std::string&>());
    }
    document_.buffers.push_back(std::move(buffer));
  }

  void add_view(const Part& part) {
    document_.views.push_back(
        {part.needed("buffer"), part.whole("byteOffset", 0), part.needed("byteLength"), part.whole("byteStride", 0),
         has_extension(part, "EXT_meshopt_compression") || has_extension(part, "KHR_meshopt_compression")});
  }

  void add_accessor(const Part& part) {
    Accessor accessor;
    accessor.view = part.whole("bufferView");
    accessor.offset = part.whole("byteOffset", 0);
    accessor.count = part.needed("count");
    accessor.type = number_type(part.needed("componentType"));
    const std::string type = part.text("type");
    accessor.components = components_of(type);
    accessor.is_matrix = type.starts_with("MAT");
    accessor.normalized = part.flag("normalized");
    if (part.has("sparse")) {
      const Part sparse = part.part("sparse");
      if (!sparse.has("indices") || !sparse.has("values")) throw sparse.bad("'indices' or 'values' are missing");
      const Part indices = sparse.part("indices"), values = sparse.part("values");
      accessor.sparse = Sparse{sparse.needed("count"),        indices.needed("bufferView"),
                               values.needed("bufferView"),   indices.whole("byteOffset", 0),
                               values.whole("byteOffset", 0), number_type(indices.needed("componentType"))};
    }
    document_.accessors.push_back(accessor);
  }

  void add_mesh(const Part& part) {
    Mesh mesh;
    mesh.name = part.text("name");
    part.each("primitives", "primitive", [&](const Part& p) { mesh.primitives.push_back(primitive(p)); });
    document_.meshes.push_back(std::move(mesh));
  }

  Primitive primitive(const Part& part) {
    Primitive primitive;
    primitive.mode = part.whole("mode", 4);
    primitive.indices = part.whole("indices");
    primitive.material = part.whole("material");
    primitive.draco = has_extension(part, "KHR_draco_mesh_compression");
    if (part.has("attributes")) {
      const Part attributes = part.part("attributes");
      for (const auto& [name, value] : attributes.json().items()) {
        const Index accessor = attributes.needed(name.c_str());
        if (name == "POSITION")
          primitive.position = accessor;
        else
          primitive.attributes.emplace_back(name, accessor);
      }
    }
    if (const Json* targets = part.array("targets")) dropped_.add("morph targets", targets->size());
    return primitive;
  }

  void add_node(const Part& part) {
    Node node;
    node.name = part.text("name");
    node.children = part.indices("children");
    node.mesh = part.whole("mesh");
    node.skinned = part.has("skin");
    if (const auto matrix = part.numbers<16>("matrix")) {
      node.matrix = *matrix;
      if (node.matrix[3] != 0 || node.matrix[7] != 0 || node.matrix[11] != 0 || node.matrix[15] != 1)
        throw part.bad("the last row of 'matrix' is not 0 0 0 1");
    } else {
      node.matrix = compose(part.numbers<3>("translation"), part.numbers<4>("rotation"), part.numbers<3>("scale"));
    }
    if (!node.mesh) dropped_.add("nodes without a mesh");
    if (const Json* weights = part.array("weights")) dropped_.add("morph weights", weights->size());
    document_.nodes.push_back(std::move(node));
  }

  void add_image(const Part& part) {
    const std::string uri = part.text("uri");
    if (!uri.empty() && !uri.starts_with("data:")) {
      document_.references.push_back(fmt::format("texture {}", uri));
      return;
    }
    std::size_t bytes = uri.size();
    if (const auto view = part.whole("bufferView"); view && *view < document_.views.size())
      bytes = document_.views[*view].length;
    dropped_.add(fmt::format("bytes of embedded image '{}'", shown(part.text("name"))), bytes);
  }

  /// The default scene's nodes, or those of the only one; else all that are nobody's children.
  void choose_roots() {
    std::vector<std::vector<Index>> scenes;
    root_.each("scenes", "scene", [&](const Part& part) {
      scenes.push_back(part.indices("nodes"));
      for (const Index node : scenes.back())
        if (node >= document_.nodes.size()) throw part.bad(fmt::format("names node {}, which does not exist", node));
    });
    const auto scene = root_.whole("scene");
    if (scene && *scene >= scenes.size()) throw root_.bad(fmt::format("'scene' {} does not exist", *scene));
    if (scene || scenes.size() == 1) {
      document_.roots = std::move(scenes[scene.value_or(0)]);
      return;
    }
    std::vector<bool> is_child(document_.nodes.size());
    for (const Node& node : document_.nodes)
      for (const Index child : node.children)
        if (child < is_child.size()) is_child[child] = true;
    for (Index i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) document_.roots.push_back(i);
  }

  Part root_;
  DroppedCounter& dropped_;
  Document document_;
};

/// Names and counts all that has no place in a mesh: lists of the file, extensions, extras, and what materials say.
class DroppedLists {
 public:
  explicit DroppedLists(DroppedCounter& dropped) : dropped_(dropped) {}

  void run(const Json& root) {
    for (const char* key : {"animations", "cameras", "samplers", "skins", "textures"})
      if (const auto it = root.find(key); it != root.end()) dropped_.add(key, it->size());
    if (const auto asset = root.find("asset"); asset != root.end() && asset->is_object())
      for (const char* key : {"copyright", "generator"})
        if (asset->contains(key)) dropped_.add(fmt::format("asset '{}'", key));
    if (const auto scenes = root.find("scenes"); scenes != root.end() && scenes->size() > 1)
      dropped_.add("which nodes a scene has", scenes->size());
    if (const auto materials = root.find("materials"); materials != root.end())
      for (const Json& material : *materials)
        for (const auto& [key, value] : material.items())
          if (key != "name" && key != "extensions" && key != "extras") dropped_.add("properties of materials");
    walk(root);
  }

 private:
  /// Nesting was limited before; still no recursion.
  void walk(const Json& root) {
    std::vector<const Json*> todo{&root};
    while (!todo.empty()) {
      const Json& json = *todo.back();
      todo.pop_back();
      if (json.is_array()) {
        for (const Json& value : json)
          if (value.is_structured()) todo.push_back(&value);
        continue;
      }
      for (const auto& [key, value] : json.items()) {
        if (key == "extras")
          dropped_.add("'extras'");
        else if (key == "extensions")
          count_extensions(value);
        else if (value.is_structured())
          todo.push_back(&value);
      }
    }
  }

  void count_extensions(const Json& extensions) {
    if (!extensions.is_object()) return;
    for (const auto& [name, value] : extensions.items()) dropped_.add(fmt::format("extension '{}'", shown(name)));
  }

  DroppedCounter& dropped_;
};

Json parse(const FileBytes& file, std::string_view text) {
  const auto offset = static_cast<std::size_t>(text.data() - file.text().data());
  check_json_size(file, text, offset);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw bad_byte(file, offset + std::min(error.byte, text.size()), "this is no JSON, or it is cut off");
  } catch (const Json::exception&) {
    throw bad_byte(file, offset, "the JSON holds a number that is too large");
  }
}

}  // namespace

Error bad_part(const FileBytes& file, std::string_view part, std::string_view what) {
  return Error(Errc::invalid_argument, what, fmt::format("{}, {}", file.name(), part),
               "repair or convert the file; nothing was imported");
}

Document read_document(const FileBytes& file, DroppedCounter& dropped) {
  const Container container = open_container(file, dropped);
  if (container.json.empty()) throw bad_byte(file, 0, "the file holds no JSON");
  Json json = parse(file, container.json);
  Document document = DocumentReader(file, json, dropped).run();
  DroppedLists(dropped).run(json);
  document.binary = container.binary;
  return document;
}

}  // namespace ramcdb::mesh_file::gltf
