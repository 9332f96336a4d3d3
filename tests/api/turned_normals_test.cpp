#include <cmath>

#include "api/turned_normals.h"
#include "ramcdb/built_in_edits.h"
#include "tests/api/painted_grid.h"

/// Normals that are kept as attributes turn with the surface that a map moves.
namespace ramcdb::test {
namespace {

using detail::Derivative;

const Region kWhole{{WholeMesh{}}, 0};

double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point minus(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Point unit(const Point& a) {
  const double size = std::sqrt(dot(a, a));
  return {a.x / size, a.y / size, a.z / size};
}

Point value(const Attribute& attribute, std::size_t at) {
  return {attribute.values[3 * at], attribute.values[3 * at + 1], attribute.values[3 * at + 2]};
}

/// A smooth hill with its normals, at vertices and faces or at corners, all of length 1 but the faces' of length 2.
mesh_file::MeshData hill(bool at_corners) {
  constexpr std::uint32_t n = 30;
  mesh_file::MeshData mesh;
  Attribute vertex = make_attribute("normal", AttributeOf::vertex, NumberType::float32, 3, Meaning::normal);
  Attribute corner = make_attribute("normal", AttributeOf::corner, NumberType::float32, 3, Meaning::normal);
  Attribute face = make_attribute("normal", AttributeOf::face, NumberType::float64, 3, Meaning::normal);
  const auto height = [](double x, double y) {
    return 4 * std::exp(-((x - 10) * (x - 10) + (y - 10) * (y - 10)) / 40);
  };
  const auto normal_at = [&](double x, double y) {
    const double h = height(x, y);
    return unit({h * (x - 10) / 20, h * (y - 10) / 20, 1});
  };
  const auto add = [](Attribute& to, const Point& p, double size = 1) {
    for (int k = 0; k < 3; ++k) to.values.push_back(double{static_cast<float>(size * p[k])});
  };
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) {
      mesh.positions.push_back({x * 1.0, y * 1.0, height(x, y)});
      add(vertex, normal_at(x, y));
    }
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t v = y * (n + 1) + x;
      for (const Triangle& t : {Triangle{v, v + 1, v + n + 2}, Triangle{v, v + n + 2, v + n + 1}}) {
        mesh.face_sizes.push_back(3);
        mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
        for (const std::uint32_t c : t) add(corner, value(vertex, c));
        add(face,
            unit(cross(minus(mesh.positions[t[1]], mesh.positions[t[0]]),
                       minus(mesh.positions[t[2]], mesh.positions[t[0]]))),
            2);
      }
    }
  mesh.attributes = at_corners ? std::vector<Attribute>{corner} : std::vector<Attribute>{vertex, face};
  return mesh;
}

/// The normals kept at one kind of place; null without.
const Attribute* normals_of(const RegionMesh& mesh, AttributeOf of) {
  const auto found = std::ranges::find_if(
      mesh.attributes, [&](const Attribute& a) { return a.info.meaning == Meaning::normal && a.info.of == of; });
  return found == mesh.attributes.end() ? nullptr : &*found;
}

/// The least cosine between the faces' planes and the normals kept at faces, corners and vertices.
double worst_fit(const Snapshot& snapshot) {
  const RegionMesh mesh = whole(snapshot);
  double worst = mesh.attributes.empty() ? -1 : 1;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const Point a = snapshot.position(mesh, mesh.faces[f][0]);
    const Point plane = unit(cross(minus(snapshot.position(mesh, mesh.faces[f][1]), a),
                                   minus(snapshot.position(mesh, mesh.faces[f][2]), a)));
    const auto look = [&](AttributeOf of, std::size_t at) {
      if (const Attribute* normals = normals_of(mesh, of))
        worst = std::min(worst, dot(plane, unit(value(*normals, at))));
    };
    look(AttributeOf::face, f);
    for (std::uint32_t i = 0; i < 3; ++i) {
      look(AttributeOf::corner, 3 * f + i);
      look(AttributeOf::vertex, mesh.faces[f][i]);
    }
  }
  return worst;
}

/// A repository with the hill, from a file of a format that has such normals.
class Hill {
 public:
  explicit Hill(bool at_corners) {
    Repository::create(folder_ / "r.ramcdb");
    repository_.emplace(Repository::open(folder_ / "r.ramcdb"));
    const auto file = folder_ / (at_corners ? "hill.obj" : "hill.ply");
    write_data(hill(at_corners), file);
    ImportOptions options;
    options.chart_faces = 300;
    (void)repository_->import(file, options);
  }
  [[nodiscard]] Repository* operator->() { return &*repository_; }

 private:
  TempFolder folder_;
  std::optional<Repository> repository_;
};

