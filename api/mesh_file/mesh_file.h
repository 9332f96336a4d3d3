#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ramcdb/attributes.h"
#include "ramcdb/error.h"
#include "ramcdb/geometry.h"

/// Ordinary mesh files, as they are: nothing is repaired, and what is not kept is named.
namespace ramcdb::mesh_file {

/// gltf: JSON with its buffers in it or beside it; glb: the same in one binary file.
enum class Format { ply, obj, off, stl, gltf, glb };
[[nodiscard]] constexpr bool is_gltf(Format format) { return format == Format::gltf || format == Format::glb; }

/// From the extension, in any case. Throws invalid_argument listing the formats.
[[nodiscard]] Format format_of(const std::filesystem::path& file);

/// The number type of the coordinates that are written.
enum class Scalar { float32, float64 };

/// What is not kept.
struct Dropped {
  std::string what;         ///< such as "element 'camera'"
  std::uint64_t count = 0;  ///< how many values, faces or lines
};

struct MeshData {
  /// As the file has them. A decimal number is taken as the nearest double, never rounded to what some program may have
  /// printed it from.
  std::vector<Point> positions;
  std::vector<std::uint32_t> corners;     ///< vertex indices, face after face
  std::vector<std::uint32_t> face_sizes;  ///< corners per face; empty when all faces are triangles
  std::vector<std::uint64_t> vertex_ids;  ///< per vertex, from a file that write_mesh gave ids to; else empty
  std::vector<Attribute> attributes;      ///< corners count as in `corners`
  std::vector<std::string> references;    ///< other files that it names: "mtllib a.mtl", "texture skin.png"
  bool soup = false;                      ///< every face has vertices of its own (STL)
  bool repeats_vertices = false;          ///< a vertex may stand several times: STL, and glTF where corners differ

  std::vector<Dropped> dropped;  ///< what the file holds beside the above

  [[nodiscard]] std::size_t face_count() const { return face_sizes.empty() ? corners.size() / 3 : face_sizes.size(); }
};

/// Reads a file whole. Bytes may be hostile: sizes are checked against the file before memory is taken. Throws
/// not_found, and invalid_argument with the place for a file that is cut off, names vertices that do not exist, holds
/// coordinates that are not finite, or no vertex at all.
[[nodiscard]] MeshData read_mesh(const std::filesystem::path& file, const std::function<void(double)>& progress = {});

/// The same for the bytes of a file that are in memory already; `name` is what messages call it.
[[nodiscard]] MeshData read_mesh_bytes(std::string_view bytes, Format format, std::string_view name,
                                       const std::function<void(double)>& progress = {});

/// Takes a mesh from its file piece by piece.
class MeshSink {
 public:
  virtual ~MeshSink() = default;
  /// What comes next, behind what earlier pieces held: positions, corners, sizes of faces, values. `piece` says which
  /// attributes there are even where it has no values of them. Corners may name vertices of any piece. Leaves all of
  /// these empty.
  virtual void take(MeshData& piece) = 0;
};

/// Whether files of a format can be read in pieces: PLY, OBJ and STL, of which OBJ only without attributes.
[[nodiscard]] constexpr bool reads_in_pieces(Format format) {
  return format == Format::ply || format == Format::obj || format == Format::stl;
}
/// A file that only read_mesh can read.
class NotInPieces : public Error {
 public:
  NotInPieces(std::string_view what, std::string_view file);
};
/// Reads such a file in pieces, which take little memory, and returns what is no part of them. Throws as read_mesh, and
/// NotInPieces.
[[nodiscard]] MeshData read_in_pieces(const std::filesystem::path& file, MeshSink& sink,
                                      const std::function<void(double)>& progress = {});

/// How many faces a file has, or about as many, without reading it; 0 where it cannot be told.
[[nodiscard]] std::uint64_t estimate_faces(const std::filesystem::path& file);

/// Makes vertices at equal positions one (-0 equals 0); of their ids and attributes the first's stay.
void weld_exact(MeshData& mesh);

/// Triangles of a mesh's faces, face after face.
struct Triangulation {
  std::vector<Triangle> corners;    ///< per triangle three positions in `MeshData::corners`
  std::vector<std::uint32_t> face;  ///< per triangle the face that it was cut from, ascending
  std::uint64_t polygons = 0;       ///< faces with more than three corners
  std::uint64_t fans = 0;           ///< of them, those that took too long to cut well: fans, which may overlap
};

/// Cuts faces with more than three corners by ear clipping where they are not convex. A face with n corners gives n - 2
/// triangles, which hang together along its diagonals. Throws limit_exceeded beyond 2^32 - 1 corners.
[[nodiscard]] Triangulation triangulate(const MeshData& mesh);
/// Its triangles by their vertices.
[[nodiscard]] std::vector<Triangle> triangles_of(const MeshData& mesh, const Triangulation& cut);

struct FaceColor {
  std::uint8_t r = 0, g = 0, b = 0;
};

/// An attribute whose numbers lie elsewhere.
struct AttributeView {
  AttributeInfo info;
  std::span<const double> values;  ///< as of Attribute

