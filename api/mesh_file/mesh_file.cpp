#include "api/mesh_file/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "api/mesh_file/file_bytes.h"

namespace ramcdb::mesh_file {
namespace {

constexpr std::size_t kMostVertices = 0xfffffffe;

void check_finite(const FileBytes& file, std::span<const Point> positions, std::size_t before = 0) {
  for (const Point& p : positions)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Error(
          Errc::invalid_argument,
          fmt::format("vertex {} has a coordinate that is not finite", before + std::size_t(&p - positions.data())),
          file.name(), "repair the file; nothing was imported");
}

void check_counts(const FileBytes& file, std::size_t vertices, std::size_t corners) {
  if (vertices == 0)
    throw Error(Errc::invalid_argument, "the file holds no vertex", file.name(), "check that it is the right file");
  if (vertices > kMostVertices || corners > kMostVertices)
    throw Error(Errc::limit_exceeded, "the file holds more than 2^32 - 2 vertices, or corners of faces", file.name(),
                "split it");
}

/// What all formats have in common.
void check(const FileBytes& file, const MeshData& mesh) {
  check_counts(file, mesh.positions.size(), mesh.corners.size());
  check_finite(file, mesh.positions);
  const auto wrong = std::find_if(mesh.corners.begin(), mesh.corners.end(),
                                  [&](std::uint32_t v) { return v >= mesh.positions.size(); });
  if (wrong != mesh.corners.end())
    throw Error(Errc::invalid_argument,
                fmt::format("a face names vertex {}, the file has {}", *wrong, mesh.positions.size()), file.name(),
                "repair the file; nothing was imported");
}

/// Checks pieces and hands them on. Their readers know which vertices there are.
class CheckedPieces : public MeshSink {
 public:
  CheckedPieces(const FileBytes& file, MeshSink& sink) : file_(file), sink_(sink) {}

  void take(MeshData& piece) override {
    check_finite(file_, piece.positions, vertices_);
    vertices_ += piece.positions.size();
    corners_ += piece.corners.size();
    if (vertices_ > 0) check_counts(file_, vertices_, corners_);
    sink_.take(piece);
    piece.positions.clear();
    piece.corners.clear();
    piece.face_sizes.clear();
    piece.vertex_ids.clear();
    for (Attribute& attribute : piece.attributes) attribute.values.clear();
  }
  void finish(MeshData& last) {
    take(last);
    check_counts(file_, vertices_, corners_);
  }

 private:
  const FileBytes& file_;
  MeshSink& sink_;
  std::size_t vertices_ = 0, corners_ = 0;
};

MeshData read_format(const FileBytes& file, Format format, MeshSink* sink, const Progress& progress) {
  MeshData mesh;
  switch (format) {
    case Format::ply:
      read_ply(file, mesh, sink, progress);
      break;
    case Format::obj:
      read_obj(file, mesh, sink, progress);
      break;
    case Format::off:
      read_off(file, mesh, progress);
      break;
    case Format::stl:
      read_stl(file, mesh, sink, progress);
      break;
    case Format::gltf:
    case Format::glb:
      read_gltf(file, mesh, progress);
      break;
  }
  mesh.repeats_vertices = format == Format::stl || is_gltf(format);
  return mesh;
}

MeshData read(const FileBytes& file, Format format, const Progress& progress) {
  MeshData mesh = read_format(file, format, nullptr, progress);
  check(file, mesh);
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

NotInPieces::NotInPieces(std::string_view what, std::string_view file)
    : Error(Errc::limit_exceeded, fmt::format("{}: such a mesh is read only as a whole, into memory", what), file,
            "give more with --memory") {}

MeshData read_in_pieces(const std::filesystem::path& path, MeshSink& sink, const Progress& progress) {
  const Format format = format_of(path);
  const FileBytes file(path);
  if (!reads_in_pieces(format)) throw NotInPieces("a file of this format", file.name());
  CheckedPieces pieces(file, sink);
  MeshData mesh = read_format(file, format, &pieces, progress);
  pieces.finish(mesh);
  return mesh;
}

std::uint64_t estimate_faces(const std::filesystem::path& path) {
  constexpr std::size_t kBytesOfFace = 40;  // a line of text, and half a vertex's
  const Format format = format_of(path);
  const FileBytes file(path);
  if (format == Format::ply) return count_ply_faces(file);
  if (format == Format::stl) return count_stl_faces(file);
  return file.text().size() / kBytesOfFace + 1;
}

MeshData read_mesh_bytes(std::string_view bytes, Format format, std::string_view name, const Progress& progress) {
  return read(FileBytes(bytes, name), format, progress);
}

}  // namespace ramcdb::mesh_file
