#include <fmt/format.h>

#include <algorithm>

#include "api/mesh_file/writers.h"

namespace ramcdb::mesh_file {
namespace {

const char* type_name(NumberType type) {
  constexpr const char* kNames[] = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  return kNames[static_cast<std::size_t>(type) - 1];
}

/// The names that the components of an attribute get.
std::vector<std::string> fields_of(const AttributeInfo& info) {
  if (info.fields.size() == info.components) return info.fields;
  static const std::vector<std::string> kColor{"red", "green", "blue", "alpha"}, kNormal{"nx", "ny", "nz"},
      kTexture{"u", "v", "w"};
  const auto& customary = info.meaning == Meaning::color    ? kColor
                          : info.meaning == Meaning::normal ? kNormal
                                                            : kTexture;
  const bool known =
      info.meaning == Meaning::color || info.meaning == Meaning::normal || info.meaning == Meaning::texture;
  if (known && info.components <= customary.size()) return {customary.begin(), customary.begin() + info.components};
  if (info.components == 1) return {info.name};
  std::vector<std::string> fields;
  for (unsigned k = 0; k < info.components; ++k) fields.push_back(fmt::format("{}_{}", info.name, k));
  return fields;
}

std::string field_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c <= ' ' || c == 127; }, '_');
  return name.empty() ? "_" : name;
}

void write_binary(NewFile& out, NumberType type, double number) {
  if (number != number && !is_float(type)) number = 0;
  switch (type) {
    case NumberType::int8:
      return out.binary(static_cast<std::int8_t>(number));
    case NumberType::uint8:
      return out.binary(static_cast<std::uint8_t>(number));
    case NumberType::int16:
      return out.binary(static_cast<std::int16_t>(number));
    case NumberType::uint16:
      return out.binary(static_cast<std::uint16_t>(number));
    case NumberType::int32:
      return out.binary(static_cast<std::int32_t>(number));
    case NumberType::uint32:
      return out.binary(static_cast<std::uint32_t>(number));
    case NumberType::float32:
      return out.binary(static_cast<float>(number));
    case NumberType::float64:
      return out.binary(number);
  }
}

class PlyWriter {
 public:
  PlyWriter(NewFile& out, const MeshOutput& mesh, bool ascii) : out_(out), mesh_(mesh), ascii_(ascii) {
    for (const Attribute& attribute : mesh.attributes) {
      const bool hidden = !mesh.face_colors.empty() && attribute.info.of == AttributeOf::face &&
                          attribute.info.meaning == Meaning::color;
      if (hidden)
        dropped_.push_back(dropped_attribute(attribute));
      else if (attribute.info.of == AttributeOf::vertex)
        of_vertices_.push_back(&attribute);
      else if (attribute.info.of == AttributeOf::face)
        of_faces_.push_back(&attribute);
      else if (attribute.info.meaning == Meaning::texture && !texture_)
        texture_ = &attribute;
      else
        dropped_.push_back(dropped_attribute(attribute));
      if (!attribute.info.names.empty() && !hidden)
        dropped_.push_back({fmt::format("names of '{}'", attribute.info.name), attribute.info.names.size()});
    }
  }

