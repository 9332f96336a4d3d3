#include <fmt/format.h>

#include "api/mesh_file/writers.h"

namespace ramcdb::mesh_file {
namespace {

/// OFF with what its header word can say: normals (N), colours (C) and texture coordinates (ST) of vertices; colours of
/// faces stand behind their corners.
class OffWriter {
 public:
  OffWriter(NewFile& out, const MeshOutput& mesh) : out_(out), mesh_(mesh) {
    for (const Attribute& attribute : mesh.attributes)
      if (!take(attribute)) dropped_.push_back(dropped_attribute(attribute));
  }

  std::vector<Dropped> run() {
    out_.text(fmt::format("{}{}{}OFF\n{} {} 0\n", texture_ ? "ST" : "", color_ ? "C" : "", normal_ ? "N" : "",
                          mesh_.positions.size(), face_count(mesh_)));
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
      for (int a = 0; a < 3; ++a) {
        if (a) out_.text(" ");
        out_.number(mesh_.positions[v][a], mesh_.scalar);
      }
      for (const Attribute* attribute : {normal_, color_, texture_})
        if (attribute) put(*attribute, v);
      out_.text("\n");
    }
    for_each_face(mesh_, [&](std::size_t f, std::span<const std::uint32_t> face, std::size_t) { write_face(f, face); });
    return std::move(dropped_);
  }

 private:
  bool take(const Attribute& attribute) {
    const AttributeInfo& info = attribute.info;
    const bool is_color = info.meaning == Meaning::color && (info.type == NumberType::uint8 || is_float(info.type));
    if (info.of == AttributeOf::face && is_color && !face_color_ && mesh_.face_colors.empty()) {
      face_color_ = &attribute;
      return true;
    }
    if (info.of != AttributeOf::vertex) return false;
    const Attribute*& slot = info.meaning == Meaning::normal ? normal_ : is_color ? color_ : texture_;
    const bool known =
        info.meaning == Meaning::normal || is_color || (info.meaning == Meaning::texture && info.components == 2);
    if (!known || slot) return false;
    slot = &attribute;
    return true;
  }

  /// Colours have four numbers where vertices have them.
  void put(const Attribute& attribute, std::size_t at) {
    for (const double number : value_of(attribute, at)) {
      out_.text(" ");
      if (is_float(attribute.info.type) && number == static_cast<double>(static_cast<std::int64_t>(number)))
        out_.text(fmt::format("{}.0", static_cast<std::int64_t>(number)));  // so that it is not taken for 0..255
      else
        write_number(out_, attribute.info.type, number);
    }
    if (&attribute == color_ && attribute.info.components == 3)
      out_.text(is_float(attribute.info.type) ? " 1.0" : " 255");
  }

  void write_face(std::size_t f, std::span<const std::uint32_t> face) {
    out_.whole(static_cast<std::int64_t>(face.size()));
    for (const std::uint32_t v : face) {
      out_.text(" ");
      out_.whole(v);
    }
    if (!mesh_.face_colors.empty()) {
      const FaceColor c = mesh_.face_colors[f];
      out_.text(fmt::format(" {} {} {}", c.r, c.g, c.b));
    } else if (face_color_) {
      put(*face_color_, f);
    }
    out_.text("\n");
  }

  NewFile& out_;
  const MeshOutput& mesh_;
  const Attribute *texture_ = nullptr, *normal_ = nullptr, *color_ = nullptr, *face_color_ = nullptr;
  std::vector<Dropped> dropped_;
};

}  // namespace

std::vector<Dropped> write_off(NewFile& out, const MeshOutput& mesh) { return OffWriter(out, mesh).run(); }

}  // namespace ramcdb::mesh_file
