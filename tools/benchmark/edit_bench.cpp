// ramcdb-bench-edits [--bits N] [--threads N] FILE...
//
// What edits do to the size of what they touch, as in the paper's section 7.5: a region is smoothed 100 times, and in
// the mesh as it was the same region is stretched at its tip. A table as Markdown on standard output.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "api/chart_loader.h"
#include "ramcdb/built_in_edits.h"
#include "tools/benchmark/program.h"
#include "tools/benchmark/scratch_folder.h"

namespace ramcdb::benchmark {
namespace {

/// The part of a mesh that is edited: a tenth of its largest extent around its outermost vertex along that.
struct Part {
  Point tip, outwards;  ///< `outwards`: from the middle, as long as the radius
  double radius = 0;
};

Part part_of(const Snapshot& snapshot) {
  const MeshInfo info = snapshot.info();
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (info.hi[a] - info.lo[a] > info.hi[axis] - info.lo[axis]) axis = a;
  const RegionMesh mesh = snapshot.read(snapshot.find({{WholeMesh{}}, 0}));
  const auto outermost = std::max_element(mesh.points.begin(), mesh.points.end(),
                                          [&](LatticePoint a, LatticePoint b) { return a[axis] < b[axis]; });
  Part part{snapshot.position(*outermost), {}, (info.hi[axis] - info.lo[axis]) / 10};
  part.outwards[axis] = part.radius;
  return part;
}

/// Bits per vertex of charts and the wires that they pass.
double bits_of(const Snapshot& snapshot, const std::vector<ChartId>& charts) {
  detail::ChartLoader loader(snapshot.impl());
  std::uint64_t bytes = 0;
  for (const detail::LoadedChart& chart : loader.load(charts)) bytes += chart.blob_bytes;
  for (const auto& [id, wire] : loader.wires()) bytes += wire.blob_bytes;
  return 8 * static_cast<double>(bytes) / static_cast<double>(snapshot.read(charts).points.size());
}

void print_row(const Repository& repository, const std::string& what, const std::vector<ChartId>& charts,
               const CommitReport& report) {
  const Snapshot before = repository.snapshot({}, "1"), after = repository.snapshot();
  fmt::print("| {} | {} | {} | {} | {:.2f} | {:.2f} | {} | {:.2f} |\n", after.info().mesh, what, charts.size(),
             report.vertices_moved, bits_of(before, charts), bits_of(after, charts), report.bytes_written,
             report.seconds);
}

template <class Edit>
void measure(const std::filesystem::path& file, unsigned bits, const std::string& what, const Edit& edit) {
  const ScratchFolder scratch;
  Repository::create(scratch.path());
  Repository repository = Repository::open(scratch.path());
  ImportOptions options;
  options.bits = bits;
  (void)repository.import(file, options);
  const Part part = part_of(repository.snapshot());
  const std::vector<ChartId> charts = repository.snapshot().find({{InSphere{part.tip, part.radius}}, 0});
  print_row(repository, what, charts, edit(repository, part, charts));
}

void measure_edits(const std::filesystem::path& file, unsigned bits, unsigned threads) {
  measure(file, bits, "smoothed 100 times",
          [&](Repository& repository, const Part&, const std::vector<ChartId>& charts) {
            SmoothOptions options;
            options.iterations = 100;
            options.commit = {"smooth", "benchmark", "main", threads, {}};
            return repository.smooth({}, {{OfCharts{charts}}, 0}, options);
          });
  measure(file, bits, "stretched", [&](Repository& repository, const Part& part, const std::vector<ChartId>&) {
    TransformOptions options;
    options.matrix = translation(part.outwards);
    options.falloff = part.radius;
    options.commit = {"stretch", "benchmark", "main", threads, {}};
    return repository.transform({}, {{NearestTo{part.tip}}, 0}, options);
  });
}

int run(int argc, char** argv) {
  CLI::App app("What edits do to the size of what they touch");
  std::vector<std::string> files;
  unsigned bits = 12, threads = 1;
  app.add_option("--bits", bits, "Lattice bits along the largest extent (default: 12)");
  app.add_option("--threads", threads, "Threads (default: 1)");
  app.add_option("FILE", files, "Meshes")->required()->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "| mesh | edit | charts | vertices moved | bits/vertex before | after | bytes written | seconds |\n"
      "|---|---|---:|---:|---:|---:|---:|---:|\n");
  for (const std::string& file : files) measure_edits(file, bits, threads);
  return 0;
}

}  // namespace
}  // namespace ramcdb::benchmark

int main(int argc, char** argv) { return ramcdb::benchmark::run_guarded(ramcdb::benchmark::run, argc, argv); }
