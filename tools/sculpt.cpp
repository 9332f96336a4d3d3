// ramcdb-sculpt IN OUT [HEIGHT]
//
// Stands for any program that edits a mesh and knows nothing of RAMCdb: it reads a PLY as text, pushes the surface
// around its middle outwards, and writes OBJ or PLY, by OUT's extension. As such programs do, it keeps positions and
// faces only, drops every other property, and writes vertices and faces in another order than it found them.
// HEIGHT is in model units; a fiftieth of the part's size when left out.

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Vec = std::array<double, 3>;

Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec operator*(const Vec& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double length(const Vec& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Mesh {
  std::vector<Vec> points;
  std::vector<std::array<std::size_t, 3>> faces;
};

/// Header: the counts, and at which place x, y and z stand in a vertex line.
struct PlyHeader {
  std::size_t vertices = 0, faces = 0, properties = 0;
  std::array<std::size_t, 3> place{};
};

PlyHeader read_header(std::istream& in) {
  PlyHeader header;
  std::string line, element;
  while (std::getline(in, line) && line != "end_header") {
    std::istringstream words(line);
    std::string word, type, name;
    words >> word >> type >> name;
    if (word == "format" && type != "ascii") throw std::runtime_error("only PLY as text is read here");
    if (word == "element") {
      element = type;
      if (element == "vertex") header.vertices = std::stoul(name);
      if (element == "face") header.faces = std::stoul(name);
    }
    if (word == "property" && element == "vertex") {
      if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z')
        header.place[static_cast<std::size_t>(name[0] - 'x')] = header.properties;
      ++header.properties;
    }
  }
  return header;
}

Mesh read_ply(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  const PlyHeader header = read_header(in);
  Mesh mesh;
  std::vector<double> values(header.properties);
  for (std::size_t v = 0; v < header.vertices; ++v) {
    for (double& value : values) in >> value;
    mesh.points.push_back({values.at(header.place[0]), values.at(header.place[1]), values.at(header.place[2])});
  }
  std::string rest;
  for (std::size_t f = 0; f < header.faces; ++f) {
    std::size_t corners = 0;
    std::array<std::size_t, 3> face{};
    in >> corners >> face[0] >> face[1] >> face[2];
    std::getline(in, rest);
    if (!in || corners != 3) throw std::runtime_error("not a mesh of triangles: " + file);
    mesh.faces.push_back(face);
  }
  if (mesh.faces.empty()) throw std::runtime_error("no faces in " + file);
  return mesh;
}

struct Box {
  Vec lo, hi;
};

Box bounding_box(const Mesh& mesh) {
  Box box{mesh.points.front(), mesh.points.front()};
  for (const Vec& p : mesh.points)
    for (std::size_t a = 0; a < 3; ++a) {
      box.lo[a] = std::min(box.lo[a], p[a]);
      box.hi[a] = std::max(box.hi[a], p[a]);
    }
  return box;
}

std::vector<Vec> vertex_normals(const Mesh& mesh) {
  std::vector<Vec> normals(mesh.points.size(), Vec{});
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec normal = cross(mesh.points.at(b) - mesh.points.at(a), mesh.points.at(c) - mesh.points.at(a));
    for (const std::size_t v : {a, b, c}) normals[v] = normals[v] + normal;
  }
  for (Vec& n : normals)
    if (const double l = length(n); l > 0) n = n * (1 / l);
  return normals;
}

/// A smooth bump around the vertex nearest to the middle; nothing moves farther than a quarter of the part's size away.
void raise_middle(Mesh& mesh, double height) {
  const Box box = bounding_box(mesh);
  const double size = length(box.hi - box.lo);
  const Vec middle = (box.lo + box.hi) * 0.5;
  const Vec top = *std::min_element(mesh.points.begin(), mesh.points.end(), [&](const Vec& a, const Vec& b) {
    return length(a - middle) < length(b - middle);
  });
  if (height == 0) height = size / 50;
  const std::vector<Vec> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const double near = 1 - length(mesh.points[v] - top) / (size / 4);
    if (near > 0) mesh.points[v] = mesh.points[v] + normals[v] * (height * near * near * (3 - 2 * near));
  }
}

/// Vertices in the order of the last faces first, faces from last to first, each turned by one corner.
Mesh reordered(const Mesh& mesh) {
  constexpr auto kUnseen = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> number(mesh.points.size(), kUnseen);
  Mesh result;
  for (auto face = mesh.faces.rbegin(); face != mesh.faces.rend(); ++face) {
    std::array<std::size_t, 3> turned{(*face)[1], (*face)[2], (*face)[0]};
    for (std::size_t& v : turned) {
      if (number[v] == kUnseen) {
        number[v] = result.points.size();
        result.points.push_back(mesh.points[v]);
      }
      v = number[v];
    }
    result.faces.push_back(turned);
  }
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    if (number[v] == kUnseen) result.points.push_back(mesh.points[v]);
  return result;
}

void write(const Mesh& mesh, const std::string& file) {
  std::ofstream out(file);
  out.precision(17);
  const bool obj = file.ends_with(".obj");
  if (!obj)
    out << "ply\nformat ascii 1.0\nelement vertex " << mesh.points.size()
        << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.faces.size()
        << "\nproperty list uchar int vertex_indices\nend_header\n";
  const char* const vertex = obj ? "v " : "";
  const char* const face = obj ? "f " : "3 ";
  const std::size_t first = obj ? 1 : 0;
  for (const auto& [x, y, z] : mesh.points) out << vertex << x << ' ' << y << ' ' << z << '\n';
  for (const auto& [a, b, c] : mesh.faces) out << face << a + first << ' ' << b + first << ' ' << c + first << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3 || argc > 4) {
    std::cerr << "usage: ramcdb-sculpt IN.ply OUT.obj|OUT.ply [HEIGHT]\n";
    return 2;
  }
  Mesh mesh = read_ply(argv[1]);
  raise_middle(mesh, argc == 4 ? std::stod(argv[3]) : 0);
  write(reordered(mesh), argv[2]);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "ramcdb-sculpt: " << error.what() << '\n';
  return 1;
}
