#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "api/mesh_file/writers.h"

/// PLY, text or little-endian: x, y, z, ids and attributes of vertices; corners, texture coordinates of corners, and
/// colours and attributes of faces.
namespace ramcdb::mesh_file {
namespace {

static_assert(std::endian::native == std::endian::little, "byte order of STL and PLY writers");

/// Names of the properties of one element: words, no two equal.
class PropertyNames {
 public:
  explicit PropertyNames(std::vector<std::string> taken) : taken_(std::move(taken)) {}

  std::string unique(std::string_view wanted) {
    std::string word(wanted.empty() ? "unnamed" : wanted);
    for (char& c : word)
      if (static_cast<unsigned char>(c) <= ' ') c = '_';
    std::string name = word;
    for (int i = 2; std::find(taken_.begin(), taken_.end(), name) != taken_.end(); ++i)
      name = fmt::format("{}_{}", word, i);
    taken_.push_back(name);
    return name;
  }

 private:
  std::vector<std::string> taken_;
};

/// One scalar property: a component of an attribute.
struct Column {
  std::string name;
  NumberType type = NumberType::float32;
  const AttributeView* attribute = nullptr;
  std::size_t component = 0;

  [[nodiscard]] double value(std::size_t i) const {
    return attribute->values[i * attribute->info.components + component];
  }
};

/// Texture coordinates of corners: a list that stands before this column of faces.
struct Texcoord {
  const AttributeView* attribute = nullptr;
  std::size_t before = 0;

