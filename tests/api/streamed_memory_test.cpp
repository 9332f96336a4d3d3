#include <cstdio>

#include "ramcdb/built_in_edits.h"
#include "tests/api/whole_surface.h"
#include "tests/support/memory_watch.h"

/// Built-in edits and exports of a whole large mesh hold a few charts at a time.
namespace ramcdb::test {
namespace {

constexpr std::uint64_t kMemory = std::uint64_t{16} << 20;

TEST(StreamedMemory, AMillionFacesAreSmoothedAndMovedInLessThanHalfOfWhatTheirPositionsTake) {
  TempRepository repository(terrain(707, 707), 5000, 16);
  const std::size_t positions = repository->snapshot().info().vertices * sizeof(Point);
  SmoothOptions smooth;
  smooth.iterations = 20;
  smooth.memory = kMemory;
  smooth.commit.message = "smooth";
  smooth.commit.threads = 2;
  {
    const MemoryWatch watch;
    const CommitReport report = repository->smooth({}, kAll, smooth);
    EXPECT_GT(report.vertices_moved, 400'000U);
    std::printf("smooth: %.1f MB at most, positions alone are %.1f MB; %.2f s\n",
                static_cast<double>(watch.peak()) / 1e6, static_cast<double>(positions) / 1e6, report.seconds);
    EXPECT_LT(watch.peak(), positions / 2);
  }
  TransformOptions transform;
  transform.matrix = rotation({0, 0, 1}, 30, {});
  transform.memory = kMemory;
  transform.commit.message = "turn";
  transform.commit.threads = 2;
  const MemoryWatch watch;
  const CommitReport report = repository->transform({}, kAll, transform);
  EXPECT_GT(report.vertices_moved, 400'000U);
  std::printf("transform: %.1f MB at most; %.2f s\n", static_cast<double>(watch.peak()) / 1e6, report.seconds);
  EXPECT_LT(watch.peak(), positions / 2);
}

TEST(StreamedMemory, AMillionFacesAreExportedInLessThanHalfOfWhatTheirPositionsTake) {
  TempRepository repository(terrain(707, 707), 5000, 16);
  const Snapshot snapshot = repository->snapshot();
  FileOptions options;
  options.memory = kMemory;
  options.threads = 2;
  for (const char* name : {"out.ply", "out.obj", "out.stl"}) {
    const MemoryWatch watch;
    const CheckoutReport report = repository->export_mesh(snapshot, repository / name, options);
    EXPECT_GT(report.faces, 990'000U);
    std::printf("%s: %.1f MB at most; %.2f s\n", name, static_cast<double>(watch.peak()) / 1e6, report.seconds);
    EXPECT_LT(watch.peak(), report.vertices * sizeof(Point) / 2);
  }
}

}  // namespace
}  // namespace ramcdb::test