CommitReport transform(Hill& repository, const Region& region, const Matrix& matrix, double falloff = 0) {
  TransformOptions options;
  options.matrix = matrix;
  options.falloff = falloff;
  options.commit = message("transform");
  options.commit.threads = 2;
  return repository->transform({}, region, options);
}

TEST(TurnedNormals, TheMapOfNormalsKeepsThemUprightOnEveryPlane) {
  const Derivative shear{1, 2, 0, 0, 1, 0, 0, 0, 3}, mirror{-1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(detail::normal_map(shear), (Derivative{3, 0, 0, -6, 3, 0, 0, 0, 1}));
  EXPECT_EQ(detail::normal_map(mirror), (Derivative{-1, 0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST(TurnedNormals, FollowTurnsAndUnevenScales) {
  for (const bool at_corners : {false, true}) {
    Hill repository(at_corners);
    const double before = worst_fit(repository->snapshot());
    ASSERT_GT(before, 0.9);
    const CommitReport turned = transform(repository, kWhole, rotation({1, 2, 3}, 140, {15, 15, 0}));
    EXPECT_TRUE(turned.normals_left.empty());
    EXPECT_GT(turned.layers_reencoded, 0U);
    EXPECT_NEAR(worst_fit(repository->snapshot()), before, 1e-3);
    (void)transform(repository, kWhole, rotation({1, 2, 3}, -140, {15, 15, 0}));
    (void)transform(repository, kWhole, scaling({1, 1, 0.25}, {0, 0, 0}));
    EXPECT_GT(worst_fit(repository->snapshot()), before);
    EXPECT_TRUE(repository->verify({}).ok());
  }
}

TEST(TurnedNormals, KeepTheirLengths) {
  Hill repository(false);
  (void)transform(repository, kWhole, scaling({1, 3, 0.25}, {0, 0, 0}));
  const RegionMesh mesh = whole(repository->snapshot());
  const Attribute& normals = *normals_of(mesh, AttributeOf::face);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    EXPECT_NEAR(std::sqrt(dot(value(normals, f), value(normals, f))), 2, 1e-3);
}

TEST(TurnedNormals, FollowAFadingMapAlsoWhereItBends) {
  for (const bool at_corners : {false, true}) {
    Hill repository(at_corners);
    const double before = worst_fit(repository->snapshot());
    (void)transform(repository, {{InSphere{{20, 20, 0}, 1}}, 0}, translation({0, 0, 3}), 9);
    EXPECT_GT(worst_fit(repository->snapshot()), before - 0.04) << "slopes of up to one half were made";
    (void)transform(repository, {{InBox{{5, 5, -9}, {8, 8, 9}}}, 0}, rotation({0, 0, 1}, 40, {6, 6, 0}), 9);
    EXPECT_GT(worst_fit(repository->snapshot()), before - 0.1);
    EXPECT_TRUE(repository->verify({}).ok());
  }
}

TEST(TurnedNormals, MovesWithoutATurnTouchNone) {
  Hill repository(false);
  const CommitReport report = transform(repository, kWhole, translation({1, 2, 3}));
  EXPECT_TRUE(report.normals_left.empty()) << "they still fit";
  EXPECT_EQ(report.layers_reencoded, 0U);
}

TEST(TurnedNormals, OfOneChartAreThoseOfItsVertices) {
  Hill repository(false);
  const Snapshot base = repository->snapshot();
  const RegionMesh before = whole(base);
  (void)transform(repository, {{OfCharts{{ChartId(2)}}}, 0}, rotation({0, 0, 1}, 180, {0, 0, 0}));
  const RegionMesh after = whole(repository->snapshot());
  std::map<LatticePoint, Point> normals;
  for (std::size_t v = 0; v < after.points.size(); ++v)
    normals[after.points[v]] = value(*normals_of(after, AttributeOf::vertex), v);
  std::vector<bool> of_chart(before.points.size(), false);
  for (std::uint32_t f = 0; f < before.faces.size(); ++f)
    for (const std::uint32_t v : before.faces[f])
      if (before.charts[before.chart_of_face[f]] == ChartId(2)) of_chart[v] = true;
  for (std::size_t v = 0; v < before.points.size(); ++v) {
    const Point was = value(*normals_of(before, AttributeOf::vertex), v), p = base.position(before, v);
    const double sign = of_chart[v] ? -1 : 1;
    const auto is = normals.find(base.lattice().snap({sign * p.x, sign * p.y, p.z}));
    ASSERT_NE(is, normals.end());
    EXPECT_NEAR(is->second.x, sign * was.x, 1e-4);
    EXPECT_NEAR(is->second.y, sign * was.y, 1e-4);
  }
  EXPECT_TRUE(repository->verify({}).ok());
}

}  // namespace
}  // namespace ramcdb::test
