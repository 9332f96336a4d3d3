#include <chrono>
#include <cstdio>
#include <set>

#include "tests/api/edited_region.h"
#include "tests/api/face_records.h"
#include "tests/api/mesh_cut.h"

// Two states of a mesh that people made: poses, deformations, filled holes, levels of detail. The first is imported, a
// region of it checked out, and what the second holds there comes back as the edited file.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;
using mesh_file::MeshData;

constexpr std::uint32_t kPairChartFaces = 500;

class Pair {
 public:
  Pair(const fs::path& from, const fs::path& to)
      : repository_(make(folder_)), first_(import(from)), to_(to), second_(mesh_file::read_mesh(to)) {
    // A file with no vertex without a face is of a program that does not keep them: those that were there stay.
    if (!PlacedMesh(second_, first_.lattice()).isolated.empty()) return;
    staying_ = PlacedMesh::of(whole(first_)).isolated;
    const std::vector<LatticePoint> used = snapped(first_.lattice(), second_.positions);
    const std::set<LatticePoint> places(used.begin(), used.end());
    std::erase_if(staying_, [&](const auto& vertex) { return places.contains(vertex.second); });
  }

  /// All of the second mesh, in its own file.
  void commit_all() {
    const fs::path file = check_out(first_.find({{WholeMesh{}}, 0}), "all");
    fs::copy_file(to_, file, fs::copy_options::overwrite_existing);
    commit(file);
    expect_the_second();
  }

  /// Only what differs, with the charts around it. False when that is all of the mesh.
  bool commit_region() {
    const Difference differ = difference();
    const std::vector<ChartId> all = first_.find({{WholeMesh{}}, 0});
    if (differ.may_change.empty()) return false;
    std::vector<ChartId> region = around(differ.may_change);
    if (region.size() == all.size()) return false;
    const fs::path file = check_out(region, "region");
    write_data(part_of_second(region), file);
    commit(file);
    expect_the_second();
    expect_untouched(differ);
    std::printf("    %zu of %zu charts differ: the file had %zu, %llu were written\n", differ.changed.size(),
                all.size(), region.size(),
                static_cast<unsigned long long>(report_.charts_reencoded + report_.charts_added));
    return true;
  }

  [[nodiscard]] const CommitReport& report() const { return report_; }

 private:
  static Repository make(const TempFolder& folder) {
    Repository::create(folder / "r");
    return Repository::open(folder / "r");
  }

  Snapshot import(const fs::path& from) {
    ImportOptions options;
    options.name = "mesh";
    options.chart_faces = kPairChartFaces;
    options.threads = 2;
    (void)repository_.import(from, options);
    return repository_.snapshot();
  }

  fs::path check_out(const std::vector<ChartId>& charts, const std::string& name) {
    const fs::path file = folder_ / (name + to_.extension().string());
    FileOptions options;
    options.local_origin = false;
    (void)repository_.checkout_file(first_, charts, file, options);
    return file;
  }

  void commit(const fs::path& file) {
    CommitOptions options = message("the second");
    options.onto = "second" + std::to_string(++commits_);
    report_ = repository_.commit_file(file, options);
    EXPECT_TRUE(report_.conflicts.empty());
    second_snapshot_ = report_.nothing_changed ? first_ : repository_.snapshot({}, options.onto);
  }

  /// The new version is the second mesh on the first one's lattice: faces, vertices, and attributes that both have.
  void expect_the_second() {
    const Snapshot& now = *second_snapshot_;
    const fs::path file = folder_ / ("out" + to_.extension().string());
    (void)repository_.export_mesh(now, file, {});
    const MeshData out = mesh_file::read_mesh(file);
    EXPECT_TRUE(face_set(snapped(now.lattice(), out.positions), out.corners, out.face_sizes) ==
                face_set(snapped(now.lattice(), second_.positions), second_.corners, second_.face_sizes))
        << "faces";
    auto is = snapped(now.lattice(), out.positions), expected = snapped(now.lattice(), second_.positions);
    for (const auto& [v, p] : staying_) expected.push_back(p);
    std::ranges::sort(is);
    std::ranges::sort(expected);
    EXPECT_TRUE(is == expected) << "vertices: " << is.size() << " instead of " << expected.size();
    std::vector<MeshInfo::Layer> layers;
    for (const auto& layer : now.info().attributes)
      if (has(out, layer.info) && has(second_, layer.info)) layers.push_back(layer);
    EXPECT_TRUE(face_records(out, now.lattice(), layers) == face_records(second_, now.lattice(), layers))
        << "attributes";
    EXPECT_TRUE(repository_.verify({}).ok());
  }

  static bool has(const MeshData& mesh, const AttributeInfo& info) {
    return std::ranges::any_of(mesh.attributes, [&](const Attribute& a) { return a.info.name == info.name; });
  }

