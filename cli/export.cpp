#include <CLI/CLI.hpp>
#include <memory>

#include "cli/attribute_text.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/output_file_options.h"
#include "cli/progress_bar.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct ExportOptions {
  std::string folder;
  MeshAt which;
  OutputFileOptions output;
  unsigned threads = 1;
  std::uint64_t memory = 0;
  OutputMode mode;
};

std::string export_text(const CheckoutReport& report, const std::string& file) {
  return file + ": " + version_text(report.revision) + ", " + counted(report.vertices, "vertex", "vertices") + ", " +
         counted(report.faces, "face") + "; read " + counted(report.bytes_read, "byte") + " in " +
         duration(report.seconds) + "\n" + left_out_text(report.left_out);
}

CheckoutReport export_mesh(const ExportOptions& options) {
  const Repository repository = Repository::open(options.folder);
  FileOptions file = file_options_of(options.output);
  file.threads = options.threads;
  file.memory = options.memory;
  ProgressBar bar("export", options.mode.quiet);
  file.progress = bar.callback();
  return repository.export_mesh(repository.snapshot(options.which.mesh, options.which.at), options.output.file, file);
}

int run_export(const ExportOptions& options) {
  const CheckoutReport report = export_mesh(options);
  if (options.mode.json)
    say(checkout_json(report));
  else if (!options.mode.quiet)
    say(export_text(report, options.output.file));
  return kDone;
}

}  // namespace

void setup_export(CLI::App& app, Run& run) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App& verb = *app.add_subcommand("export", "Write a whole mesh at a version, without a way back");
  add_repository(verb, options->folder);
  add_output_file(verb, options->output);
  add_mesh(verb, options->which);
  add_at(verb, options->which);
  add_threads(verb, options->threads);
  add_memory(verb, options->memory);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb export statues.ramcdb --at v3 --color chart -o dragon.ply");
  verb.callback([options, &run] { run = [options] { return run_export(*options); }; });
}

}  // namespace ramcdb::cli
