#include "tests/fuzz/mesh_reader.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <limits>
#include <optional>

#include "tests/api/mesh_file/samples.h"
#include "tests/api/mesh_file/sound_mesh.h"

namespace ramcdb::fuzz {
namespace {

using mesh_file::Format;
using mesh_file::MeshData;

/// A file in memory where there is such a folder; one per process, since libFuzzer runs several.
const std::filesystem::path& scratch_file() {
  static const std::filesystem::path file = [] {
    const std::filesystem::path memory = "/dev/shm";
    const auto folder = std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    return folder / ("ramcdb_fuzz_" + std::to_string(::getpid()));
  }();
  return file;
}

bool is_ours(Errc code) { return code == Errc::invalid_argument || code == Errc::limit_exceeded; }

std::optional<MeshData> read(std::string_view bytes, Format format) {
  try {
    return mesh_file::read_mesh_bytes(bytes, format, "input");
  } catch (const Error& error) {
    const std::string_view text = error.what();
    require(is_ours(error.code()), "a reader throws another code");
    require(text.find("(input") != text.npos, "an error that does not name the place");
    require(text.find("): ") != text.npos, "an error that does not say how to go on");
    require(text.find('\n') == text.npos && text.size() < 400, "an error of more than one line");
    return std::nullopt;
  }
}

void check_triangles(const MeshData& mesh) {
  const auto cut = mesh_file::triangulate(mesh);
  require(cut.corners.size() == mesh.corners.size() - 2 * mesh.face_count(), "not n - 2 triangles of n corners");
  require(cut.face.size() == cut.corners.size(), "not a face per triangle");
  for (const Triangle& triangle : cut.corners)
    for (const std::uint32_t c : triangle) require(c < mesh.corners.size(), "a triangle of a corner that is none");
}

/// The mesh as a file of this format holds it: STL has float32, triangles, and a vertex per corner. Nothing where it
/// does not fit.
std::optional<MeshData> as_held(const MeshData& mesh, Format format) {
  if (format != Format::stl) return mesh;
  if (!mesh.face_sizes.empty() || mesh.corners.empty()) return std::nullopt;
  MeshData held;
  held.attributes = mesh.attributes;
  for (const std::uint32_t v : mesh.corners) {
    Point p = mesh.positions[v];
    for (int a = 0; a < 3; ++a) {
      constexpr double kMost = std::numeric_limits<float>::max();
      if (p[a] > kMost || p[a] < -kMost) return std::nullopt;
      p[a] = static_cast<double>(static_cast<float>(p[a]));
    }
    held.corners.push_back(static_cast<std::uint32_t>(held.positions.size()));
    held.positions.push_back(p);
  }
  return held;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (a != a && b != b);
}

void check_same(const MeshData& again, const MeshData& mesh) {
  require(again.positions.size() == mesh.positions.size(), "another number of vertices comes back");
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (int a = 0; a < 3; ++a)
      require(same_bits(again.positions[v][a], mesh.positions[v][a]), "other coordinates come back");
  require(again.corners == mesh.corners && again.face_sizes == mesh.face_sizes, "other faces come back");
  require(again.vertex_ids == mesh.vertex_ids, "other vertex ids come back");
}

/// The attributes that have a value; text cannot say that there is one without any.
std::vector<const Attribute*> with_values(const MeshData& mesh) {
  std::vector<const Attribute*> all;
  for (const Attribute& attribute : mesh.attributes)
    if (std::any_of(attribute.values.begin(), attribute.values.end(), [](double value) { return value == value; }))
      all.push_back(&attribute);
  return all;
}

/// Names may change: two properties of one name get two.
void check_same_attributes(const MeshData& again, const MeshData& mesh) {
  const auto read = with_values(again), expected = with_values(mesh);
  require(read.size() == expected.size(), "another number of attributes comes back");
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto &a = read[i]->info, &b = expected[i]->info;
    require(a.of == b.of && a.type == b.type && a.components == b.components && a.meaning == b.meaning,
            "an attribute comes back as another");
    require(a.names == b.names, "other names of materials or groups come back");
    const auto &x = read[i]->values, &y = expected[i]->values;
    require(x.size() == y.size(), "another number of values comes back");
    for (std::size_t k = 0; k < y.size(); ++k) require(same_bits(x[k], y[k]), "other values come back");
  }
}

void check_round_trip(const MeshData& mesh, Format format, bool ascii) {
  const auto held = as_held(mesh, format);
  if (!held) return;
  const auto& file = scratch_file();
  std::string name = file.string();
  constexpr const char* kExtensions[] = {".ply", ".obj", ".off", ".stl"};
  name += kExtensions[static_cast<std::size_t>(format)];
  const auto dropped =
      mesh_file::write_mesh(name, format, mesh_file::output_of(mesh, mesh_file::Scalar::float64), ascii);
  const MeshData again = mesh_file::read_mesh(name);
  std::filesystem::remove(name);
  check_same(again, *held);
  // What a format cannot hold is named; all else must be there.
  if (dropped.empty()) check_same_attributes(again, *held);
}

}  // namespace

void read_and_check(std::string_view bytes, mesh_file::Format format) {
  const auto mesh = read(bytes, format);
  if (!mesh) return;
  require(test::is_sound(*mesh), "a mesh that is not sound");
  check_triangles(*mesh);
  // glTF puts faces in order of objects and materials, and splits vertices where corners differ.
  if (!is_gltf(format)) check_round_trip(*mesh, format, bytes.size() % 2 == 0);
}

std::vector<Seed> mesh_seeds(std::string_view extension, const std::vector<test::BadFile>& files) {
  std::vector<Seed> all;
  for (const auto& sample : test::samples())
    if (sample.name.ends_with(extension)) all.push_back({"sample-" + sample.name, sample.bytes});
  for (const auto& file : files) all.push_back({file.name, file.bytes});
  return all;
}

}  // namespace ramcdb::fuzz
