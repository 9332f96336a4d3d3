// ramcdb-bench-commits [--bits N] [--rounds N] [--ramcdb PROGRAM] SMALL LARGE...
//
// What one edited chart costs, in CPU time (user and system; waiting for the disk is not counted): it is checked out to
// a file, which is edited and committed, chart after chart. By stages within one process that has the repository open,
// and in whole as two processes of PROGRAM. Medians as Markdown on standard output, and as multiples of the first mesh.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ramcdb/error.h"
#include "ramcdb/repository.h"
#include "tools/benchmark/file_edits.h"
#include "tools/benchmark/program.h"
#include "tools/benchmark/scratch_folder.h"
#include "tools/benchmark/timing.h"

namespace ramcdb::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 5> kCommitStages{"read charts", "read file", "match", "encode", "store"};
constexpr std::array<const char*, 7> kImportStages{"read", "snap", "sort", "chartify", "join", "encode", "store"};

/// Milliseconds of CPU per edit, one value per round.
struct Samples {
  std::vector<double> checkout, commit, processes, bytes_read, bytes_written, charts;
  std::array<std::vector<double>, kCommitStages.size()> stages;
};

class MeshBench {
 public:
  MeshBench(const fs::path& folder, std::string program)
      : folder_(folder / "repository"), file_(folder / "chart.ply"), program_(std::move(program)) {}

  /// Prints a row.
  void import(const fs::path& mesh, unsigned bits, unsigned threads, std::uint64_t memory) {
    Repository::create(folder_);
    repository_.emplace(Repository::open(folder_));
    StageClock clock("read");
    ImportOptions options;
    options.bits = bits;
    options.threads = threads;
    options.memory = memory;
    options.progress = clock.callback();
    const ImportReport report = repository_->import(mesh, options);
    clock.begin("end");
    charts_ = repository_->snapshot().find({{WholeMesh{}}, 0});
    fmt::print("| {} | {} | {:.2f} | {:.0f} |", report.info.mesh, report.info.faces,
               1e-6 * static_cast<double>(report.info.faces) / report.seconds, 1000 * clock.longest_silence());
    for (const char* stage : kImportStages) fmt::print(" {:.0f} |", 1000 * clock.seconds(stage));
    fmt::print("\n");
  }

  [[nodiscard]] Samples measure(FileEdit edit, unsigned rounds) {
    Samples samples;
    for (unsigned round = 0; round < rounds; ++round) {
      const ChartId chart = charts_[(2 * round + 1) * charts_.size() / (2 * rounds)];
      measure_here(edit, chart, samples);
      if (!program_.empty()) measure_processes(edit, chart, samples);
    }
    return samples;
  }

 private:
  void measure_here(FileEdit edit, ChartId chart, Samples& samples) {
    const double start = cpu_seconds();
    const CheckoutReport out = repository_->checkout_file(repository_->snapshot(), {chart}, file_, {});
    samples.checkout.push_back(1000 * (cpu_seconds() - start));
    samples.bytes_read.push_back(static_cast<double>(out.bytes_read));
    edit_file(file_, edit);
    StageClock clock(kCommitStages.front());
    CommitOptions options;
    options.message = "benchmark";
    options.progress = clock.callback();
    const double before = cpu_seconds();
    const CommitReport report = repository_->commit_file(file_, options);
    samples.commit.push_back(1000 * (cpu_seconds() - before));
    clock.begin("end");
    for (std::size_t s = 0; s < kCommitStages.size(); ++s)
      samples.stages[s].push_back(1000 * clock.seconds(kCommitStages[s]));
    samples.bytes_written.push_back(static_cast<double>(report.bytes_written));
    samples.charts.push_back(static_cast<double>(report.charts_reencoded));
  }

