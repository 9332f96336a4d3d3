#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>

#include "cli/attribute_text.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/progress_bar.h"
#include "cli/size_table.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct ImportCommand {
  std::string folder, file;
  std::string lattice_of;  ///< a mesh of the repository, or empty
  std::string into;        ///< likewise
  std::string chartify = "refined";
  std::string profile = "dense";
  ImportOptions options;
  std::uint64_t memory = 0;
  OutputMode mode;
};

std::string refuse_bad_precision(const std::string& text) {
  double value = 0;
  const bool number = CLI::detail::lexical_cast(text, value);
  return number && std::isfinite(value) && value > 0 ? "" : "'" + text + "' is not a length above 0";
}

std::string found_text(const MeshInfo& info) {
  return "found    " + counted(info.components, "component") + ", " + counted(info.boundary_loops, "boundary loop") +
         ", " + counted(info.nonmanifold_edges, "non-manifold edge") + ", " +
         counted(info.nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices") + ",\n         " +
         counted(info.inconsistent_edges, "inconsistently oriented edge") + ", " +
         counted(info.degenerate_faces, "degenerate face") + ", " + counted(info.duplicate_faces, "duplicate face") +
         ", " + counted(info.isolated_vertices, "isolated vertex", "isolated vertices") + " (all kept)\n";
}

std::string changed_text(const ImportReport& report) {
  std::string text;
  if (report.polygons > 0)
    text += "kept     " + counted(report.polygons, "polygon") + ", coded as triangles" +
            (report.polygons_as_fans ? ", " + grouped(report.polygons_as_fans) + " of them as fans" : "") + "\n";
  for (const MeshInfo::Layer& layer : report.info.attributes) text += "kept     " + attribute_text(layer) + "\n";
  for (const std::string& reference : report.info.references)
    text += "kept     reference \"" + one_line(reference) + "\", not the file itself\n";
  if (report.vertices_welded > 0)
    text += "changed  " + counted(report.vertices_welded, "corner") + " at equal positions joined\n";
  for (const auto& dropped : report.dropped)
    text += "dropped  " + one_line(dropped.what) + " (" + grouped(dropped.count) + ")\n";
  return text;
}

std::string error_text(const ImportReport& report) {
  if (report.info.lossless) return "error    none, positions are kept to the last bit\n";
  if (report.measured_error == 0)
    return "error    none, all positions lie on the lattice (step " + model_units(report.info.lattice.step) +
           "); of edits at most " + model_units(report.info.max_error) + " along each axis, in model units\n";
  return "error    at most " + model_units(report.info.max_error) + " along each axis, in model units; measured " +
         model_units(report.measured_error) + " (lattice step " + model_units(report.info.lattice.step) + ")\n";
}

std::string time_text(const ImportReport& report) {
  std::string text = "time     " + duration(report.seconds);
  if (report.seconds > 0)
    text += ", " + grouped(static_cast<std::uint64_t>(static_cast<double>(report.info.faces) / report.seconds)) +
            " faces/s";
  return text + "\n";
}

std::string report_text(const ImportReport& report) {
  const MeshInfo& info = report.info;
  return one_line(info.mesh) + ": " + counted(info.vertices, "vertex", "vertices") + ", " +
         counted(info.faces, "face") + " in " + counted(info.charts, "chart") + ", " +
         (info.revision ? "now version " + version_text(info.revision) : std::string("nothing was written")) + "\n" +
         found_text(info) + changed_text(report) + error_text(report) + time_text(report) + "\n" + size_table(info);
}

double size_of(const std::filesystem::path& file) {
  std::error_code ignored;  // the library says better what is wrong with a file than its size could
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  return ignored ? 0 : static_cast<double>(size);
}

std::string report_text(const ImportIntoReport& report, const std::string& into) {
  const CommitReport& commit = report.commit;
  std::string text = one_line(into) + ": " + counted(report.vertices, "vertex", "vertices") + " and " +
                     counted(report.faces, "face") + " added, " +
                     (commit.revision ? "now version " + version_text(commit.revision) : "nothing was written") + "\n";
  if (report.polygons > 0)
    text += "kept     " + counted(report.polygons, "polygon") + ", coded as triangles" +
            (report.polygons_as_fans ? ", " + grouped(report.polygons_as_fans) + " of them as fans" : "") + "\n";
  if (report.vertices_welded > 0)
    text += "changed  " + counted(report.vertices_welded, "corner") + " at equal positions joined\n";
  if (commit.notes.attributes_missing > 0)
    text += "absent   " + counted(commit.notes.attributes_missing, "attribute") + " of the mesh, in what was added\n";
  for (const auto& dropped : report.dropped)
    text += "dropped  " + one_line(dropped.what) + " (" + grouped(dropped.count) + ")\n";
  text += report.measured_error > 0
              ? "error    " + model_units(report.measured_error) + " along each axis, measured, in model units\n"
              : std::string("error    none, all positions are those of the file\n");
  if (commit.revision)
    text += "stored   " + counted(commit.charts_added, "new chart") + " (" +
            counted(commit.charts_reencoded - commit.charts_added, "other chart") + " coded anew), " +
            counted(commit.bytes_written, "byte") + "\n";
  return text + "time     " + duration(commit.seconds) + "\n";
}

int run_import_into(const ImportCommand& command) {
  ImportIntoOptions options;
  options.weld = command.options.weld;
  options.dry_run = command.options.dry_run;
  options.commit.message = command.options.message;
  options.commit.author = command.options.author;
  options.commit.branch = command.options.branch;
  options.commit.threads = command.options.threads;
  Repository repository = Repository::open(command.folder);
  ImportIntoReport report;
  {
    ProgressBar bar("import", command.mode.quiet, size_of(command.file));
    options.commit.progress = bar.callback();
    report = repository.import_into(command.into, command.file, options);
  }
  if (command.mode.json)
    say(import_into_json(report));
  else if (!command.mode.quiet && report.commit.conflicts.empty())
    say(report_text(report, command.into));
  if (report.commit.conflicts.empty()) return kDone;
  complain("others changed charts meanwhile, nothing was written: repeat the import");
  return kConflict;
}

int run_import(const ImportCommand& command) {
  if (!command.into.empty()) return run_import_into(command);
  Repository repository = Repository::open(command.folder);
  ImportOptions options = command.options;
  if (!command.lattice_of.empty()) options.lattice = repository.snapshot(command.lattice_of).lattice();
  options.paper_chartify = command.chartify == "paper";
  options.profile = command.profile == "fast" ? ChartProfile::fast : ChartProfile::dense;

  ImportReport report;
  {
    ProgressBar bar("import", command.mode.quiet, size_of(command.file));
    options.progress = bar.callback();
    report = repository.import(command.file, options);
  }
  if (command.mode.json)
    say(import_json(report));
  else if (!command.mode.quiet)
    say(report_text(report));
  return kDone;
}

void add_lattice_options(CLI::App& verb, ImportCommand& command) {
  CLI::Option* bits = verb.add_option("--bits", command.options.bits,
                                      "Lattice step = largest extent / (2^N - 1), as Draco's -qp (default: 16)");
  bits->type_name("N")->check(CLI::Range(1U, 30U));
  CLI::Option* precision =
      verb.add_option("--precision", command.options.precision, "Instead: largest coordinate error, in model units");
  precision->type_name("X")->check(CLI::Validator(refuse_bad_precision, ""))->excludes(bits);
  verb.add_flag("--lossless", command.options.lossless,
                "Instead: positions to the last bit, and attributes as with --lossless-attributes")
      ->excludes(bits)
      ->excludes(precision);
  verb.add_option("--lattice-of", command.lattice_of,
                  "Instead: the lattice of this mesh of the repository, so that both fit together exactly")
      ->type_name("MESH")
      ->excludes(bits)
      ->excludes(precision);
}

void add_chart_options(CLI::App& verb, ImportCommand& command) {
  verb.add_option("--chart-faces", command.options.chart_faces, "Faces per chart to aim at (default: 5000)")
      ->type_name("N")
      ->check(CLI::Range(1U, 1U << 30));
  verb.add_option("--chartify", command.chartify, "How charts are cut; `paper` is for comparison (default: refined)")
      ->type_name("refined|paper")
      ->check(CLI::Validator(CLI::IsMember({"refined", "paper"})).description(""));
  verb.add_option("--profile", command.profile, "How charts are coded, smallest or to be read fast (default: dense)")
      ->type_name("dense|fast")
      ->check(CLI::Validator(CLI::IsMember({"dense", "fast"})).description(""));
}

}  // namespace

