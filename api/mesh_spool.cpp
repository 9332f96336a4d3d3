#include "api/mesh_spool.h"

#include <compare>
#include <numeric>
#include <utility>

#include "api/external_sort.h"
#include "api/vertex_ranks.h"

namespace ramcdb::detail {
namespace {

constexpr int kSome = 1 << 16;  ///< records between reports

class PieceSpooler : public mesh_file::MeshSink {
 public:
  explicit PieceSpooler(MeshSpool& to) : to_(to) {}

  void take(mesh_file::MeshData& piece) override {
    take_values(piece.attributes);
    to_.points.add(piece.positions);
    if (!to_.polygons && !piece.face_sizes.empty()) begin_polygons();
    if (to_.polygons) return to_.polygons->add(piece.corners, piece.face_sizes);
    for (std::size_t c = 0; c < piece.corners.size(); c += 3)
      to_.triangles.add({piece.corners[c], piece.corners[c + 1], piece.corners[c + 2]});
  }

 private:
  void begin_polygons() {
    to_.triangles.flush();
    to_.polygons.emplace(to_.folder);
    to_.polygons->add_triangles(to_.triangles);
  }

  void take_values(const std::vector<Attribute>& attributes) {
    for (std::size_t a = 0; a < attributes.size(); ++a) {
      if (a == to_.attributes.size()) to_.attributes.emplace_back(attributes[a].info, to_.folder);
      to_.attributes[a].add(attributes[a].values);
    }
  }

