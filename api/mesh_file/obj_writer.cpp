#include <fmt/format.h>

#include <optional>

#include "api/mesh_file/obj_values.h"

/// Wavefront OBJ: `v` with colours, `vt`, `vn`, then faces, with switches of object, group, material and smoothing
/// where they change.
namespace ramcdb::mesh_file {
namespace {

class ObjWriter {
 public:
  ObjWriter(NewFile& out, const MeshOutput& mesh, DroppedCounter& dropped) : out_(out), mesh_(mesh), dropped_(dropped) {
    for (const AttributeView& attribute : mesh.attributes)
      if (!place(attribute)) drop_attribute(dropped, attribute);
  }

  void run() {
    for (const std::string& reference : mesh_.references) write_reference(reference);
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) write_vertex(v);
    if (!textures_.empty()) textures_.write(out_, "vt");
    if (!normals_.empty()) normals_.write(out_, "vn");
    FaceWalk walk(mesh_);
    for (std::size_t f = 0; f < face_count(mesh_); ++f) {
      write_switches(f);
      const auto [begin, end] = walk.next();
      out_.text("f");
      for (std::size_t c = begin; c < end; ++c) write_corner(c);
      out_.text("\n");
    }
  }

 private:
  /// False: OBJ has no place for it, or another has taken it.
  bool place(const AttributeView& attribute) {
    const AttributeInfo& info = attribute.info;
    return info.of == AttributeOf::face                                       ? place_of_face(attribute)
           : info.meaning == Meaning::color && info.of == AttributeOf::vertex ? place_color(attribute)
           : info.meaning == Meaning::texture && (info.components == 2 || info.components == 3)
               ? place_lines(textures_, attribute)
           : info.meaning == Meaning::normal && info.components == 3 ? place_lines(normals_, attribute)
                                                                     : false;
  }

  bool place_color(const AttributeView& attribute) {
    if (color_ || attribute.info.components < 3) return false;
    color_ = &attribute;
    if (attribute.info.components > 3)
      dropped_.add(fmt::format("alpha of attribute '{}'", shown(attribute.info.name)), attribute.count());
    return true;
  }

  bool place_lines(CornerLines& lines, const AttributeView& attribute) {
    if (!lines.empty()) return false;
    lines = CornerLines(attribute, mesh_, dropped_);
    return true;
  }

  bool place_of_face(const AttributeView& attribute) {
    const AttributeInfo& info = attribute.info;
    if (info.components != 1) return false;
    if (info.name == "smoothing" && info.type == NumberType::uint32) {
      smoothing_ = &attribute;
      return true;
    }
    if (info.names.empty()) return false;
    if (info.meaning == Meaning::material) return place_names(materials_, attribute, "usemtl");
    if (info.meaning != Meaning::group) return false;
    return info.name == "object" ? place_names(objects_, attribute, "o") : place_names(groups_, attribute, "g");
  }

  bool place_names(std::optional<NameLines>& lines, const AttributeView& attribute, std::string_view keyword) {
    if (lines) return false;
    lines.emplace(attribute, keyword, dropped_);
    return true;
  }

  void write_reference(std::string_view reference) {
    if (is_one_line(reference) && reference.starts_with("mtllib ") && !reference.ends_with('\\'))
      out_.text(fmt::format("{}\n", reference));
    else
      drop_reference(dropped_, reference);
  }

  void write_vertex(std::size_t v) {
    out_.text("v ");
    write_point(out_, mesh_.positions[v], number_type(mesh_.scalar));
    if (color_ && !is_none(*color_, v))
      for (std::size_t k = 0; k < 3; ++k) {
        const NumberType type = color_->info.type;
        out_.text(" ");
        out_.number(unit_color(color_->values[v * color_->info.components + k], type),
                    is_float(type) ? type : NumberType::float64);
      }
    out_.text("\n");
  }

  void write_switches(std::size_t f) {
    for (auto* lines : {&objects_, &groups_, &materials_})
      if (*lines) (*lines)->write(out_, f);
    if (!smoothing_) return;
    const double value = smoothing_->values[f];
    const std::uint32_t group = value > 0 ? static_cast<std::uint32_t>(value) : 0;
    if (f > 0 && group == smoothing_group_) return;
    smoothing_group_ = group;
    out_.text("s ");
    out_.whole(group);
    out_.text("\n");
  }

  /// v, v/t, v//n or v/t/n.
  void write_corner(std::size_t c) {
    const std::uint32_t v = mesh_.corners[c];
    const std::uint32_t texture = textures_.empty() ? 0 : textures_.line(c, v);
    const std::uint32_t normal = normals_.empty() ? 0 : normals_.line(c, v);
    out_.text(" ");
    out_.whole(std::uint64_t{v} + 1);
    if (texture || normal) out_.text("/");
    if (texture) out_.whole(texture);
    if (!normal) return;
    out_.text("/");
    out_.whole(normal);
  }

  NewFile& out_;
  const MeshOutput& mesh_;
  DroppedCounter& dropped_;
  const AttributeView* color_ = nullptr;
  CornerLines textures_, normals_;
  std::optional<NameLines> materials_, groups_, objects_;
  const AttributeView* smoothing_ = nullptr;
  std::uint32_t smoothing_group_ = 0;
};

}  // namespace

void write_obj(NewFile& out, const MeshOutput& mesh, DroppedCounter& dropped) { ObjWriter(out, mesh, dropped).run(); }

}  // namespace ramcdb::mesh_file
