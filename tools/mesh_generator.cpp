// ramcdb-generate KIND FACES FILE.ply
//
// Writes a mesh made by formula, the same on every machine, as a binary PLY with float coordinates.

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/support/meshes.h"

namespace {

using ramcdb::test::TestMesh;

TestMesh square_terrain(std::size_t faces) {
  const auto cells = static_cast<std::size_t>(std::sqrt(static_cast<double>(faces) / 2) + 0.5);
  return ramcdb::test::terrain(cells, cells);
}

struct Kind {
  std::string_view name, what;
  TestMesh (*make)(std::size_t faces);
};
constexpr Kind kKinds[] = {
    {"sphere", "a sphere", ramcdb::test::sphere},
    {"torus", "a torus", ramcdb::test::torus},
    {"genus3", "a plate with three holes", ramcdb::test::genus3},
    {"terrain", "an open grid with a fractal height", square_terrain},
    {"scan", "a noisy blob with some small holes, as scanners leave them", ramcdb::test::scan},
    {"boxes", "separate boxes of 12 faces", [](std::size_t faces) { return ramcdb::test::boxes(faces / 12); }},
};

int usage() {
  std::cerr << "usage: ramcdb-generate KIND FACES FILE.ply, about FACES faces of one of:\n";
  for (const Kind& kind : kKinds) std::cerr << "  " << kind.name << ": " << kind.what << '\n';
  return 2;
}

template <class Unsigned>
void put_little_endian(std::ostream& out, Unsigned value) {
  std::array<char, sizeof value> bytes;
  for (char& byte : bytes) {
    byte = static_cast<char>(value & 0xff);
    value = static_cast<Unsigned>(value >> 8);
  }
  out.write(bytes.data(), bytes.size());
}

void write_ply(const TestMesh& mesh, const std::string& file) {
  std::ofstream out(file, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.positions.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.faces.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const ramcdb::Point& p : mesh.positions)
    for (const double coordinate : {p.x, p.y, p.z})
      put_little_endian(out, std::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
  for (const ramcdb::Triangle& face : mesh.faces) {
    out.put(3);
    for (const std::uint32_t corner : face) put_little_endian(out, corner);
  }
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) return usage();
  const std::string_view name = argv[1], count = argv[2];
  std::size_t faces = 0;
  const auto [end, error] = std::from_chars(count.begin(), count.end(), faces);
  if (error != std::errc() || end != count.end() || faces == 0) return usage();
  for (const Kind& kind : kKinds) {
    if (kind.name != name) continue;
    const TestMesh mesh = kind.make(faces);
    write_ply(mesh, argv[3]);
    std::cout << argv[3] << ": " << mesh.faces.size() << " faces, " << mesh.positions.size() << " vertices\n";
    return 0;
  }
  return usage();
} catch (const std::exception& error) {
  std::cerr << "ramcdb-generate: " << error.what() << '\n';
  return 1;
}
