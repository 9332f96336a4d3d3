#include <CLI/CLI.hpp>
#include <memory>

#include "cli/change_text.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct StatusOptions {
  std::string file;
  OutputMode mode;
};

int run_status(const StatusOptions& options) {
  const ChangeReport report = open_for_file(options.file).status_file(options.file);
  say(options.mode.json ? status_json(report) : change_text(report, options.file));
  return kDone;
}

}  // namespace

void setup_status(CLI::App& app, Run& run) {
  const auto options = std::make_shared<StatusOptions>();
  CLI::App& verb = *app.add_subcommand("status", "Show what a checked-out file would change");
  add_checked_out_file(verb, options->file);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb status horn.ply");
  verb.callback([options, &run] { run = [options] { return run_status(*options); }; });
}

}  // namespace ramcdb::cli
