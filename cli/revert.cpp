#include <CLI/CLI.hpp>
#include <memory>

#include "cli/conflict_text.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/region_options.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct RevertCommand {
  std::string folder, revision;
  MeshAt which;
  RegionOptions region;
  CommitOptions options;
  OutputMode mode;
};

std::string report_text(const CommitReport& report, const std::string& revision, bool in_region) {
  const std::string where = in_region ? " in this region" : "";
  if (report.nothing_changed) return "nothing of it is left to take back" + where + ": no version written\n";
  return version_text(report.revision) + " after " + version_text(report.parent) + ": took " + revision + " back" +
         where + ", " + counted(report.vertices_moved, "vertex", "vertices") + " moved, " +
         counted(report.faces_added, "face") + " added, " + counted(report.faces_removed, "face") + " removed, " +
         counted(report.charts_reencoded, "chart") + " re-encoded, wrote " + counted(report.bytes_written, "byte") +
         " in " + duration(report.seconds) + "\n";
}

int run_revert(const RevertCommand& command) {
  std::optional<Region> within;
  if (!is_empty(command.region)) within = region_of(command.region, "revert");
  const CommitReport report =
      Repository::open(command.folder).revert(command.revision, command.which.mesh, command.options, within);
  const bool conflict = !report.conflicts.empty();
  if (command.mode.json)
    say(commit_json(report));
  else if (!command.mode.quiet && !conflict)
    say(report_text(report, command.revision, within.has_value()));
  if (!conflict) return kDone;
  complain("later versions changed " + conflicting_charts(report) + " in the same places, nothing was written:" +
           conflict_text(report.conflict_places) + "revert these versions first, newest first");
  return kConflict;
}

}  // namespace

void setup_revert(CLI::App& app, Run& run) {
  const auto command = std::make_shared<RevertCommand>();
  CLI::App& verb = *app.add_subcommand("revert", "Take back what one version did, on top of what came later");
  add_repository(verb, command->folder);
  verb.add_option("REV", command->revision, "The version to take back")->required();
  add_mesh(verb, command->which);
  add_message(verb, command->options.message, false);
  add_author(verb, command->options.author);
  verb.add_option("--branch", command->options.branch, "The branch to commit to (default: main)")->type_name("NAME");
  verb.add_flag("--ignore-locks", command->options.ignore_locks, "Also change charts that others have locked");
  add_threads(verb, command->options.threads);
  add_output_mode(verb, command->mode);
  add_region(verb, command->region, RegionUse::parts);
  add_example(
      verb,
      "ramcdb revert statues.ramcdb v7 -m \"the horn was better before\"\n"
      "  ramcdb revert statues.ramcdb v7 --box -1,-1,0,1,1,2.5",
      "With a REGION only what the version changed there: vertices inside go back, and where it replaced faces, each\n"
      "connected patch of them that the region meets goes back whole. What lies outside stays as it is.");
  verb.callback([command, &run] { run = [command] { return run_revert(*command); }; });
}

}  // namespace ramcdb::cli
