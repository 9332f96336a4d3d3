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

struct DiffOptions {
  std::string target;    ///< a checked-out file, or a repository when revisions follow
  std::string from, to;  ///< both or neither
  MeshAt which;
  unsigned threads = 1;
  OutputMode mode;
};

std::string chart_line(const char* title, const std::vector<ChartId>& charts) {
  if (charts.empty()) return "";
  return title + grouped(charts.size()) + " (" + chart_list(charts) + ")\n";
}

std::string versions_text(const DiffReport& report) {
  const std::string charts = chart_line("charts changed  ", report.changed) +
                             chart_line("charts added    ", report.added) +
                             chart_line("charts removed  ", report.removed);
  std::string text = version_text(report.from) + " to " + version_text(report.to) + "\n";
  if (charts.empty()) return text + "no difference\n";
  return text + charts + "vertices moved  " + grouped(report.vertices_moved) + "\ndisplacement    largest " +
         model_units(report.max_displacement) + ", rms " + model_units(report.rms_displacement) + " (model units)\n" +
         per_chart_text(report.per_chart);
}

int diff_file(const DiffOptions& options) {
  const ChangeReport report = open_for_file(options.target).status_file(options.target);
  say(options.mode.json ? diff_json(report) : change_text(report, options.target) + per_chart_text(report.per_chart));
  return kDone;
}

int diff_versions(const DiffOptions& options) {
  const Repository repository = Repository::open(options.target);
  const Snapshot from = repository.snapshot(options.which.mesh, options.from);
  const Snapshot to = repository.snapshot(options.which.mesh, options.to);
  const DiffReport report = repository.diff(from, to, options.threads);
  say(options.mode.json ? diff_json(report) : versions_text(report));
  return kDone;
}

int run_diff(const DiffOptions& options) {
  if (options.from.empty() && !options.which.mesh.empty())
    throw UsageError(usage_text("--mesh goes with two versions, not with a file", "diff"));
  return options.from.empty() ? diff_file(options) : diff_versions(options);
}

}  // namespace

void setup_diff(CLI::App& app, Run& run) {
  const auto options = std::make_shared<DiffOptions>();
  CLI::App& verb =
      *app.add_subcommand("diff", "Show what differs, chart by chart: a file from its base, or two versions");
  verb.add_option("FILE|REPO", options->target, "A checked-out file, or a repository followed by two versions")
      ->required();
  CLI::Option* from = verb.add_option("REV1", options->from, "The older version")->type_name("");
  CLI::Option* to = verb.add_option("REV2", options->to, "The newer version")->type_name("");
  from->needs(to);
  to->needs(from);
  add_mesh(verb, options->which);
  add_threads(verb, options->threads);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb diff horn.ply\n  ramcdb diff statues.ramcdb HEAD~1 HEAD --mesh dragon");
  verb.callback([options, &run] { run = [options] { return run_diff(*options); }; });
}

}  // namespace ramcdb::cli
