#include <cstdio>

#include "tests/api/temp_repository.h"
#include "tests/support/memory_watch.h"

/// What a mesh takes of the heap on its way in and out of a repository, when it is larger than what it may take.
namespace ramcdb::test {
namespace {

TEST(LargeMemory, AMillionFacesComeInAndGoOutInLessThanAThirdOfWhatTheyTakeInCore) {
  const TempFolder folder;
  write_test_mesh(terrain(707, 707), folder / "mesh.ply");
  Repository::create(folder / "r.ramcdb");
  Repository repository = Repository::open(folder / "r.ramcdb");
  ImportOptions options;
  options.threads = 2;
  std::size_t in_core = 0;
  {
    const MemoryWatch watch;
    options.name = "in core";
    (void)repository.import(folder / "mesh.ply", options);
    in_core = watch.peak();
  }
  {
    const MemoryWatch watch;
    options.name = "large";
    options.memory = std::uint64_t{48} << 20;
    const ImportReport report = repository.import(folder / "mesh.ply", options);
    EXPECT_EQ(report.info.faces, 2U * 707 * 707);
    std::printf("import: %.1f MB at most, in core %.1f MB\n", static_cast<double>(watch.peak()) / 1e6,
                static_cast<double>(in_core) / 1e6);
    EXPECT_LT(watch.peak(), *options.memory * 5 / 4);
    EXPECT_LT(watch.peak(), in_core / 3);
  }
  FileOptions file;
  file.threads = 2;
  for (const char* name : {"out.ply", "out.stl", "out.obj"}) {
    const MemoryWatch watch;
    (void)repository.export_mesh(repository.snapshot("large"), folder / name, file);
    std::printf("%s: %.1f MB at most\n", name, static_cast<double>(watch.peak()) / 1e6);
    EXPECT_LT(watch.peak(), in_core / 3);
  }
}

}  // namespace
}  // namespace ramcdb::test