  [[nodiscard]] bool at(std::size_t column) const { return attribute && column == before; }
};

const char* type_name(NumberType type) {
  constexpr const char* kNames[] = {"", "char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  return kNames[static_cast<std::size_t>(type)];
}

/// Numbers as text, with blanks between them and lines, or as bytes.
class PlyBody {
 public:
  PlyBody(NewFile& out, bool ascii) : out_(out), ascii_(ascii) {}

  void put(double value, NumberType type) {
    if (type < NumberType::float32 && std::isnan(value)) value = 0;
    if (!ascii_) return put_bytes(value, type);
    blank();
    out_.number(value, type);
  }
  /// Of a type of one or four bytes.
  void put_whole(std::uint32_t value, NumberType type) {
    if (!ascii_) return type == NumberType::uint8 ? out_.binary(static_cast<std::uint8_t>(value)) : out_.binary(value);
    blank();
    out_.whole(value);
  }
  void end_line() {
    if (ascii_) out_.text("\n");
    first_ = true;
  }

 private:
  void blank() {
    if (!first_) out_.text(" ");
    first_ = false;
  }

  void put_bytes(double value, NumberType type) {
    switch (type) {
      case NumberType::int8:
        return out_.binary(static_cast<std::int8_t>(value));
      case NumberType::uint8:
        return out_.binary(static_cast<std::uint8_t>(value));
      case NumberType::int16:
        return out_.binary(static_cast<std::int16_t>(value));
      case NumberType::uint16:
        return out_.binary(static_cast<std::uint16_t>(value));
      case NumberType::int32:
        return out_.binary(static_cast<std::int32_t>(value));
      case NumberType::uint32:
        return out_.binary(static_cast<std::uint32_t>(value));
      case NumberType::float32:
        return out_.binary(static_cast<float>(value));
      case NumberType::float64:
        return out_.binary(value);
    }
  }

  NewFile& out_;
  bool ascii_;
  bool first_ = true;
};

class PlyWriter {
 public:
  PlyWriter(NewFile& out, const MeshOutput& mesh, bool ascii, DroppedCounter& dropped)
      : out_(out), mesh_(mesh), ascii_(ascii), dropped_(dropped), body_(out, ascii) {
    if (!mesh.face_colors.empty())
      for (const char* name : {"red", "green", "blue"}) face_names_.unique(name);
    for (const char* name : kIdHalves) vertex_names_.unique(name);  // no attribute is to pass for ids
    for (const AttributeView& attribute : mesh.attributes) place(attribute);
    std::uint32_t most = 3;
    for (const std::uint32_t size : mesh.face_sizes) most = std::max(most, size);
    size_type_ = most <= kMostUchar ? NumberType::uint8 : NumberType::uint32;
    texcoord_size_type_ = most <= kMostUchar / 2 ? NumberType::uint8 : NumberType::uint32;
  }

  void run() {
    write_header();
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) write_vertex(v);
    FaceWalk walk(mesh_);
    for (std::size_t f = 0; f < face_count(mesh_); ++f) {
      const auto [begin, end] = walk.next();
      write_face(f, begin, end);
    }
  }

 private:
  static constexpr std::uint32_t kMostUchar = 255;
  static constexpr const char* kIdHalves[] = {"ramcdb_id_hi", "ramcdb_id_lo"};

  void place(const AttributeView& attribute) {
    const AttributeInfo& info = attribute.info;
    if (info.of == AttributeOf::corner) {
      if (texcoord_.attribute || info.meaning != Meaning::texture || info.components != 2 || !is_float(info.type))
        drop_attribute(dropped_, attribute);
      else
        texcoord_ = {&attribute, face_columns_.size()};
      return;
    }
    const bool of_face = info.of == AttributeOf::face;
    if (of_face && info.meaning == Meaning::color && !mesh_.face_colors.empty())
      return drop_attribute(dropped_, attribute);  // painted over
    const auto fields = info.fields.empty() ? customary_fields(info) : info.fields;
    for (std::size_t c = 0; c < info.components; ++c)
      (of_face ? face_columns_ : vertex_columns_)
          .push_back({(of_face ? face_names_ : vertex_names_).unique(fields[c]), info.type, &attribute, c});
    drop_names(dropped_, attribute);
    if (is_float(info.type)) return;
    const auto missing =
        std::count_if(attribute.values.begin(), attribute.values.end(), [](double value) { return std::isnan(value); });
    dropped_.add(fmt::format("missing values of attribute '{}', written as 0", shown(info.name)),
                 static_cast<std::uint64_t>(missing));
  }

  void write_header() {
    out_.text(fmt::format("ply\nformat {} 1.0\n", ascii_ ? "ascii" : "binary_little_endian"));
    for (const std::string& reference : mesh_.references) write_reference(reference);
    out_.text(fmt::format("element vertex {}\n", mesh_.positions.size()));
    for (const char* axis : {"x", "y", "z"}) property(axis, number_type(mesh_.scalar));
    if (!mesh_.vertex_ids.empty())
      for (const char* half : kIdHalves) property(half, NumberType::uint32);
    for (const Column& column : vertex_columns_) property(column.name, column.type);
    out_.text(fmt::format("element face {}\nproperty list {} int vertex_indices\n", face_count(mesh_),
                          type_name(size_type_)));
    if (!mesh_.face_colors.empty())
      for (const char* name : {"red", "green", "blue"}) property(name, NumberType::uint8);
    for (std::size_t i = 0; i <= face_columns_.size(); ++i) {
      if (texcoord_.at(i))
        out_.text(fmt::format("property list {} {} texcoord\n", type_name(texcoord_size_type_),
                              type_name(texcoord_.attribute->info.type)));
      if (i < face_columns_.size()) property(face_columns_[i].name, face_columns_[i].type);
    }
    out_.text("end_header\n");
  }

  void write_reference(std::string_view reference) {
    constexpr std::string_view kTexture = "texture ";
    if (is_one_line(reference) && reference.starts_with(kTexture))
      out_.text(fmt::format("comment TextureFile {}\n", reference.substr(kTexture.size())));
    else
      drop_reference(dropped_, reference);
  }

  void property(std::string_view name, NumberType type) {
    out_.text(fmt::format("property {} {}\n", type_name(type), name));
  }

  void write_vertex(std::size_t v) {
    for (int a = 0; a < 3; ++a) body_.put(mesh_.positions[v][a], number_type(mesh_.scalar));
    if (!mesh_.vertex_ids.empty()) {
      body_.put_whole(static_cast<std::uint32_t>(mesh_.vertex_ids[v] >> 32), NumberType::uint32);
      body_.put_whole(static_cast<std::uint32_t>(mesh_.vertex_ids[v]), NumberType::uint32);
    }
    for (const Column& column : vertex_columns_) body_.put(column.value(v), column.type);
    body_.end_line();
  }

  void write_face(std::size_t f, std::size_t begin, std::size_t end) {
    body_.put_whole(static_cast<std::uint32_t>(end - begin), size_type_);
    for (std::size_t c = begin; c < end; ++c) body_.put_whole(mesh_.corners[c], NumberType::uint32);
    if (!mesh_.face_colors.empty()) {
      const FaceColor color = mesh_.face_colors[f];
      for (const std::uint8_t value : {color.r, color.g, color.b}) body_.put_whole(value, NumberType::uint8);
    }
    for (std::size_t i = 0; i <= face_columns_.size(); ++i) {
      if (texcoord_.at(i)) write_texcoord(begin, end);
      if (i == face_columns_.size()) break;
      const Column& column = face_columns_[i];
      body_.put(column.value(f), column.type);
    }
    body_.end_line();
  }

  /// A face none of whose corners has texture coordinates has an empty list.
  void write_texcoord(std::size_t begin, std::size_t end) {
    const auto values = std::span(texcoord_.attribute->values).subspan(2 * begin, 2 * (end - begin));
    const bool none = std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
    body_.put_whole(none ? 0 : static_cast<std::uint32_t>(values.size()), texcoord_size_type_);
    if (none) return;
    for (const double value : values) body_.put(value, texcoord_.attribute->info.type);
  }

  NewFile& out_;
  const MeshOutput& mesh_;
  bool ascii_;
  DroppedCounter& dropped_;
  PlyBody body_;
  PropertyNames vertex_names_{{"x", "y", "z"}};
  PropertyNames face_names_{{"vertex_indices", "vertex_index", "texcoord"}};
  std::vector<Column> vertex_columns_, face_columns_;
  Texcoord texcoord_;
  NumberType size_type_ = NumberType::uint8, texcoord_size_type_ = NumberType::uint8;
};

}  // namespace

void write_ply(NewFile& out, const MeshOutput& mesh, bool ascii, DroppedCounter& dropped) {
  PlyWriter(out, mesh, ascii, dropped).run();
}

}  // namespace ramcdb::mesh_file
