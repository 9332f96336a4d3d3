#include <fmt/format.h>

#include "api/mesh_file/writers.h"

/// OFF, with the prefixes of what vertices have: ST texture coordinates, C colours, N normals. The numbers come behind
/// the coordinates in the other order.
namespace ramcdb::mesh_file {
namespace {

class OffWriter {
 public:
  OffWriter(NewFile& out, const MeshOutput& mesh, DroppedCounter& dropped) : out_(out), mesh_(mesh) {
    for (const AttributeView& attribute : mesh.attributes)
      if (const AttributeView** place = place_of(attribute.info); place && !*place)
        *place = &attribute;
      else
        drop_attribute(dropped, attribute);
    for (const std::string& reference : mesh.references) drop_reference(dropped, reference);
  }

  void run() {
    out_.text(fmt::format("{}{}{}OFF\n{} {} 0\n", texture_ ? "ST" : "", color_ ? "C" : "", normal_ ? "N" : "",
                          mesh_.positions.size(), face_count(mesh_)));
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) write_vertex(v);
    FaceWalk walk(mesh_);
    for (std::size_t f = 0; f < face_count(mesh_); ++f) {
      const auto [begin, end] = walk.next();
      out_.whole(end - begin);
      for (std::size_t c = begin; c < end; ++c) {
        out_.text(" ");
        out_.whole(mesh_.corners[c]);
      }
      write_face_color(f);
      out_.text("\n");
    }
  }

 private:
  /// Where an attribute belongs; nullptr: nowhere.
  const AttributeView** place_of(const AttributeInfo& info) {
    const bool color = info.meaning == Meaning::color && (info.components == 3 || info.components == 4);
    if (info.of == AttributeOf::face) return color && mesh_.face_colors.empty() ? &face_color_ : nullptr;
    if (info.of != AttributeOf::vertex) return nullptr;
    if (color) return &color_;
    if (info.meaning == Meaning::normal && info.components == 3) return &normal_;
    if (info.meaning == Meaning::texture && info.components == 2) return &texture_;
    return nullptr;
  }

  /// A vertex without any value has none; where another has one, what is missing is nan.
  void write_vertex(std::size_t v) {
    write_point(out_, mesh_.positions[v], number_type(mesh_.scalar));
    bool any = false;
    for (const AttributeView* attribute : {normal_, color_, texture_}) any |= attribute && !is_none(*attribute, v);
    if (any) {
      if (normal_) write_value(*normal_, v);
      if (color_) write_color(*color_, v);
      if (texture_) write_value(*texture_, v);
    }
    out_.text("\n");
  }

  void write_value(const AttributeView& attribute, std::size_t i) {
    const std::size_t n = attribute.info.components;
    for (std::size_t k = 0; k < n; ++k) {
      out_.text(" ");
      out_.number(attribute.values[i * n + k], attribute.info.type);
    }
  }

  /// Bytes as whole numbers, all others from 0.0 to 1.0.
  void write_color(const AttributeView& attribute, std::size_t i) {
    const NumberType type = attribute.info.type;
    if (type == NumberType::uint8) return write_value(attribute, i);
    const std::size_t n = attribute.info.components;
    for (std::size_t k = 0; k < n; ++k) {
      out_.text(" ");
      out_.fraction(unit_color(attribute.values[i * n + k], type), is_float(type) ? type : NumberType::float64);
    }
  }

  void write_face_color(std::size_t f) {
    if (!mesh_.face_colors.empty()) {
      const FaceColor c = mesh_.face_colors[f];
      out_.text(fmt::format(" {} {} {}", c.r, c.g, c.b));
    } else if (face_color_ && !is_none(*face_color_, f)) {
      write_color(*face_color_, f);
    }
  }

  NewFile& out_;
  const MeshOutput& mesh_;
  const AttributeView *color_ = nullptr, *normal_ = nullptr, *texture_ = nullptr, *face_color_ = nullptr;
};

}  // namespace

void write_off(NewFile& out, const MeshOutput& mesh, DroppedCounter& dropped) { OffWriter(out, mesh, dropped).run(); }

}  // namespace ramcdb::mesh_file
