#include "api/mesh_spool.h"

#include <compare>

#include "api/external_sort.h"

namespace ramcdb::detail {
namespace {

constexpr int kSome = 1 << 16;  ///< records between reports

class PieceSpooler : public mesh_file::MeshSink {
 public:
  PieceSpooler(MeshSpool& to, std::string file) : to_(to), file_(std::move(file)) {}

  void take(mesh_file::MeshData& piece) override {
    if (!piece.face_sizes.empty()) throw mesh_file::NotInPieces("a mesh with polygons", file_);
    take_values(piece.attributes);
    to_.points.add(piece.positions);
    for (std::size_t c = 0; c < piece.corners.size(); c += 3)
      to_.faces.add({piece.corners[c], piece.corners[c + 1], piece.corners[c + 2]});
  }

 private:
  void take_values(const std::vector<Attribute>& attributes) {
    for (std::size_t a = 0; a < attributes.size(); ++a) {
      if (attributes[a].info.of != AttributeOf::vertex)
        throw mesh_file::NotInPieces("a mesh with attributes of faces or corners", file_);
      if (a == to_.attributes.size()) to_.attributes.emplace_back(attributes[a].info, to_.folder);
      to_.attributes[a].add(attributes[a].values);
    }
  }

  MeshSpool& to_;
  std::string file_;
};

struct VertexAtPoint {
  Point point;
  std::uint32_t vertex = 0;

  friend bool operator<(const VertexAtPoint& a, const VertexAtPoint& b) {
    for (int axis = 0; axis < 3; ++axis)
      if (a.point[axis] != b.point[axis]) return a.point[axis] < b.point[axis];
    return a.vertex < b.vertex;
  }
};

struct Standing {
  std::uint32_t vertex, first;  ///< the first of those at its position stands for all
  friend auto operator<=>(const Standing&, const Standing&) = default;
};

/// Per vertex the one that stands for it.
ScratchRecords<std::uint32_t> find_firsts(const PointFile& points, const LargeWork& work) {
  ExternalSorter<Standing> by_vertex(work.folder, work.memory / 4, work.threads);
  {
    ExternalSorter<VertexAtPoint> by_point(work.folder, work.memory / 4, work.threads);
    for (std::uint32_t v = 0; v < points.size(); ++v) {
      if (v % kSome == 0) work.report("weld", 0);
      const Point p = points.at(v);
      by_point.add({{p.x + 0.0, p.y + 0.0, p.z + 0.0}, v});  // -0 + 0 is 0
    }
    std::optional<VertexAtPoint> first;
    by_point.merge([&](const VertexAtPoint& here) {
      if (here.vertex % kSome == 0) work.report("weld", 0.3);
      if (!first || first->point != here.point) first = here;
      by_vertex.add({here.vertex, first->vertex});
    });
  }
  ScratchRecords<std::uint32_t> firsts(work.folder);
  by_vertex.merge([&](const Standing& standing) { firsts.add(standing.first); });
  firsts.flush();
  return firsts;
}

void weld(MeshSpool& mesh, const LargeWork& work) {
  const ScratchRecords<std::uint32_t> firsts = find_firsts(mesh.points, work);
  firsts.for_each_piece([&](std::span<const std::uint32_t> piece, std::uint64_t begin) {
    for (std::size_t i = 0; i < piece.size(); ++i) {
      if (piece[i] == begin + i) continue;
      mesh.in_a_face[static_cast<std::size_t>(begin) + i] = true;
      ++mesh.welded;
    }
  });
  const ScratchView view = firsts.view();
  const auto first = view.as<std::uint32_t>();
  for (SpooledAttribute& attribute : mesh.attributes) {
    work.report("weld", 0.6);
    attribute.join(first);
  }
  mesh.faces.replace([&, seen = 0](Triangle& t) mutable {
    if (++seen % kSome == 0) work.report("weld", 0.7);
    t = {first[t[0]], first[t[1]], first[t[2]]};
  });
}

}  // namespace

void SpooledAttribute::finish() {
  values_.flush();
  view_.emplace(values_.view());
}

void SpooledAttribute::join(std::span<const std::uint32_t> first_of_vertex) {
  const std::size_t components = info_.components;
  const auto before = view_->as<double>();
  values_.replace([&, i = std::size_t{0}](double& value) mutable {
    value = before[first_of_vertex[i / components] * components + i % components];
    ++i;
  });
}

MeshSpool spool_mesh(const std::filesystem::path& file, std::optional<bool> weld_points, const LargeWork& work) {
  MeshSpool mesh(work.folder);
  PieceSpooler spooler(mesh, file.string());
  mesh_file::MeshData rest = mesh_file::read_in_pieces(file, spooler, [&](double done) { work.report("read", done); });
  mesh.points.finish();
  for (SpooledAttribute& attribute : mesh.attributes) attribute.finish();
  mesh.faces.flush();
  mesh.references = std::move(rest.references);
  mesh.dropped = std::move(rest.dropped);
  mesh.in_a_face.resize(static_cast<std::size_t>(mesh.points.size()));
  if (weld_points.value_or(rest.soup)) weld(mesh, work);
  mesh.faces.for_each_piece([&](std::span<const Triangle> piece, std::uint64_t) {
    work.report("read", 1);
    for (const Triangle& t : piece)
      for (const std::uint32_t v : t) mesh.in_a_face[v] = true;
  });
  return mesh;
}

}  // namespace ramcdb::detail
