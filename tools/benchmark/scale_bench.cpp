// ramcdb-bench-scale --ramcdb PROGRAM --generate PROGRAM [--shape SHAPE] [--memory M] [--bits N] FACES...
//
// What a mesh costs as it grows: for each size a mesh is generated in shuffled order and imported, then it is exported,
// single charts are checked out, moved and committed, history is listed and two versions are compared, each by a
// process of its own. Markdown on standard output; the last row has the exponents b of cost ~ faces^b between the first
// and the last size.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/benchmark/file_edits.h"
#include "tools/benchmark/program.h"
#include "tools/benchmark/scratch_folder.h"
#include "tools/benchmark/timing.h"

namespace ramcdb::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRounds = 5;

struct Programs {
  std::string ramcdb, generate, shape = "planet", memory = "1G", bits = "16";
};

struct Figure {
  const char* title;
  double value;
  int digits;
};

double bytes_in(const fs::path& folder) {
  double bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return bytes;
}

class SizeBench {
 public:
  SizeBench(const Programs& programs, const fs::path& folder, std::uint64_t faces)
      : programs_(programs),
        repository_(folder / "repository"),
        mesh_(folder / "mesh.ply"),
        chart_(folder / "chart.ply") {
    (void)run_program({programs.generate, "--shuffle", programs.shape, std::to_string(faces), mesh_});
    (void)command("init", {});
  }

  /// All figures, in an order that does not depend on the mesh.
  [[nodiscard]] std::vector<Figure> run() {
    import_and_export();
    edit_charts();
    add("log, CPU ms", 1e3 * command("log", {"--json"}).cpu_seconds, 1);
    add("diff, CPU ms", 1e3 * command("diff", {"HEAD~1", "HEAD", "--json"}).cpu_seconds, 1);
    return figures_;
  }

 private:
  /// Runs ramcdb on the repository.
  ProgramUse command(const std::string& verb, const std::vector<std::string>& more) {
    std::vector<std::string> words{programs_.ramcdb, verb, repository_};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }
  void add(const char* title, double value, int digits) { figures_.push_back({title, value, digits}); }

  void import_and_export() {
    const ProgramUse in = command("import", {mesh_, "--memory", programs_.memory, "--bits", programs_.bits, "--json"});
    add("import, s", in.seconds, 1);
    add("CPU s", in.cpu_seconds, 1);
    add("peak MB", 1e-6 * static_cast<double>(in.peak_anonymous), 0);
    add("store, MB", 1e-6 * bytes_in(repository_), 2);
    const ProgramUse out = command("export", {"-o", mesh_, "--force", "--json"});
    add("export, s", out.seconds, 1);
    add("peak MB", 1e-6 * static_cast<double>(out.peak_anonymous), 0);
  }

  void edit_charts() {
    const auto info = nlohmann::json::parse(command("info", {"--json"}).output);
    const auto charts = info.at("charts").get<std::size_t>();
    std::vector<double> out_seconds, out_cpu, blobs, bytes, in_seconds, in_cpu;
    for (std::size_t round = 0; round < kRounds; ++round) {
      const std::size_t chart = 1 + (2 * round + 1) * charts / (2 * kRounds);
      const ProgramUse out =
          command("checkout", {"--charts", std::to_string(chart), "-o", chart_, "--force", "--json"});
      const auto report = nlohmann::json::parse(out.output);
      out_seconds.push_back(1e3 * out.seconds);
      out_cpu.push_back(1e3 * out.cpu_seconds);
      blobs.push_back(report.at("blobs_read").get<double>());
      bytes.push_back(report.at("bytes_read").get<double>());
      edit_file(chart_, FileEdit::move);
      const ProgramUse in = run_program({programs_.ramcdb, "commit", chart_, "-m", "benchmark", "--json"});
      in_seconds.push_back(1e3 * in.seconds);
      in_cpu.push_back(1e3 * in.cpu_seconds);
    }
    add("checkout, ms", median(out_seconds), 1);
    add("CPU ms", median(out_cpu), 1);
    add("blobs", median(blobs), 0);
    add("bytes", median(bytes), 0);
    add("commit, ms", median(in_seconds), 1);
    add("CPU ms", median(in_cpu), 1);
  }

  const Programs& programs_;
  fs::path repository_, mesh_, chart_;
  std::vector<Figure> figures_;
};

void print_head(const std::vector<Figure>& figures) {
  fmt::print("| faces |");
  for (const Figure& figure : figures) fmt::print(" {} |", figure.title);
  fmt::print("\n|---:|");
  for (std::size_t i = 0; i < figures.size(); ++i) fmt::print("---:|");
  fmt::print("\n");
}

void print_row(const std::string& name, const std::vector<Figure>& figures) {
  fmt::print("| {} |", name);
  for (const Figure& figure : figures) fmt::print(" {:.{}f} |", figure.value, figure.digits);
  fmt::print("\n");
  std::fflush(stdout);
}

/// \param times how many times as many faces the last one has
std::vector<Figure> exponents(const std::vector<Figure>& first, const std::vector<Figure>& last, double times) {
  std::vector<Figure> growth = first;
  for (std::size_t i = 0; i < first.size(); ++i)
    growth[i] = {first[i].title, std::log(last[i].value / first[i].value) / std::log(times), 2};
  return growth;
}

int run(int argc, char** argv) {
  CLI::App app("What a mesh costs as it grows");
  Programs programs;
  std::vector<std::uint64_t> sizes;
  app.add_option("--ramcdb", programs.ramcdb, "The ramcdb command")->required()->check(CLI::ExistingFile);
  app.add_option("--generate", programs.generate, "The generator")->required()->check(CLI::ExistingFile);
  app.add_option("--shape", programs.shape, "A shape that it streams (default: planet)");
  app.add_option("--memory", programs.memory, "Of the import (default: 1G)");
  app.add_option("--bits", programs.bits, "Lattice bits along the largest extent (default: 16)");
  app.add_option("FACES", sizes, "Sizes, ascending")->required()->check(CLI::Range(20'000ULL, 10'000'000'000ULL));
  CLI11_PARSE(app, argc, argv);
  std::vector<std::vector<Figure>> rows;
  for (const std::uint64_t faces : sizes) {
    const ScratchFolder scratch;
    rows.push_back(SizeBench(programs, scratch.path(), faces).run());
    if (rows.size() == 1) print_head(rows.front());
    print_row(std::to_string(faces), rows.back());
  }
  if (rows.size() > 1)
    print_row("exponent", exponents(rows.front(), rows.back(),
                                    static_cast<double>(sizes.back()) / static_cast<double>(sizes.front())));
  return 0;
}

}  // namespace
}  // namespace ramcdb::benchmark

int main(int argc, char** argv) { return ramcdb::benchmark::run_guarded(ramcdb::benchmark::run, argc, argv); }
