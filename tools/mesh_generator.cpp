// ramcdb-generate [--shuffle] KIND FACES FILE
//
// Writes a mesh made by formula, the same on every machine, with float coordinates: as binary PLY (.ply), as text
// (.obj) or as a soup (.stl). The kinds that are streamed take no memory, however many faces; --shuffle mixes the order
// of their vertices and faces, which takes none either.

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/meshes.h"
#include "tools/generated_shapes.h"

namespace {

using ramcdb::Point;
using ramcdb::test::TestMesh;
using ramcdb::tools::Face;
using ramcdb::tools::Shape;

TestMesh square_terrain(std::size_t faces) {
  const auto cells = static_cast<std::size_t>(std::sqrt(static_cast<double>(faces) / 2) + 0.5);
  return ramcdb::test::terrain(cells, cells);
}

/// A mesh that is held in memory.
struct HeldKind {
  std::string_view name, what;
  TestMesh (*make)(std::size_t faces);
};
constexpr HeldKind kHeldKinds[] = {
    {"sphere", "a sphere", ramcdb::test::sphere},
    {"torus", "a torus", ramcdb::test::torus},
    {"genus3", "a plate with three holes", ramcdb::test::genus3},
    {"terrain", "an open grid with a fractal height", square_terrain},
    {"scan", "a noisy blob with some small holes, as scanners leave them", ramcdb::test::scan},
    {"boxes", "separate boxes of 12 faces", [](std::size_t faces) { return ramcdb::test::boxes(faces / 12); }},
};

class HeldShape : public Shape {
 public:
  explicit HeldShape(TestMesh mesh) : mesh_(std::move(mesh)) {}
  std::uint64_t vertices() const override { return mesh_.positions.size(); }
  std::uint64_t faces() const override { return mesh_.faces.size(); }
  Point vertex(std::uint64_t number) const override { return mesh_.positions[number]; }
  Face face(std::uint64_t number) const override {
    const ramcdb::Triangle& t = mesh_.faces[number];
    return {t[0], t[1], t[2]};
  }

 private:
  TestMesh mesh_;
};

class ShuffledShape : public Shape {
 public:
  explicit ShuffledShape(std::unique_ptr<Shape> shape)
      : shape_(std::move(shape)), of_vertices_(shape_->vertices(), 1), of_faces_(shape_->faces(), 2) {}
  std::uint64_t vertices() const override { return shape_->vertices(); }
  std::uint64_t faces() const override { return shape_->faces(); }
  Point vertex(std::uint64_t number) const override { return shape_->vertex(of_vertices_.number_at(number)); }
  Face face(std::uint64_t number) const override {
    Face face = shape_->face(of_faces_.number_at(number));
    for (std::uint64_t& v : face) v = of_vertices_.place_of(v);
    return face;
  }

 private:
  std::unique_ptr<Shape> shape_;
  ramcdb::tools::Shuffle of_vertices_, of_faces_;
};

int usage() {
  std::cerr << "usage: ramcdb-generate [--shuffle] KIND FACES FILE.ply|.obj|.stl, about FACES faces of one of:\n";
  for (const auto& kind : ramcdb::tools::shape_kinds())
    std::cerr << "  " << kind.name << ": " << kind.what << " (streamed, of any size)\n";
  for (const HeldKind& kind : kHeldKinds) std::cerr << "  " << kind.name << ": " << kind.what << '\n';
  return 2;
}

std::unique_ptr<Shape> make_shape(std::string_view name, std::uint64_t faces) {
  for (const auto& kind : ramcdb::tools::shape_kinds())
    if (kind.name == name) return kind.make(faces);
  for (const HeldKind& kind : kHeldKinds)
    if (kind.name == name) return std::make_unique<HeldShape>(kind.make(faces));
  return nullptr;
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

void put_position(std::ostream& out, const Point& p) {
  for (const double coordinate : {p.x, p.y, p.z})
    put_little_endian(out, std::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
}

void write_ply(const Shape& shape, std::ostream& out) {
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << shape.vertices()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << shape.faces()
      << "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (std::uint64_t v = 0; v < shape.vertices(); ++v) put_position(out, shape.vertex(v));
  for (std::uint64_t f = 0; f < shape.faces(); ++f) {
    out.put(3);
    for (const std::uint64_t corner : shape.face(f)) put_little_endian(out, static_cast<std::uint32_t>(corner));
  }
}

void write_obj(const Shape& shape, std::ostream& out) {
  out.precision(9);
  for (std::uint64_t v = 0; v < shape.vertices(); ++v) {
    const Point p = shape.vertex(v);
    out << "v " << static_cast<float>(p.x) << ' ' << static_cast<float>(p.y) << ' ' << static_cast<float>(p.z) << '\n';
  }
  for (std::uint64_t f = 0; f < shape.faces(); ++f) {
    const Face face = shape.face(f);
    out << "f " << face[0] + 1 << ' ' << face[1] + 1 << ' ' << face[2] + 1 << '\n';
  }
}

void write_stl(const Shape& shape, std::ostream& out) {
  out << std::string(80, ' ');
  put_little_endian(out, static_cast<std::uint32_t>(shape.faces()));
  for (std::uint64_t f = 0; f < shape.faces(); ++f) {
    put_position(out, {});  // no normal
    for (const std::uint64_t corner : shape.face(f)) put_position(out, shape.vertex(corner));
    put_little_endian(out, std::uint16_t{0});
  }
}

void write_mesh(const Shape& shape, const std::string& file) {
  std::vector<char> buffer(1 << 20);
  std::ofstream out;
  out.rdbuf()->pubsetbuf(buffer.data(), static_cast<std::streamsize>(buffer.size()));
  out.open(file, std::ios::binary);
  if (file.ends_with(".obj"))
    write_obj(shape, out);
  else if (file.ends_with(".stl"))
    write_stl(shape, out);
  else
    write_ply(shape, out);
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::string_view> words(argv + 1, argv + argc);
  const bool shuffle = !words.empty() && words.front() == "--shuffle";
  if (words.size() != (shuffle ? 4 : 3)) return usage();
  const std::string_view name = words[words.size() - 3], count = words[words.size() - 2];
  const std::string file(words.back());
  std::uint64_t faces = 0;
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), faces);
  if (error != std::errc() || end != count.data() + count.size() || faces == 0) return usage();
  std::unique_ptr<Shape> shape = make_shape(name, faces);
  if (shape == nullptr) return usage();
  if (shuffle) shape = std::make_unique<ShuffledShape>(std::move(shape));
  write_mesh(*shape, file);
  std::cout << file << ": " << shape->faces() << " faces, " << shape->vertices() << " vertices\n";
  return 0;
} catch (const std::exception& error) {
  std::cerr << "ramcdb-generate: " << error.what() << '\n';
  return 1;
}