  struct Difference {
    std::set<ChartId> changed;     ///< have a face, or a vertex without face, that the second mesh does not have
    std::set<ChartId> may_change;  ///< these, and those with a vertex of a face that only the second mesh has
  };
  Difference difference() const {
    const PlacedMesh second(second_, first_.lattice());
    Counted<PlacedFace> faces;
    Counted<LatticePoint> isolated;
    for (const PlacedFace& face : second.faces) faces.add(face);
    for (const auto& [v, p] : second.isolated) isolated.add(p);
    for (const auto& [v, p] : staying_) isolated.add(p);
    Difference differ;
    std::map<LatticePoint, std::set<ChartId>> at;
    for (const ChartId id : first_.find({{WholeMesh{}}, 0})) {
      const RegionMesh region = first_.read_with_attributes({id});
      for (const LatticePoint p : region.points) at[p].insert(id);
      const PlacedMesh chart = PlacedMesh::of(region);
      for (const PlacedFace& face : chart.faces)
        if (!faces.take(face)) differ.changed.insert(id);
      for (const auto& [v, p] : chart.isolated)
        if (!isolated.take(p)) differ.changed.insert(id);
    }
    differ.may_change = differ.changed;
    for (const auto& [face, count] : faces.left())
      for (const LatticePoint p : face) differ.may_change.insert(at[p].begin(), at[p].end());
    return differ;
  }

  std::vector<ChartId> around(const std::set<ChartId>& charts) const {
    return first_.find({{OfCharts{{charts.begin(), charts.end()}}}, 1});
  }

  /// The second mesh without the faces that charts outside of the region have.
  MeshData part_of_second(const std::vector<ChartId>& region) const {
    std::vector<ChartId> outside;
    for (const ChartId id : first_.find({{WholeMesh{}}, 0}))
      if (!std::ranges::binary_search(region, id)) outside.push_back(id);
    const PlacedMesh others = PlacedMesh::of(first_.read_with_attributes(outside));
    const PlacedMesh second(second_, first_.lattice());
    Counted<PlacedFace> faces;
    Counted<LatticePoint> isolated;
    for (const PlacedFace& face : others.faces) faces.add(face);
    if (staying_.empty())
      for (const auto& [v, p] : others.isolated) isolated.add(p);
    std::vector<bool> inside;
    for (const PlacedFace& face : second.faces) inside.push_back(!faces.take(face));
    std::vector<std::uint32_t> inside_isolated;
    for (const auto& [v, p] : second.isolated)
      if (!isolated.take(p)) inside_isolated.push_back(v);
    EXPECT_TRUE(faces.empty() && isolated.empty());
    return cut_out(second_, inside, inside_isolated);
  }

  /// Charts are written where the meshes differ; where faces came or went, charts next to these may be cut anew.
  void expect_untouched(const Difference& differ) const {
    std::set<ChartId> may = differ.changed;
    if (report_.faces_added + report_.faces_removed > 0)
      for (const ChartId id : around(differ.may_change)) may.insert(id);
    for (const ChartSummary& chart : second_snapshot_->describe(second_snapshot_->find({{WholeMesh{}}, 0}))) {
      const bool written = chart.version == second_snapshot_->version();
      const bool added = std::ranges::binary_search(report_.added, chart.id);
      EXPECT_TRUE(!written || added || may.contains(chart.id)) << "chart " << chart.id.value << " was written";
      EXPECT_TRUE(written || !differ.changed.contains(chart.id)) << "chart " << chart.id.value << " was not written";
    }
  }

  TempFolder folder_;
  Repository repository_;
  Snapshot first_;
  fs::path to_;
  MeshData second_;
  std::map<std::uint32_t, LatticePoint> staying_;  ///< vertices without faces
  CommitReport report_;
  std::optional<Snapshot> second_snapshot_;
  int commits_ = 0;
};