  MeshSpool& to_;
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
  const auto report = [&] { work.report("weld", 0.3); };
  ExternalSorter<Standing> by_vertex(work.folder, work.memory / 4, work.threads, report);
  {
    ExternalSorter<VertexAtPoint> by_point(work.folder, work.memory / 4, work.threads, report);
    for (std::uint32_t v = 0; v < points.size(); ++v) {
      if (v % kSome == 0) report();
      const Point p = points.at(v);
      by_point.add({{p.x + 0.0, p.y + 0.0, p.z + 0.0}, v});  // -0 + 0 is 0
    }
    std::optional<VertexAtPoint> first;
    by_point.merge([&](const VertexAtPoint& here) {
      if (here.vertex % kSome == 0) report();
      if (!first || first->point != here.point) first = here;
      by_vertex.add({here.vertex, first->vertex});
    });
  }
  ScratchRecords<std::uint32_t> firsts(work.folder);
  by_vertex.merge([&](const Standing& standing) {
    if (standing.vertex % kSome == 0) work.report("weld", 0.5);
    firsts.add(standing.first);
  });
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
  for (SpooledAttribute& attribute : mesh.attributes)
    if (attribute.info().of == AttributeOf::vertex) attribute.join(first, [&] { work.report("weld", 0.6); });
  const std::function<void()> report = [&, seen = std::uint64_t{0}]() mutable {
    if (++seen % kSome == 0) work.report("weld", 0.7);
  };
  if (mesh.polygons)
    mesh.polygons->corners.replace([&](std::uint32_t& v) {
      report();
      v = first[v];
    });
  else
    mesh.triangles.replace([&](Triangle& t) {
      report();
      t = {first[t[0]], first[t[1]], first[t[2]]};
    });
}

}  // namespace

void SpooledAttribute::finish() {
  values_.flush();
  view_.emplace(values_.view());
}

void SpooledAttribute::join(std::span<const std::uint32_t> first_of_vertex, const std::function<void()>& report) {
  const std::size_t components = info_.components;
  const auto before = view_->as<double>();
  values_.replace([&, i = std::size_t{0}](double& value) mutable {
    if (i % kSome == 0) report();
    value = before[first_of_vertex[i / components] * components + i % components];
    ++i;
  });
}

void SpooledPolygons::add(std::span<const std::uint32_t> face_corners, std::span<const std::uint32_t> face_sizes) {
  corners.add(face_corners);
  if (!face_sizes.empty()) return sizes_.add(face_sizes);
  for (std::size_t c = 0; c < face_corners.size(); c += 3) sizes_.add(std::uint32_t{3});
}

void SpooledPolygons::add_triangles(const ScratchRecords<Triangle>& before) {
  before.for_each_piece([&](std::span<const Triangle> piece, std::uint64_t) {
    std::vector<std::uint32_t> vertices;
    for (const Triangle& t : piece) vertices.insert(vertices.end(), t.begin(), t.end());
    add(vertices, {});
  });
}

void SpooledPolygons::finish() {
  corners.flush();
  sizes_.flush();
}

void SpooledPolygons::cut(const PointFile& points, const Lattice& lattice, const LargeWork& work) {
  if (corners.size() > 0xffffffffU)
    throw Error(Errc::limit_exceeded, "the mesh has more than 2^32 - 1 corners of faces", "", "split it");
  constexpr std::size_t kSomeCorners = std::size_t{1} << 19;
  Cut cut;
  sizes_.for_each_piece([&](std::span<const std::uint32_t> sizes, std::uint64_t) {
    for (std::size_t end = 0; !sizes.empty(); sizes = sizes.subspan(std::exchange(end, 0))) {
      work.report("sort", 0);
      for (std::size_t named = 0; end < sizes.size() && named < kSomeCorners;) named += sizes[end++];
      cut_some(sizes.first(end), points, lattice, cut);
    }
  });
  triangles.flush();
  sources_.flush();
  view_.emplace(sources_.view());
}

void SpooledPolygons::cut_some(std::span<const std::uint32_t> sizes, const PointFile& points, const Lattice& lattice,
                               Cut& cut) {
  const auto named = corners.read(cut.corners, std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}));
  const VertexRanks ranks(named);
  std::vector<Point> positions;
  for (const std::uint32_t v : ranks.vertices) {
    const LatticePoint p = lattice.snap(points.at(v));
    positions.push_back({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
  }
  const mesh_file::Triangulation pieces = mesh_file::triangulate(positions, ranks.rank, sizes, cut.steps);
  for (std::size_t t = 0; t < pieces.corners.size(); ++t) {
    const auto [a, b, c] = pieces.corners[t];
    triangles.add({named[a], named[b], named[c]});
    sources_.add({cut.faces + pieces.face[t], {cut.corners + a, cut.corners + b, cut.corners + c}});
  }
  count += pieces.polygons;
  fans += pieces.fans;
  cut.faces += static_cast<std::uint32_t>(sizes.size());
  cut.corners += static_cast<std::uint32_t>(named.size());
}

std::vector<std::uint32_t> MeshSpool::polygons_of(std::span<const std::uint32_t> of_triangles) const {
  if (!polygons) return {};
  std::vector<std::uint32_t> faces;
  for (const std::uint32_t t : of_triangles) faces.push_back(source(t).face);
  return VertexRanks(faces).rank;
}

void cut_polygons(MeshSpool& mesh, const Lattice& lattice, const LargeWork& work) {
  if (!mesh.polygons) return;
  mesh.polygons->cut(mesh.points, lattice, work);
}

MeshSpool spool_mesh(const std::filesystem::path& file, std::optional<bool> weld_points, const LargeWork& work) {
  MeshSpool mesh(work.folder);
  PieceSpooler spooler(mesh);
  mesh_file::MeshData rest = mesh_file::read_in_pieces(file, spooler, [&](double done) { work.report("read", done); });
  mesh.points.finish();
  for (SpooledAttribute& attribute : mesh.attributes) attribute.finish();
  mesh.triangles.flush();
  if (mesh.polygons) mesh.polygons->finish();
  mesh.references = std::move(rest.references);
  mesh.dropped = std::move(rest.dropped);
  mesh.in_a_face.resize(static_cast<std::size_t>(mesh.points.size()));
  if (weld_points.value_or(rest.soup)) weld(mesh, work);
  if (mesh.polygons)
    mesh.polygons->corners.for_each_piece([&](std::span<const std::uint32_t> piece, std::uint64_t) {
      work.report("read", 1);
      for (const std::uint32_t v : piece) mesh.in_a_face[v] = true;
    });
  else
    mesh.triangles.for_each_piece([&](std::span<const Triangle> piece, std::uint64_t) {
      work.report("read", 1);
      for (const Triangle& t : piece)
        for (const std::uint32_t v : t) mesh.in_a_face[v] = true;
    });
  return mesh;
}

}  // namespace ramcdb::detail
