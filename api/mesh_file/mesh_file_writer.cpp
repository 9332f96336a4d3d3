#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/mesh_file/writers.h"

namespace ramcdb::mesh_file {
namespace {

/// Nothing is written that our own reader would not take.
class OutputCheck {
 public:
  OutputCheck(const std::filesystem::path& file, Format format, const MeshOutput& mesh)
      : file_(file), format_(format), mesh_(mesh) {}

  void run() const {
    check_coordinates();
    check_faces();
    check_count("ids", mesh_.vertex_ids.size(), mesh_.positions.size(), "vertices");
    check_count("colours", mesh_.face_colors.size(), face_count(mesh_), "faces");
    for (const AttributeView& attribute : mesh_.attributes) check_attribute(attribute);
  }

 private:
  [[nodiscard]] Error refuse(std::string_view what) const {
    return Error(Errc::invalid_argument, what, file_.string(), "nothing was written");
  }

  void check_coordinates() const {
    const bool floats = mesh_.scalar == Scalar::float32 || format_ == Format::stl;
    const double largest = floats ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max();
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v)
      for (int a = 0; a < 3; ++a)
        if (!(std::abs(mesh_.positions[v][a]) <= largest))
          throw refuse(fmt::format("vertex {} has a coordinate that {} cannot hold", v, floats ? "float32" : "a file"));
  }

  void check_faces() const {
    std::size_t corners = 0;
    for (std::size_t f = 0; f < mesh_.face_sizes.size(); ++f) {
      if (mesh_.face_sizes[f] < 3) throw refuse(fmt::format("face {} has {} corners", f, mesh_.face_sizes[f]));
      corners += mesh_.face_sizes[f];
    }
    if (mesh_.face_sizes.empty() ? mesh_.corners.size() % 3 != 0 : corners != mesh_.corners.size())
      throw refuse(fmt::format("{} corners, which are not those of {} faces", mesh_.corners.size(), face_count(mesh_)));
    FaceWalk walk(mesh_);
    for (std::size_t f = 0; f < face_count(mesh_); ++f)
      for (auto [c, end] = walk.next(); c < end; ++c)
        if (mesh_.corners[c] >= mesh_.positions.size())
          throw refuse(fmt::format("face {} names vertex {}, which is none", f, mesh_.corners[c]));
  }

  void check_count(std::string_view what, std::size_t count, std::size_t expected, std::string_view of) const {
    if (count && count != expected) throw refuse(fmt::format("{} {} for {} {}", count, what, expected, of));
  }

  void check_attribute(const AttributeView& attribute) const {
    const AttributeInfo& info = attribute.info;
    const auto refuse_it = [&](std::string_view what) {
      return refuse(fmt::format("attribute '{}' {}", shown(info.name), what));
    };
    if (info.components < 1 || info.components > kMostComponents)
      throw refuse_it(fmt::format("has {} components", info.components));
    if (!info.fields.empty() && info.fields.size() != info.components)
      throw refuse_it(fmt::format("has {} fields for {} components", info.fields.size(), info.components));
    const std::size_t count = info.of == AttributeOf::vertex   ? mesh_.positions.size()
                              : info.of == AttributeOf::corner ? mesh_.corners.size()
                                                               : face_count(mesh_);
    if (attribute.values.size() != count * info.components)
      throw refuse_it(
          fmt::format("has {} numbers for {} values of {}", attribute.values.size(), count, info.components));
    const NumberRange range = range_of(info.type);
    for (const double value : attribute.values)
      if (!range.holds(value)) throw refuse_it(fmt::format("holds {}, which is none of its type", value));
    if (info.names.empty()) return;
    for (const double value : attribute.values)
      if (value >= static_cast<double>(info.names.size()))
        throw refuse_it(fmt::format("names number {} of {}", value, info.names.size()));
  }

  const std::filesystem::path& file_;
  Format format_;
  const MeshOutput& mesh_;
};

}  // namespace

MeshOutput output_of(const MeshData& mesh, Scalar scalar) {
  MeshOutput out;
  out.positions = mesh.positions;
  out.corners = mesh.corners;
  out.face_sizes = mesh.face_sizes;
  out.scalar = scalar;
  out.vertex_ids = mesh.vertex_ids;
  out.attributes = mesh.attributes;
  out.references = mesh.references;
  return out;
}

std::vector<Dropped> write_mesh(const std::filesystem::path& file, Format format, const MeshOutput& mesh, bool ascii) {
  OutputCheck(file, format, mesh).run();
  DroppedCounter dropped;
  NewFile out(file);
  switch (format) {
    case Format::ply:
      write_ply(out, mesh, ascii, dropped);
      break;
    case Format::obj:
      write_obj(out, mesh, dropped);
      break;
    case Format::off:
      write_off(out, mesh, dropped);
      break;
    case Format::stl:
      write_stl(out, mesh, dropped);
      break;
    case Format::gltf:
      write_gltf(out, file, mesh, dropped);
      break;
    case Format::glb:
      write_glb(out, file, mesh, dropped);
      break;
  }
  out.commit();
  return dropped.take();
}

}  // namespace ramcdb::mesh_file
