#include "tests/support/openmesh_reader.h"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/IO/importer/ImporterT.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <stdexcept>

namespace ramcdb::test {
namespace {

using PolyMesh = OpenMesh::PolyMesh_ArrayKernelT<>;

/// Takes what a reader says and builds no half-edges.
class Collector : public OpenMesh::IO::ImporterT<PolyMesh> {
 public:
  Collector(PolyMesh& mesh, OpenMeshFile& file) : ImporterT(mesh), file_(file) {}

  OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3f& point) override {
    file_.positions.push_back({point[0], point[1], point[2]});
    return OpenMesh::VertexHandle(static_cast<int>(file_.positions.size()) - 1);
  }
  OpenMesh::VertexHandle add_vertex(const OpenMesh::Vec3d& point) override {
    return add_vertex(OpenMesh::vector_cast<OpenMesh::Vec3f>(point));
  }
  OpenMesh::VertexHandle add_vertex() override { return add_vertex(OpenMesh::Vec3f(0, 0, 0)); }
  void set_point(OpenMesh::VertexHandle v, const OpenMesh::Vec3f& point) override {
    file_.positions[static_cast<std::size_t>(v.idx())] = {point[0], point[1], point[2]};
  }
  OpenMesh::FaceHandle add_face(const VHandles& corners) override {
    for (const auto v : corners) file_.corners.push_back(static_cast<std::uint32_t>(v.idx()));
    file_.face_sizes.push_back(static_cast<std::uint32_t>(corners.size()));
    return OpenMesh::FaceHandle(static_cast<int>(file_.face_sizes.size()) - 1);
  }
  void reserve(unsigned vertices, unsigned, unsigned faces) override {
    file_.positions.reserve(vertices);
    file_.corners.reserve(3 * std::size_t{faces});
    file_.face_sizes.reserve(faces);
  }
  [[nodiscard]] std::size_t n_vertices() const override { return file_.positions.size(); }
  [[nodiscard]] std::size_t n_faces() const override { return file_.face_sizes.size(); }
  void finish() override {}
  // Called for every face of an OBJ, with or without coordinates.
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle, const std::vector<OpenMesh::Vec2f>&) override {}
  void add_face_texcoords(OpenMesh::FaceHandle, OpenMesh::VertexHandle, const std::vector<OpenMesh::Vec3f>&) override {}

 private:
  OpenMeshFile& file_;
};

}  // namespace

OpenMeshFile read_with_openmesh(const std::filesystem::path& file) {
  PolyMesh mesh;
  OpenMeshFile found;
  Collector collector(mesh, found);
  OpenMesh::IO::Options options;
  if (!OpenMesh::IO::IOManager().read(file.string(), collector, options))
    throw std::runtime_error("OpenMesh cannot read " + file.string());
  return found;
}

}  // namespace ramcdb::test
