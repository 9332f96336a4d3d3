#include <CLI/CLI.hpp>
#include <memory>

#include "cli/conflict_text.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct MergeCommand {
  std::string folder, revision;
  CommitOptions options;
  OutputMode mode;
};

std::string report_text(const MergeReport& report, const std::string& branch) {
  if (report.nothing_changed)
    return branch + " holds " + version_text(report.theirs) + " already: no version written\n";
  const std::string head = version_text(report.revision) + " merges " + version_text(report.theirs) + " into " +
                           version_text(report.parent) + ", from " + version_text(report.base) + " on: ";
  if (report.commit.charts_reencoded > 0)
    return head + (report.charts_taken ? counted(report.charts_taken, "chart") + " taken over, " : "") +
           counted(report.commit.charts_reencoded, "chart") + " re-encoded, " +
           counted(report.commit.vertices_moved, "vertex", "vertices") + " moved, " +
           counted(report.commit.faces_added, "face") + " added, " + counted(report.commit.faces_removed, "face") +
           " removed, wrote " + counted(report.commit.bytes_written, "byte") + " in " + duration(report.seconds) + "\n";
  return head + counted(report.charts_taken, "chart") + " taken over, no blob copied, in " + duration(report.seconds) +
         "\n";
}

int run_merge(const MergeCommand& command) {
  const MergeReport report = Repository::open(command.folder).merge(command.revision, command.options);
  const bool conflict = !report.commit.conflicts.empty();
  if (command.mode.json)
    say(merge_json(report));
  else if (!command.mode.quiet && !conflict)
    say(report_text(report, command.options.branch));
  if (!conflict) return kDone;
  complain("both sides changed " + conflicting_charts(report.commit) + " in different ways, nothing was written:" +
           conflict_text(report.commit.conflict_places) + "edit one side there, or revert it, and merge again");
  return kConflict;
}

}  // namespace

void setup_merge(CLI::App& app, Run& run) {
  const auto command = std::make_shared<MergeCommand>();
  CLI::App& verb =
      *app.add_subcommand("merge", "Bring what was done on another branch into a branch, as a new version");
  add_repository(verb, command->folder);
  verb.add_option("REV", command->revision, "The branch, tag or version to merge")->required();
  verb.add_option("--into", command->options.branch, "The branch to commit to (default: main)")->type_name("BRANCH");
  add_message(verb, command->options.message, false);
  add_author(verb, command->options.author);
  verb.add_flag("--ignore-locks", command->options.ignore_locks, "Also change charts that others have locked");
  add_threads(verb, command->options.threads);
  add_output_mode(verb, command->mode);
  add_example(verb, "ramcdb merge statues.ramcdb restoration -m \"the restored nose\"");
  verb.callback([command, &run] { run = [command] { return run_merge(*command); }; });
}

}  // namespace ramcdb::cli
