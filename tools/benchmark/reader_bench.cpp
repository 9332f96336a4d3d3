// ramcdb-bench-readers [--rounds N] FILE
//
// Measures our readers of mesh files against OpenMesh's: writes FILE in every format, and reads each in turns. A table
// as Markdown on standard output. Files are in the page cache: it is parsing that is measured, not the disk.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "tests/support/openmesh_reader.h"
#include "tools/benchmark/timing.h"

namespace {

namespace fs = std::filesystem;
namespace mesh_file = ramcdb::mesh_file;
using ramcdb::benchmark::median;
using ramcdb::benchmark::seconds;
using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<>;

/// The number of faces, so that nobody may skip the work.
std::size_t read_ours(const fs::path& file) { return mesh_file::read_mesh(file).face_count(); }

std::size_t read_openmesh(const fs::path& file) { return ramcdb::test::read_with_openmesh(file).face_sizes.size(); }

std::size_t build_openmesh(const fs::path& file) {
  PolyMesh mesh;
  if (!OpenMesh::IO::read_mesh(mesh, file.string())) throw std::runtime_error("OpenMesh cannot read " + file.string());
  return mesh.n_faces();
}

struct Contestant {
  std::size_t (*read)(const fs::path&);
  std::vector<double> times;
  std::size_t faces = 0;
};

void measure(const char* kind, const fs::path& file, unsigned rounds) {
  Contestant all[] = {{read_ours, {}}, {read_openmesh, {}}, {build_openmesh, {}}};
  for (Contestant& contestant : all) contestant.faces = contestant.read(file);  // and the page cache is warm
  if (all[0].faces < all[1].faces)  // OpenMesh leaves out degenerate faces of STL
    throw std::runtime_error(fmt::format("{} faces and {} of {}", all[0].faces, all[1].faces, file.string()));
  for (unsigned round = 0; round < rounds; ++round)
    for (Contestant& contestant : all)
      contestant.times.push_back(seconds([&] { contestant.faces = contestant.read(file); }));
  const double megabytes = static_cast<double>(fs::file_size(file)) / 1e6;
  const double ours = median(all[0].times), theirs = median(all[1].times), built = median(all[2].times);
  fmt::print("| {} | {:.1f} | {:.0f} | {:.0f} | {:.1f} | {:.1f} |\n", kind, megabytes, megabytes / ours,
             megabytes / theirs, theirs / ours, built / ours);
}

void run(const fs::path& file, const fs::path& scratch, unsigned rounds) {
  const mesh_file::MeshData mesh = mesh_file::read_mesh(file);
  const mesh_file::MeshOutput out = mesh_file::output_of(mesh, mesh_file::Scalar::float32);
  fmt::print("\n## Readers: {}, {} vertices, {} faces, one thread, medians of {} rounds in turns\n\n",
             file.filename().string(), mesh.positions.size(), mesh.face_count(), rounds);
  fmt::print("| format | MB | ours MB/s | OpenMesh MB/s | OpenMesh / ours | with its half-edges / ours |\n");
  fmt::print("|---|---:|---:|---:|---:|---:|\n");
  struct Kind {
    const char* name;
    const char* file;
    bool ascii;
  };
  for (const Kind kind :
       {Kind{"PLY, binary", "binary.ply", false}, Kind{"PLY, text", "text.ply", true}, Kind{"OBJ", "mesh.obj", false},
        Kind{"OFF", "mesh.off", false}, Kind{"STL, binary", "mesh.stl", false}}) {
    const fs::path written = scratch / kind.file;
    const auto format = mesh_file::format_of(written);
    if (format == mesh_file::Format::stl && !mesh.face_sizes.empty()) continue;  // it has triangles only
    (void)mesh_file::write_mesh(written, format, out, kind.ascii);
    measure(kind.name, written, rounds);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Speed of our readers of mesh files against OpenMesh's");
  unsigned rounds = 7;
  std::string file;
  app.add_option("--rounds", rounds, "Rounds that medians are taken over")->check(CLI::PositiveNumber);
  app.add_option("file", file, "A mesh")->required()->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);

  const fs::path scratch = fs::temp_directory_path() / fmt::format("ramcdb-bench-readers-{}", ::getpid());
  fs::create_directories(scratch);
  try {
    run(file, scratch, rounds);
  } catch (...) {
    fs::remove_all(scratch);
    throw;
  }
  fs::remove_all(scratch);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "ramcdb-bench-readers: " << error.what() << '\n';
  return 1;
}