void setup_import(CLI::App& app, Run& run) {
  const auto command = std::make_shared<ImportCommand>();
  CLI::App& verb = *app.add_subcommand("import", "Add a mesh file to a repository as one version");
  add_repository(verb, command->folder);
  verb.add_option("FILE", command->file, "A mesh file: its extension says the format")->required();
  verb.add_option("--name", command->options.name, "Name of the mesh (default: the file's name without its extension)")
      ->type_name("NAME");
  add_lattice_options(verb, *command);
  add_chart_options(verb, *command);
  add_memory(verb, command->memory, "Memory to work in; a mesh that needs more is cut into charts piece by piece");
  verb.add_flag_callback(
      "--weld", [command] { command->options.weld = true; },
      "Join vertices at equal positions (default for STL, whose triangles have their own)");
  verb.add_flag_callback(
          "--no-weld", [command] { command->options.weld = false; }, "Leave every vertex of an STL apart")
      ->excludes("--weld");
  verb.add_flag("--dry-run", command->options.dry_run, "Report what would be found and stored, and write nothing");
  verb.add_flag("--lossless-attributes", command->options.lossless_attributes,
                "Keep colours, normals and texture coordinates that are floats bit by bit");
  CLI::Option* into = verb.add_option(
      "--into", command->into, "Add it to this mesh as new components, on the mesh's lattice, instead of as a mesh");
  into->type_name("MESH");
  for (const char* other : {"--name", "--bits", "--precision", "--lossless", "--lattice-of", "--chart-faces",
                            "--chartify", "--profile", "--lossless-attributes", "--memory"})
    into->excludes(verb.get_option(other));
  add_message(verb, command->options.message, false);
  verb.add_option("--branch", command->options.branch,
                  "The branch to publish on; one that is not there yet begins from main (default: main)")
      ->type_name("NAME");
  add_author(verb, command->options.author);
  add_threads(verb, command->options.threads);
  add_output_mode(verb, command->mode);
  add_example(verb, "ramcdb import statues.ramcdb dragon.ply --precision 0.001 -m \"the scan of May\"");
  verb.callback([command, &verb, &run] {
    if (verb.count("--memory") > 0) command->options.memory = command->memory;
    run = [command] { return run_import(*command); };
  });
}

}  // namespace ramcdb::cli