  std::vector<Dropped> run() {
    write_header();
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) write_vertex(v);
    for_each_face(mesh_, [&](std::size_t f, std::span<const std::uint32_t> face, std::size_t first) {
      write_face(f, face, first);
    });
    return std::move(dropped_);
  }

 private:
  void write_header() {
    out_.text(fmt::format("ply\nformat {} 1.0\n", ascii_ ? "ascii" : "binary_little_endian"));
    for (const std::string& reference : mesh_.references) {
      if (reference.starts_with("texture "))
        out_.text(fmt::format("comment TextureFile {}\n", reference.substr(8)));
      else
        out_.text(fmt::format("comment {}\n", reference));
    }
    out_.text(fmt::format("element vertex {}\n", mesh_.positions.size()));
    for (const char axis : {'x', 'y', 'z'})
      out_.text(fmt::format("property {} {}\n", mesh_.scalar == Scalar::float32 ? "float" : "double", axis));
    for (const Attribute* attribute : of_vertices_) declare(attribute->info);
    if (!mesh_.vertex_ids.empty()) out_.text("property uint ramcdb_id_hi\nproperty uint ramcdb_id_lo\n");
    const auto most =
        mesh_.face_sizes.empty() ? 3U : *std::max_element(mesh_.face_sizes.begin(), mesh_.face_sizes.end());
    long_lists_ = most > 255;
    const unsigned corners = texture_ ? most * texture_->info.components : most;
    long_textures_ = corners > 255;
    out_.text(fmt::format("element face {}\nproperty list {} int vertex_indices\n", face_count(mesh_),
                          long_lists_ ? "uint" : "uchar"));
    if (!mesh_.face_colors.empty()) out_.text("property uchar red\nproperty uchar green\nproperty uchar blue\n");
    if (texture_)
      out_.text(fmt::format("property list {} {} texcoord\n", long_textures_ ? "uint" : "uchar",
                            type_name(texture_->info.type)));
    for (const Attribute* attribute : of_faces_) declare(attribute->info);
    out_.text("end_header\n");
  }

  void declare(const AttributeInfo& info) {
    for (const std::string& field : fields_of(info))
      out_.text(fmt::format("property {} {}\n", type_name(info.type), field_name(field)));
  }

  void write_vertex(std::size_t v) {
    const NumberType type = mesh_.scalar == Scalar::float32 ? NumberType::float32 : NumberType::float64;
    for (int a = 0; a < 3; ++a) put(type, mesh_.positions[v][a]);
    for (const Attribute* attribute : of_vertices_) put(*attribute, v);
    if (!mesh_.vertex_ids.empty()) {
      put(NumberType::uint32, static_cast<double>(mesh_.vertex_ids[v] >> 32));
      put(NumberType::uint32, static_cast<double>(mesh_.vertex_ids[v] & 0xffffffffU));
    }
    end_line();
  }

  void write_face(std::size_t f, std::span<const std::uint32_t> face, std::size_t first) {
    put(long_lists_ ? NumberType::uint32 : NumberType::uint8, static_cast<double>(face.size()));
    for (const std::uint32_t v : face) put(NumberType::uint32, v);
    if (!mesh_.face_colors.empty())
      for (const std::uint8_t level : {mesh_.face_colors[f].r, mesh_.face_colors[f].g, mesh_.face_colors[f].b})
        put(NumberType::uint8, level);
    if (texture_) {
      put(long_textures_ ? NumberType::uint32 : NumberType::uint8,
          static_cast<double>(face.size() * texture_->info.components));
      for (std::size_t i = 0; i < face.size(); ++i) put(*texture_, first + i);
    }
    for (const Attribute* attribute : of_faces_) put(*attribute, f);
    end_line();
  }

  void put(const Attribute& attribute, std::size_t at) {
    for (const double number : value_of(attribute, at)) put(attribute.info.type, number);
  }

  void put(NumberType type, double number) {
    if (!ascii_) return write_binary(out_, type, number);
    if (!at_line_begin_) out_.text(" ");
    at_line_begin_ = false;
    write_number(out_, type, number);
  }

  void end_line() {
    if (ascii_) out_.text("\n");
    at_line_begin_ = true;
  }

  NewFile& out_;
  const MeshOutput& mesh_;
  bool ascii_, at_line_begin_ = true, long_lists_ = false, long_textures_ = false;
  std::vector<const Attribute*> of_vertices_, of_faces_;
  const Attribute* texture_ = nullptr;
  std::vector<Dropped> dropped_;
};

}  // namespace

std::vector<Dropped> write_ply(NewFile& out, const MeshOutput& mesh, bool ascii) {
  return PlyWriter(out, mesh, ascii).run();
}

}  // namespace ramcdb::mesh_file
