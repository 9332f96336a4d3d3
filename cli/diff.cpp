#include <CLI/CLI.hpp>
#include <memory>

#include "cli/change_text.h"
#include "cli/chart_list.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct DiffCommand {
  std::string target;    ///< a checked-out file, or a repository when revisions follow
  std::string from, to;  ///< both or neither
  MeshAt which;
  std::string heatmap;
  bool all = false;
  unsigned threads = 1;
  OutputMode mode;
};

std::string chart_line(const char* title, const std::vector<ChartId>& charts) {
  if (charts.empty()) return "";
  return title + grouped(charts.size()) + " (" + chart_list(charts) + ")\n";
}

std::string versions_text(const DiffReport& report) {
  const std::string text = version_text(report.from) + " to " + version_text(report.to) + "\n";
  if (report.per_chart.empty()) return text + "no difference\n";
  return text + chart_line("charts changed    ", report.changed) + chart_line("charts added      ", report.added) +
         chart_line("charts removed    ", report.removed) + figures_text(report, report.per_chart) +
         per_chart_text(report.per_chart);
}

template <class Report>
int tell(const DiffCommand& command, const Report& report, const std::string& text) {
  if (command.mode.json)
    say(diff_json(report));
  else
    say(command.heatmap.empty() ? text : text + heatmap_text(command.heatmap, report));
  return kDone;
}

int diff_file(const DiffCommand& command) {
  const ChangeReport report = open_for_file(command.target).status_file(command.target, command.heatmap);
  return tell(command, report, change_text(report, command.target) + per_chart_text(report.per_chart));
}

int diff_versions(const DiffCommand& command) {
  const Repository repository = Repository::open(command.target);
  const Snapshot from = repository.snapshot(command.which.mesh, command.from);
  const Snapshot to = repository.snapshot(command.which.mesh, command.to);
  DiffOptions options;
  options.threads = command.threads;
  options.heatmap = command.heatmap;
  options.heatmap_of_all = command.all;
  const DiffReport report = repository.diff(from, to, options);
  return tell(command, report, versions_text(report));
}

int run_diff(const DiffCommand& command) {
  if (command.from.empty() && !command.which.mesh.empty())
    throw UsageError(usage_text("--mesh goes with two versions, not with a file", "diff"));
  if (command.all && (command.from.empty() || command.heatmap.empty()))
    throw UsageError(usage_text("--all goes with two versions and --heatmap", "diff"));
  return command.from.empty() ? diff_file(command) : diff_versions(command);
}

}  // namespace

void setup_diff(CLI::App& app, Run& run) {
  const auto command = std::make_shared<DiffCommand>();
  CLI::App& verb =
      *app.add_subcommand("diff", "Show what differs, chart by chart: a file from its base, or two versions");
  verb.add_option("FILE|REPO", command->target, "A checked-out file, or a repository followed by two versions")
      ->required();
  CLI::Option* from = verb.add_option("REV1", command->from, "The older version")->type_name("");
  CLI::Option* to = verb.add_option("REV2", command->to, "The newer version")->type_name("");
  from->needs(to);
  to->needs(from);
  add_mesh(verb, command->which);
  verb.add_option("--heatmap", command->heatmap,
                  "Write a .ply or .glb to look at: the file's region, or the charts that differ, "
                  "coloured by how far vertices were moved; added faces in magenta")
      ->type_name("FILE");
  verb.add_flag("--all", command->all, "The heat map shows the whole mesh");
  add_threads(verb, command->threads);
  add_output_mode(verb, command->mode);
  add_example(verb, "ramcdb diff horn.ply\n  ramcdb diff statues.ramcdb HEAD~1 HEAD --mesh dragon --heatmap moved.ply");
  verb.callback([command, &run] { run = [command] { return run_diff(*command); }; });
}

}  // namespace ramcdb::cli
