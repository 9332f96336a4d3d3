#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "api/mesh_file/gltf_columns.h"
#include "api/mesh_file/gltf_plan.h"

/// The JSON of glTF that is written: a node and a mesh per object, in it a primitive per material.
namespace ramcdb::mesh_file::gltf {
namespace {

using Json = nlohmann::ordered_json;

enum Target : int { kVertices = 34962, kIndices = 34963 };

int component_type(NumberType type) {
  switch (type) {
    case NumberType::int8:
      return 5120;
    case NumberType::uint8:
      return 5121;
    case NumberType::int16:
      return 5122;
    case NumberType::uint16:
      return 5123;
    case NumberType::uint32:
      return 5125;
    default:
      return 5126;
  }
}

const char* type_word(std::size_t components) {
  constexpr const char* kWords[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  return components == 9 ? "MAT3" : components == 16 ? "MAT4" : kWords[components];
}

class Composer {
 public:
  Composer(const Plan& plan, DroppedCounter& dropped) : plan_(plan), dropped_(dropped) {}

  std::string run(bool embedded) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "ramcdb"}};
    Json buffer{{"byteLength", plan_.length}};
    if (embedded) buffer["uri"] = kDataUri;
    json_["buffers"].push_back(std::move(buffer));
    add_views();
    for (const std::string& name : plan_.groups.materials) json_["materials"].push_back({{"name", utf8(name)}});
    if (plan_.groups.objects.empty()) add_points();
    for (const Object& object : plan_.groups.objects) add_object(object);
    Json nodes = Json::array();
    for (std::size_t i = 0; i < json_["nodes"].size(); ++i) nodes.push_back(i);
    json_["scenes"].push_back(Json{{"nodes", std::move(nodes)}});
    json_["scene"] = 0;
    return json_.dump(-1, ' ', false, Json::error_handler_t::replace);
  }

 private:
  /// Names are UTF-8 in JSON; bytes that are none become replacement characters.
  std::string utf8(const std::string& name) {
    try {
      (void)Json(name).dump();
    } catch (const Json::exception&) {
      dropped_.add("names with bytes that are no UTF-8 (replaced)");
    }
    return name;
  }

  void add_views() {
    const auto add = [&](std::size_t offset, std::size_t length, std::size_t stride, Target target) {
      Json view{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}};
      if (stride) view["byteStride"] = stride;
      view["target"] = static_cast<int>(target);
      json_["bufferViews"].push_back(std::move(view));
    };
    add(0, 12 * plan_.vertices.count, 12, kVertices);
    for (std::size_t i = 0; i < plan_.columns.all().size(); ++i) {
      const std::size_t stride = plan_.columns.all()[i].stride();
      add(plan_.offsets[i], stride * plan_.vertices.count, stride, kVertices);
    }
    if (!plan_.groups.triangles.empty()) add(plan_.indices_offset, plan_.length - plan_.indices_offset, 0, kIndices);
  }

  std::size_t add_accessor(std::size_t view, std::size_t offset, NumberType type, std::size_t count,
                           std::size_t components, bool normalized) {
    Json accessor{{"bufferView", view},
                  {"byteOffset", offset},
                  {"componentType", component_type(type)},
                  {"count", count},
                  {"type", type_word(components)}};
    if (normalized) accessor["normalized"] = true;
    json_["accessors"].push_back(std::move(accessor));
    return json_["accessors"].size() - 1;
  }

  /// Accessors of these vertices, by name; made once where objects share them.
  Json attributes(std::size_t first, std::size_t count) {
    if (!attributes_.empty() && first_ == first && count_ == count) return attributes_;
    attributes_ = Json::object();
    first_ = first;
    count_ = count;
    const std::size_t position = add_accessor(0, 12 * first, NumberType::float32, count, 3, false);
    attributes_["POSITION"] = position;
    add_bounds(json_["accessors"][position], first, count);
    const auto& columns = plan_.columns.all();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const OutColumn& column = columns[c];
      if (has_none(column, plan_.vertices, first, count)) continue;
      if (column.mask && !attributes_.contains(column.name.substr(kMaskName.size()))) continue;
      count_changes(column, plan_.vertices, first, count, dropped_);
      attributes_[utf8(column.name)] =
          add_accessor(1 + c, column.stride() * first, column.type, count, column.components, column.normalized);
    }
    return attributes_;
  }

  void add_bounds(Json& accessor, std::size_t first, std::size_t count) const {
    float least[3], most[3];
    for (int a = 0; a < 3; ++a) {
      least[a] = most[a] = plan_.coordinate(first, a);
      for (std::size_t i = first; i < first + count; ++i) {
        least[a] = std::min(least[a], plan_.coordinate(i, a));
        most[a] = std::max(most[a], plan_.coordinate(i, a));
      }
    }
    // As doubles, whose text is the very number.
    const auto numbers = [](const float(&values)[3]) {
      Json list = Json::array();
      for (const float value : values) list.push_back(static_cast<double>(value));
      return list;
    };
    accessor["min"] = numbers(least);
    accessor["max"] = numbers(most);
  }

  void add_object(const Object& object) {
    Json primitives = Json::array();
    const Json shared = attributes(object.first, object.count);
    for (const Part& part : object.parts) {
      Json primitive{{"attributes", shared}};
      primitive["indices"] = add_accessor(1 + plan_.columns.all().size(), 3 * part.first * size_of(plan_.index_type),
                                          plan_.index_type, 3 * part.count, 1, false);
      if (part.material) primitive["material"] = *part.material;
      primitives.push_back(std::move(primitive));
    }
    add_node(object.name, std::move(primitives));
  }

  /// A mesh without faces.
  void add_points() {
    Json primitives = Json::array();
    primitives.push_back({{"attributes", attributes(0, plan_.vertices.count)}, {"mode", 0}});
    add_node({}, std::move(primitives));
  }

  void add_node(const std::string& name, Json primitives) {
    const std::size_t mesh = json_.contains("meshes") ? json_["meshes"].size() : 0;
    json_["meshes"].push_back(Json{{"primitives", std::move(primitives)}});
    Json node{{"mesh", mesh}};
    if (!name.empty()) node["name"] = utf8(name);
    if (plan_.translation != Point{})
      node["translation"] = {plan_.translation.x, plan_.translation.y, plan_.translation.z};
    json_["nodes"].push_back(std::move(node));
  }

  const Plan& plan_;
  DroppedCounter& dropped_;
  Json json_ = Json::object(), attributes_;
  std::size_t first_ = 0, count_ = 0;  ///< vertices of attributes_
};

}  // namespace

std::string compose_json(const Plan& plan, bool embedded, DroppedCounter& dropped) {
  return Composer(plan, dropped).run(embedded);
}

}  // namespace ramcdb::mesh_file::gltf
