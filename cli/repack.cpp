#include <CLI/CLI.hpp>
#include <memory>

#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/progress_bar.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct RepackCommand {
  std::string folder, profile;
  MeshAt which;
  RepackOptions options;
  OutputMode mode;
};

std::string report_text(const RepackReport& report) {
  if (report.nothing_changed)
    return "nothing changed: the mesh is " + report.profile + " already and would not get smaller\n";
  return version_text(report.revision) + " after " + version_text(report.parent) + ": " +
         counted(report.charts, "chart") + " now " + report.profile + ", payload " + grouped(report.before.payload) +
         " -> " + grouped(report.after.payload) + " bytes, wrote " + counted(report.bytes_written, "byte") + " in " +
         duration(report.seconds) + "\n";
}

int run_repack(RepackCommand& command) {
  Repository repository = Repository::open(command.folder);
  if (!command.profile.empty())
    command.options.profile = command.profile == "fast" ? ChartProfile::fast : ChartProfile::dense;
  RepackReport report;
  {
    ProgressBar bar("repack", command.mode.quiet);
    command.options.progress = bar.callback();
    report = repository.repack(command.which.mesh, command.options);
  }
  if (command.mode.json)
    say(repack_json(report));
  else if (!command.mode.quiet)
    say(report_text(report));
  return kDone;
}

}  // namespace

void setup_repack(CLI::App& app, Run& run) {
  const auto command = std::make_shared<RepackCommand>();
  CLI::App& verb = *app.add_subcommand("repack", "Code all charts of a mesh anew, as a new version of the same mesh");
  add_repository(verb, command->folder);
  add_mesh(verb, command->which);
  verb.add_option("--profile", command->profile,
                  "How charts are coded, smallest or to be read fast (default: as they are, with statistics anew)")
      ->type_name("dense|fast")
      ->check(CLI::Validator(CLI::IsMember({"dense", "fast"})).description(""));
  add_message(verb, command->options.message, false);
  add_author(verb, command->options.author);
  verb.add_option("--branch", command->options.branch, "The branch to commit to (default: main)")->type_name("NAME");
  verb.add_flag("--ignore-locks", command->options.ignore_locks, "Also where others have locked charts");
  add_threads(verb, command->options.threads);
  add_output_mode(verb, command->mode);
  add_example(verb, "ramcdb repack statues.ramcdb --mesh dragon --profile fast");
  verb.callback([command, &run] { run = [command] { return run_repack(*command); }; });
}

}  // namespace ramcdb::cli
