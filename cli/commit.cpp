#include <CLI/CLI.hpp>
#include <memory>

#include "cli/change_text.h"
#include "cli/chart_list.h"
#include "cli/conflict_text.h"
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

struct CommitCommand {
  std::string file;
  CommitOptions options;
  OutputMode mode;
};

/// ", 3 faces added" for each of what there is any.
std::string edit_text(const CommitReport& report) {
  std::string text = counted(report.vertices_moved, "vertex", "vertices") + " moved";
  if (report.vertices_moved) text += " by at most " + model_units(report.max_displacement) + " (model units)";
  const auto add = [&](std::uint64_t count, const char* one, const char* several, const char* done) {
    if (count) text += ", " + counted(count, one, several) + done;
  };
  add(report.vertices_added, "vertex", "vertices", " added");
  add(report.vertices_removed, "vertex", "vertices", " removed");
  add(report.faces_added, "face", "faces", " added");
  add(report.faces_removed, "face", "faces", " removed");
  add(report.values_changed, "value", "values", " of attributes changed");
  return text + ", in " + counted(report.charts_touched, "chart");
}

std::string charts_text(const char* title, const std::vector<ChartId>& charts) {
  return charts.empty() ? "" : title + grouped(charts.size()) + " (" + chart_list(charts) + ")\n";
}

std::string report_text(const CommitReport& report) {
  if (report.nothing_changed) return "nothing changed: no version written\n" + notes_text(report.notes);
  return version_text(report.revision) + " after " + version_text(report.parent) + ": " + edit_text(report) + "\n" +
         charts_text("charts added      ", report.added) + charts_text("charts removed    ", report.removed) +
         notes_text(report.notes) + "re-encoded " + counted(report.charts_reencoded, "chart") +
         (report.layers_reencoded ? ", " + counted(report.layers_reencoded, "attribute blob") : "") + " and " +
         counted(report.wires_reencoded, "wire") + ", wrote " + counted(report.bytes_written, "byte") + " in " +
         duration(report.seconds) + "\n";
}

CommitReport commit(const CommitCommand& command) {
  Repository repository = open_for_file(command.file);
  ProgressBar bar("commit", command.mode.quiet);
  CommitOptions options = command.options;
  options.progress = bar.callback();
  return repository.commit_file(command.file, options);
}

int refuse(const CommitReport& report, const std::string& file) {
  const std::string charts =
      std::string(report.conflicts.size() == 1 ? "chart " : "charts ") + chart_list(report.conflicts);
  if (report.conflict_places.empty())
    complain("others changed " + charts + " since, nothing was written (" + file +
             "): merge with --merge, or save the work on a branch of its own with --onto BRANCH");
  else
    complain("others changed " + charts + " since, in other ways, nothing was written (" + file +
             "): " + conflict_text(report.conflict_places) + "save the work on a branch of its own with --onto BRANCH");
  return kConflict;
}

int run_commit(const CommitCommand& command) {
  const CommitReport report = commit(command);
  const bool conflict = !report.conflicts.empty();
  if (command.mode.json)
    say(commit_json(report));
  else if (!command.mode.quiet && !conflict)
    say(report_text(report));
  return conflict ? refuse(report, command.file) : kDone;
}

}  // namespace

void setup_commit(CLI::App& app, Run& run) {
  const auto command = std::make_shared<CommitCommand>();
  CLI::App& verb = *app.add_subcommand("commit", "Publish an edited file as a new version");
  add_checked_out_file(verb, command->file);
  add_message(verb, command->options.message, true);
  add_author(verb, command->options.author);
  verb.add_option("--branch", command->options.branch, "The branch to commit to (default: main)")->type_name("NAME");
  verb.add_flag("--merge", command->options.merge,
                "Where others changed the same charts, merge vertex by vertex and value by value");
  verb.add_option("--onto", command->options.onto,
                  "The branch to commit to instead; a new one begins at the version that the file was checked out from")
      ->type_name("BRANCH");
  verb.add_flag("--ignore-locks", command->options.ignore_locks, "Also change charts that others have locked");
  add_threads(verb, command->options.threads);
  add_output_mode(verb, command->mode);
  add_example(verb, "ramcdb commit horn.ply -m \"straighten the left horn\"");
  verb.callback([command, &run] { run = [command] { return run_commit(*command); }; });
}

}  // namespace ramcdb::cli