/// \return whether only a part differed
bool expect_pair(const fs::path& from, const fs::path& to) {
  const std::string name = from.filename().string() + " -> " + to.filename().string();
  SCOPED_TRACE(name);
  const auto begin = std::chrono::steady_clock::now();
  bool part = false;
  try {
    Pair pair(from, to);
    pair.commit_all();
    std::printf("%s: %llu vertices moved, %llu came, %llu went, %llu faces came, %llu went%s\n", name.c_str(),
                static_cast<unsigned long long>(pair.report().vertices_moved),
                static_cast<unsigned long long>(pair.report().vertices_added),
                static_cast<unsigned long long>(pair.report().vertices_removed),
                static_cast<unsigned long long>(pair.report().faces_added),
                static_cast<unsigned long long>(pair.report().faces_removed),
                pair.report().nothing_changed ? ": nothing changed" : "");
    part = pair.commit_region();
  } catch (const std::exception& error) {
    ADD_FAILURE() << error.what();
  }
  std::printf("    %.1f s\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  std::fflush(stdout);
  return part;
}

struct PairOfFiles {
  const char *from, *to;
};

constexpr PairOfFiles kPairs[] = {
    // poses and frames
    {"pairs/elephant_ref.ply", "pairs/elephant_gallop_01.ply"},
    {"pairs/elephant_gallop_01.ply", "pairs/elephant_gallop_02.ply"},
    {"pairs/horse_pose_ref.obj", "pairs/horse_pose_01.obj"},
    {"pairs/horse_pose_01.obj", "pairs/horse_pose_05.obj"},
    {"pairs/horse_pose_05.obj", "pairs/horse_pose_09.obj"},
    {"pairs/chicken_050.obj", "pairs/chicken_100.obj"},
    {"pairs/chicken_100.obj", "pairs/chicken_150.obj"},
    // edits
    {"pairs/bimba_original.off", "pairs/bimba_deformed.obj"},
    {"pairs/self_intersectA.obj", "pairs/self_intersectB.obj"},
    {"pairs/ict_face_generic_neutral_mesh.obj", "pairs/ict_face_browDown_L.obj"},
    {"pairs/ict_face_generic_neutral_mesh.obj", "pairs/ict_face_jawOpen.obj"},
    {"pairs/ict_face_browDown_L.obj", "pairs/ict_face_jawOpen.obj"},
    {"scans/bunny.ply", "scans/bunny_repaired.off"},
    {"scans/bunny_repaired.off", "scans/bunny.ply"},
    {"attrib/rgb_swirl.off", "attrib/swirl_nocolor.off"},
    {"attrib/swirl_nocolor.off", "attrib/rgb_swirl.off"},
    {"ugly/blobby-shuffled.off", "ugly/blobby.off"},
    {"ugly/blobby.off", "ugly/blobby-shuffled.off"},
    // levels of detail
    {"terrain-cad/fandisk.off", "terrain-cad/fandisk_large.off"},
    {"terrain-cad/fandisk_large.off", "terrain-cad/fandisk.off"},
    {"terrain-cad/fandisk.off", "terrain-cad/fandisk_quads.off"},
    {"scans/armadillo_86k.ply", "scans/armadillo_52k.off"},
    {"scans/dragon_res2.ply", "scans/dragon_res3.ply"},
    {"scans/dragon_res3.ply", "scans/dragon_res4.ply"},
    {"scans/dragon_res4.ply", "scans/dragon_res3.ply"},
};

TEST(RealPairs, TheFirstBecomesTheSecond) {
  const auto folder = meshes_folder();
  if (!folder) GTEST_SKIP() << "no folder of real meshes: set RAMCDB_MESHES";
  const char* only = std::getenv("RAMCDB_PAIR");
  unsigned done = 0, parts = 0;
  for (const auto& [from, to] : kPairs) {
    if (only && (std::string(from) + to).find(only) == std::string::npos) continue;
    if (!fs::exists(*folder / from) || !fs::exists(*folder / to)) {
      std::printf("skipped, not there: %s -> %s\n", from, to);
      continue;
    }
    parts += expect_pair(*folder / from, *folder / to);
    ++done;
  }
  std::printf("%u of %zu pairs, of %u only a part\n", done, std::size(kPairs), parts);
}

/// What the real pairs are, made here.
class MadePairs : public ::testing::Test {
 protected:
  [[nodiscard]] bool expect(const TestMesh& from, const TestMesh& to) {
    write_test_mesh(from, folder_ / "from.ply");
    write_test_mesh(to, folder_ / "to.obj");
    return expect_pair(folder_ / "from.ply", folder_ / "to.obj");
  }

  TempFolder folder_;
};

TEST_F(MadePairs, APoseThatLeavesTheFirstBox) {
  const TestMesh from = irregular(scan(6000));
  TestMesh to = from;
  for (Point& p : to.positions) p = {1.3 * p.x + 0.2 * p.y + 9, p.z, -1.1 * p.y};
  EXPECT_FALSE(expect(from, shuffled(to, 4)));
}

TEST_F(MadePairs, OnePartThatMoved) {
  const TestMesh from = terrain(60, 60);
  TestMesh to = from;
  double left = from.positions[0].x, right = left;
  for (const Point& p : from.positions) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
  }
  for (Point& p : to.positions)
    if (p.x < left + 0.2 * (right - left)) p.z += 0.05 * (right - left);
  EXPECT_TRUE(expect(from, to));
  EXPECT_TRUE(expect(from, shuffled(to, 6)));
}

TEST_F(MadePairs, HolesThatWereFilled) {
  TestMesh from = terrain(60, 60), to = from;
  std::erase_if(from.faces,
                [&](const Triangle& t) { return t[0] % 61 > 3 && t[0] % 61 < 9 && t[0] / 61 > 3 && t[0] / 61 < 8; });
  EXPECT_TRUE(expect(from, to));
  EXPECT_TRUE(expect(to, from));
}

TEST_F(MadePairs, AnotherLevelOfDetail) {
  EXPECT_FALSE(expect(irregular(sphere(6000)), irregular(sphere(2000))));
  EXPECT_FALSE(expect(irregular(sphere(2000)), irregular(sphere(6000))));
}

TEST_F(MadePairs, FacesThatWereTurned) {
  const TestMesh from = irregular(scan(5000));
  TestMesh to = from;
  for (std::size_t f = 0; f < to.faces.size(); f += 3) std::swap(to.faces[f][0], to.faces[f][1]);
  EXPECT_FALSE(expect(from, shuffled(to, 7)));
}

}  // namespace
}  // namespace ramcdb::test