  void measure_processes(FileEdit edit, ChartId chart, Samples& samples) {
    const double out = run_program({program_, "checkout", folder_, "--charts", std::to_string(chart.value), "-o", file_,
                                    "--force", "--quiet", "-j", "1"})
                           .cpu_seconds;
    edit_file(file_, edit);
    samples.processes.push_back(
        1000 * (out + run_program({program_, "commit", file_, "-m", "benchmark", "--quiet", "-j", "1"}).cpu_seconds));
  }

  fs::path folder_, file_;
  std::string program_;
  std::optional<Repository> repository_;
  std::vector<ChartId> charts_;
};

struct Row {
  std::string mesh, edit;
  Samples samples;
};

void print_rows(const std::vector<Row>& rows) {
  fmt::print(
      "\nOne chart, milliseconds of CPU: checkout and commit, the stages of the commit, and both as processes of their "
      "own; beside the first mesh.\n\n| mesh | edit | checkout | commit |");
  for (const char* stage : kCommitStages) fmt::print(" {} |", stage);
  fmt::print(" round | to the first | two processes | bytes read | charts coded | bytes written |\n|---|---|");
  for (std::size_t i = 0; i < kCommitStages.size() + 8; ++i) fmt::print("---:|");
  fmt::print("\n");
  const auto round = [](const Samples& s) { return median(s.checkout) + median(s.commit); };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Samples& s = rows[i].samples;
    fmt::print("| {} | {} | {:.1f} | {:.1f} |", rows[i].mesh, rows[i].edit, median(s.checkout), median(s.commit));
    for (const auto& stage : s.stages) fmt::print(" {:.1f} |", median(stage));
    fmt::print(" {:.1f} | {:.2f} | {} | {:.0f} | {:.0f} | {:.0f} |\n", round(s), round(s) / round(rows[i % 2].samples),
               s.processes.empty() ? "" : fmt::format("{:.1f}", median(s.processes)), median(s.bytes_read),
               median(s.charts), median(s.bytes_written));
  }
}

int run(int argc, char** argv) {
  CLI::App app("What one edited chart costs in a small and a large mesh");
  std::vector<std::string> files;
  std::string program;
  unsigned bits = 16, rounds = 9, threads = 2;
  std::uint64_t memory = std::uint64_t{1} << 30;
  app.add_option("--bits", bits, "Lattice bits along the largest extent (default: 16)");
  app.add_option("--rounds", rounds, "Charts to edit in each mesh, each way (default: 9)")->check(CLI::Range(1, 1000));
  app.add_option("--threads", threads, "Threads of the import (default: 2)");
  app.add_option("--memory", memory, "Of the import, such as 512M (default: 1G)")->transform(CLI::AsSizeValue(false));
  app.add_option("--ramcdb", program, "The ramcdb command, for processes of its own")->check(CLI::ExistingFile);
  app.add_option("FILE", files, "Meshes; the first is what the others are compared with")
      ->required()
      ->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "Import with {} threads; milliseconds of CPU of all threads by stage, and of the clock for which it told no "
      "progress "
      "at most, and cannot be cancelled.\n\n| mesh | faces | million faces/s | silent |",
      threads);
  for (const char* stage : kImportStages) fmt::print(" {} |", stage);
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < kImportStages.size() + 3; ++i) fmt::print("---:|");
  fmt::print("\n");
  std::vector<Row> rows;
  for (const std::string& file : files) {
    const ScratchFolder scratch;
    MeshBench bench(scratch.path(), program);
    bench.import(file, bits, threads, memory);
    const std::string mesh = fs::path(file).stem().string();
    rows.push_back({mesh, "moved", bench.measure(FileEdit::move, rounds)});
    rows.push_back({mesh, "re-meshed", bench.measure(FileEdit::remesh, rounds)});
  }
  print_rows(rows);
  return 0;
}

}  // namespace
}  // namespace ramcdb::benchmark

int main(int argc, char** argv) { return ramcdb::benchmark::run_guarded(ramcdb::benchmark::run, argc, argv); }
