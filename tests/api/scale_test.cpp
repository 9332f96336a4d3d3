#include <chrono>
#include <random>

#include "tests/api/numbered_edits.h"

/// What it costs, in bytes and blobs, when meshes get large. Times are the benchmark's.
namespace ramcdb::test {
namespace {

struct Cost {
  ReadCost read;
  std::uint64_t written = 0;
};

/// The largest cost of reading and of committing one chart of about 5,000 faces.
Cost one_chart_cost(int cells) {
  TempRepository repository(terrain(cells, cells), 5000, 12);
  const std::uint32_t charts = static_cast<std::uint32_t>(repository->snapshot().info().charts);
  Cost most;
  for (const std::uint32_t id : {1U, charts / 3 + 1, charts / 2 + 1, charts}) {
    ReadCost read;
    (void)repository->snapshot().read({ChartId(id)}, 1, &read);
    most.read.blobs = std::max(most.read.blobs, read.blobs);
    most.read.bytes = std::max(most.read.bytes, read.bytes);
    most.read.pages = std::max(most.read.pages, read.pages);
    auto edit = repository->begin_edit();
    Patch& patch = edit.checkout({{OfCharts{{ChartId(id)}}}, 0});
    for (const auto v : patch.mesh().all_vertices())
      if (!patch.on_outer_border(v)) {
        patch.mesh().set_point(v, patch.mesh().point(v) + Patch::Mesh::Point(0, 0, edit.base().lattice().step));
        break;
      }
    CommitOptions options;
    options.message = "one";
    most.written = std::max(most.written, edit.commit(options).bytes_written);
  }
  return most;
}

TEST(Scale, OneChartOfAMillionFacesCostsWhatOneOfFiftyThousandDoes) {
  const Cost small = one_chart_cost(158), large = one_chart_cost(707);
  std::printf("50 k faces: read %llu bytes in %llu blobs, written %llu; 1 M faces: %llu in %llu, %llu\n",
              static_cast<unsigned long long>(small.read.bytes), static_cast<unsigned long long>(small.read.blobs),
              static_cast<unsigned long long>(small.written), static_cast<unsigned long long>(large.read.bytes),
              static_cast<unsigned long long>(large.read.blobs), static_cast<unsigned long long>(large.written));
  EXPECT_LE(large.read.bytes, 2 * small.read.bytes);
  EXPECT_LE(large.read.pages, 4U);
  EXPECT_LE(large.written, 2 * small.written);
}

TEST(Scale, VersionsOfAMillionFacesThatDifferInOneChartAreComparedByIt) {
  TempRepository repository(terrain(707, 707), 5000, 12);
  const Snapshot before = repository->snapshot();
  auto edit = repository->begin_edit();
  Patch& patch = edit.checkout({{OfCharts{{ChartId(40)}}}, 0});
  for (const auto f : patch.mesh().all_faces()) {
    bool inside = true;
    for (const auto v : patch.mesh().fv_range(f)) inside = inside && !patch.on_outer_border(v);
    if (!inside) continue;
    patch.mesh().split(f, patch.mesh().calc_face_centroid(f));
    break;
  }
  (void)edit.commit(message("one"));
  const auto start = std::chrono::steady_clock::now();
  const DiffReport diff = repository->diff(before, repository->snapshot());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("diff of 1 M faces: %.1f ms, %llu bytes in %llu blobs, %llu of them pages\n", 1e3 * seconds,
              static_cast<unsigned long long>(diff.bytes_read), static_cast<unsigned long long>(diff.blobs_read),
              static_cast<unsigned long long>(diff.pages_read));
  EXPECT_EQ(diff.faces_added, 3U);
  EXPECT_EQ(diff.vertices_added, 1U);
  EXPECT_EQ(diff.changed, std::vector{ChartId(40)});
  EXPECT_LE(diff.pages_read, 8U);
  EXPECT_LE(diff.blobs_read, 40U);
}

TEST(Scale, TheStoreCostsLittleOverItsBlobs) {
  TempRepository repository(scan(420'000), 5000, ImportOptions().bits);
  const MeshInfo info = repository->snapshot().info();
  const double ratio = static_cast<double>(info.bytes.store) / static_cast<double>(info.bytes.payload);
  std::printf("payload %llu bytes, store %.3f times that\n", static_cast<unsigned long long>(info.bytes.payload),
              ratio);
  EXPECT_LE(ratio, 1.08);
}

}  // namespace
}  // namespace ramcdb::test
