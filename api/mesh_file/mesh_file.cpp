#include "api/mesh_file/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/mesh_file/file_bytes.h"

namespace ramcdb::mesh_file {
namespace {

constexpr std::size_t kMostVertices = 0xfffffffe;

/// What all formats have in common.
void check(const FileBytes& file, const MeshData& mesh) {
  if (mesh.positions.empty())
    throw Error(Errc::invalid_argument, "the file holds no vertex", file.name(), "check that it is the right file");
  if (mesh.positions.size() > kMostVertices || mesh.corners.size() > kMostVertices)
    throw Error(Errc::limit_exceeded, "the file holds more than 2^32 - 2 vertices, or corners of faces", file.name(),
                "split it");
  for (const Point& p : mesh.positions)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Error(Errc::invalid_argument,
                  fmt::format("vertex {} has a coordinate that is not finite", &p - mesh.positions.data()), file.name(),
                  "repair the file; nothing was imported");
  const auto wrong = std::find_if(mesh.corners.begin(), mesh.corners.end(),
                                  [&](std::uint32_t v) { return v >= mesh.positions.size(); });
  if (wrong != mesh.corners.end())
    throw Error(Errc::invalid_argument,
                fmt::format("a face names vertex {}, the file has {}", *wrong, mesh.positions.size()), file.name(),
                "repair the file; nothing was imported");
}

MeshData read(const FileBytes& file, Format format, const Progress& progress) {
  MeshData mesh;
  switch (format) {
    case Format::ply:
      read_ply(file, mesh, progress);
      break;
    case Format::obj:
      read_obj(file, mesh, progress);
      break;
    case Format::off:
      read_off(file, mesh, progress);
      break;
    case Format::stl:
      read_stl(file, mesh, progress);
      break;
    case Format::gltf:
    case Format::glb:
      read_gltf(file, mesh, progress);
      break;
  }
  check(file, mesh);
  mesh.repeats_vertices = format == Format::stl || is_gltf(format);
  return mesh;
}

}  // namespace

Format format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (extension == ".ply") return Format::ply;
  if (extension == ".obj") return Format::obj;
  if (extension == ".off") return Format::off;
  if (extension == ".stl") return Format::stl;
  if (extension == ".gltf") return Format::gltf;
  if (extension == ".glb") return Format::glb;
  throw Error(Errc::invalid_argument, fmt::format("unknown mesh format '{}'", extension), file.string(),
              "use .ply, .obj, .off, .stl, .glb or .gltf");
}

MeshData read_mesh(const std::filesystem::path& path, const Progress& progress) {
  const Format format = format_of(path);
  return read(FileBytes(path), format, progress);
}

MeshData read_mesh_bytes(std::string_view bytes, Format format, std::string_view name, const Progress& progress) {
  return read(FileBytes(bytes, name), format, progress);
}

}  // namespace ramcdb::mesh_file