  AttributeView(const Attribute& attribute) : info(attribute.info), values(attribute.values) {}
  AttributeView(AttributeInfo of, std::span<const double> numbers) : info(std::move(of)), values(numbers) {}
  [[nodiscard]] std::size_t count() const { return values.size() / info.components; }
};

struct AttributeViews : std::vector<AttributeView> {
  using vector::vector;
  AttributeViews(const std::vector<Attribute>& attributes) : vector(attributes.begin(), attributes.end()) {}
};

/// A mesh to write; the spans must outlive the call.
struct MeshOutput {
  std::span<const Point> positions;
  std::span<const std::uint32_t> corners;     ///< vertex indices, face after face
  std::span<const std::uint32_t> face_sizes;  ///< corners per face; empty when all faces are triangles
  Scalar scalar = Scalar::float32;
  std::span<const std::uint64_t> vertex_ids;  ///< PLY and glTF only; may be empty
  std::span<const FaceColor> face_colors;     ///< PLY and OFF; may be empty
  AttributeViews attributes;                  ///< what the format cannot hold is left out and counted in the result
  std::span<const std::string> references;    ///< OBJ and PLY
  Point origin;                               ///< glTF of float64: a translation to try, before others
};

/// All that a file held, to be written again; `mesh` must outlive it.
[[nodiscard]] MeshOutput output_of(const MeshData& mesh, Scalar scalar);

/// Writes beside the file and renames into place, so that a failure leaves what was there. Text numbers are the
/// shortest that read back as the same number of the scalar. STL is binary; PLY is binary little-endian unless `ascii`;
/// a .gltf has its buffer in it, as base64. Throws disk_full, storage, and invalid_argument for coordinates that are
/// not finite or too large for the scalar (STL: for float32; glTF of float64: where no translation of all leaves
/// float32s), faces that name no vertex, ids, colours or attributes that are not one each; then nothing was touched.
/// Returns what the format could not hold, by name: PLY has all attributes of vertices and faces, without their
/// `names`, and texture coordinates of corners; OBJ has colours of vertices, texture coordinates and normals, and of
/// faces "material", "group", "object" and "smoothing"; OFF has colours, and of vertices normals and texture
/// coordinates; STL has the attribute "attribute" (uint16) of faces; glTF has triangles, all attributes of vertices and
/// corners that float32, or integers of 8 or 16 bits, hold, and of faces "material" and "object". It writes a vertex
/// again for corners that differ, and puts faces in order of object and material. Integers that are NaN become 0 in PLY
/// and STL, all numbers that are NaN in glTF, unless no vertex of an object has one.
std::vector<Dropped> write_mesh(const std::filesystem::path& file, Format format, const MeshOutput& mesh,
                                bool ascii = false);

}  // namespace ramcdb::mesh_file
