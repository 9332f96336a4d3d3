#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "api/mesh_file/writers.h"
#include "ramcdb/error.h"

namespace ramcdb::mesh_file {
namespace {

const char* name_of(AttributeOf of) {
  return of == AttributeOf::vertex ? "vertex" : of == AttributeOf::corner ? "corner" : "face";
}

const char* name_of(NumberType type) {
  constexpr const char* kNames[] = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  return kNames[static_cast<std::size_t>(type) - 1];
}

std::size_t count_of(const MeshOutput& mesh, AttributeOf of) {
  return of == AttributeOf::vertex   ? mesh.positions.size()
         : of == AttributeOf::corner ? mesh.corners.size()
                                     : face_count(mesh);
}

/// Nothing is written that our own reader would not take.
void check(const std::filesystem::path& file, Format format, const MeshOutput& mesh) {
  const auto refuse = [&](std::string_view what) {
    return Error(Errc::invalid_argument, what, file.string(), "nothing was written");
  };
  const bool floats = mesh.scalar == Scalar::float32 || format == Format::stl;
  const double largest = floats ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (int a = 0; a < 3; ++a)
      if (!(std::abs(mesh.positions[v][a]) <= largest))
        throw refuse(fmt::format("vertex {} has a coordinate that {} cannot hold", v, floats ? "float32" : "a file"));
  std::size_t corners = 0;
  for (const std::uint32_t size : mesh.face_sizes) corners += size;
  if (mesh.face_sizes.empty() ? mesh.corners.size() % 3 != 0 : corners != mesh.corners.size())
    throw refuse(fmt::format("{} corners do not make {} faces", mesh.corners.size(), face_count(mesh)));
  for_each_face(mesh, [&](std::size_t f, std::span<const std::uint32_t> face, std::size_t) {
    if (face.size() < 3) throw refuse(fmt::format("face {} has {} corners", f, face.size()));
    for (const std::uint32_t v : face)
      if (v >= mesh.positions.size()) throw refuse(fmt::format("face {} names vertex {}, which is none", f, v));
  });
  if (!mesh.vertex_ids.empty() && mesh.vertex_ids.size() != mesh.positions.size())
    throw refuse(fmt::format("{} ids for {} vertices", mesh.vertex_ids.size(), mesh.positions.size()));
  if (!mesh.face_colors.empty() && mesh.face_colors.size() != face_count(mesh))
    throw refuse(fmt::format("{} colours for {} faces", mesh.face_colors.size(), face_count(mesh)));
  for (const Attribute& attribute : mesh.attributes)
    if (attribute.info.components == 0 || attribute.info.components > 16 ||
        attribute.values.size() != count_of(mesh, attribute.info.of) * attribute.info.components)
      throw refuse(
          fmt::format("attribute '{}' has not one value for each {}", attribute.info.name, name_of(attribute.info.of)));
}

}  // namespace

Dropped dropped_attribute(const Attribute& attribute) {
  return {fmt::format("{} attribute '{}' ({})", name_of(attribute.info.of), attribute.info.name,
                      name_of(attribute.info.type)),
          attribute.count()};
}

void write_number(NewFile& out, NumberType type, double number) {
  if (std::isnan(number)) return out.text(is_float(type) ? "nan" : "0");
  if (is_float(type)) return out.number(number, type == NumberType::float32 ? Scalar::float32 : Scalar::float64);
  out.whole(static_cast<std::int64_t>(number));
}

std::vector<Dropped> write_mesh(const std::filesystem::path& file, Format format, const MeshOutput& mesh, bool ascii) {
  check(file, format, mesh);
  NewFile out(file);
  std::vector<Dropped> dropped;
  switch (format) {
    case Format::ply:
      dropped = write_ply(out, mesh, ascii);
      break;
    case Format::obj:
      dropped = write_obj(out, mesh);
      break;
    case Format::off:
      dropped = write_off(out, mesh);
      break;
    case Format::stl:
      dropped = write_stl(out, mesh);
      break;
  }
  out.commit();
  return dropped;
}

}  // namespace ramcdb::mesh_file
