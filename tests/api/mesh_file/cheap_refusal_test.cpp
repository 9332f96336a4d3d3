#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "tests/api/mesh_file/bad_files.h"
#include "tests/api/mesh_file/files.h"
#include "tests/support/memory_watch.h"
#include "tests/support/meshes.h"

/// Broken files are found out cheaply, whatever they announce. Bounds are on memory, held at once and taken in all,
/// which every piece of work here needs; times depend on the machine and are only printed.
namespace ramcdb::test {
namespace {

constexpr std::size_t kMostHeld = std::size_t{64} << 20, kMostTaken = std::size_t{256} << 20;

struct Worst {
  std::size_t held = 0, taken = 0;
  double seconds = 0;
};

/// Reads and judges; what is read is given back.
template <class Read>
void watch(const std::string& name, const Read& read, Worst& worst) {
  const auto begin = std::chrono::steady_clock::now();
  const MemoryWatch memory;
  try {
    read();
  } catch (const Error&) {
  }
  const std::size_t held = memory.peak(), taken = memory.taken();
  EXPECT_LT(held, kMostHeld) << name;
  EXPECT_LT(taken, kMostTaken) << name;
  worst.held = std::max(worst.held, held);
  worst.taken = std::max(worst.taken, taken);
  worst.seconds =
      std::max(worst.seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

void print(const std::string& what, const Worst& worst) {
  fmt::print("{}: at most {} KiB held, {} KiB taken, {:.3f} s\n", what, worst.held >> 10, worst.taken >> 10,
             worst.seconds);
}

TEST(CheapRefusal, HandMadeFiles) {
  const std::pair<std::string, std::vector<BadFile>> tables[] = {
      {"a.ply", bad_ply_files()}, {"a.obj", bad_obj_files()}, {"a.off", bad_off_files()}, {"a.stl", bad_stl_files()}};
  for (const auto& [name, files] : tables) {
    Worst worst;
    for (const BadFile& file : files)
      watch(
          file.name, [&] { (void)read_text(name, file.bytes); }, worst);
    print(name, worst);
  }
}

/// 64 KiB that announce as much as they may, in the ways that a file's length cannot disprove at once.
TEST(CheapRefusal, FilesThatAnnounceAllTheyMay) {
  constexpr std::size_t kSize = 64 << 10;
  std::string properties;
  for (int i = 0; i < 1000; ++i) properties += fmt::format("property char p{}\n", i);
  const std::string xyz = "property char x\nproperty char y\nproperty char z\n";
  const std::pair<const char*, std::string> all[] = {
      {"a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 60000\n" + xyz + "end_header\n"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 8000\n" + xyz + "end_header\n"},
      {"a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 40\n" + xyz + properties + "end_header\n"},
      {"a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + xyz +
                    "element face 9000\nproperty list uchar char vertex_indices\nproperty list uchar char "
                    "texcoord\nend_header\n"},
      {"a.off", "OFF\n10000 30000 0\n"},
      {"a.off", "STCNOFF\n10000 30000 0\n0 0 0 1 1 1 1 1 1 1 1\n"},
      {"a.obj", "v 0 0 0\nf"},
      {"a.obj", "usemtl a\n"},
      {"a.stl", std::string(80, ' ') + bytes_of(std::uint32_t{1310})},
      {"a.stl", "solid a\n"},
  };
  Worst worst;
  for (const auto& [name, head] : all)
    for (const std::string& filling : {std::string(1, '\0'), std::string(1, '\1'), std::string(1, '\3'),
                                       std::string("1 "), std::string("\n"), std::string("/"), std::string("g a\n")}) {
      std::string bytes = head;
      while (bytes.size() < kSize) bytes += filling;
      watch(
          head, [&, file = name] { (void)read_text(file, bytes); }, worst);
    }
  print("64 KiB", worst);
}

TEST(CheapRefusal, ARealBrokenFile) {
  const auto folder = meshes_folder();
  if (!folder) GTEST_SKIP() << "no folder of real meshes: set RAMCDB_MESHES";
  const auto file = *folder / "tiny/toomanyvertices.stl";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "not there: tiny/toomanyvertices.stl";
  Worst worst;
  watch(
      file.filename(), [&] { EXPECT_THROW((void)mesh_file::read_mesh(file), Error); }, worst);
  print(file.filename(), worst);
}

}  // namespace
}  // namespace ramcdb::test
