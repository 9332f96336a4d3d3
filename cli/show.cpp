#include <CLI/CLI.hpp>
#include <memory>

#include "cli/chart_list.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/name_text.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct ShowOptions {
  std::string folder, revision;
  OutputMode mode;
};

std::string parents_text(const std::vector<VersionId>& parents) {
  if (parents.empty()) return "none";
  std::string text;
  for (const VersionId parent : parents) text += (text.empty() ? "" : ", ") + version_text(parent);
  return text;
}

/// A message may have several lines: all but line ends are made harmless, and every line is set in.
std::string message_text(const std::string& message) {
  std::string text;
  for (std::size_t begin = 0; begin <= message.size();) {
    const std::size_t end = std::min(message.find('\n', begin), message.size());
    text += "    " + one_line(message.substr(begin, end - begin)) + "\n";
    begin = end + 1;
  }
  return text;
}

std::string changes_text(const VersionRecord& version) {
  std::string text;
  for (const auto& change : version.changes)
    text += one_line(change.mesh) + ": wrote " + counted(change.charts.size(), "chart") + " (" +
            chart_list(change.charts) + ")\n";
  return text;
}

std::string names_text(const std::vector<RefName>& refs) {
  const std::string text = ref_text(refs);
  return text.empty() ? "" : "\nnames      " + text.substr(2, text.size() - 3);
}

std::string version_report(const VersionRecord& version) {
  return version_text(version.id) + " (" + one_line(version.operation) + " on " + one_line(version.branch) +
         ")\nparents    " + parents_text(version.parents) + names_text(version.refs) + "\nauthor     " +
         one_line(version.author) + "\ntime       " + iso_time(version.time_us, true) + "\n\n" +
         message_text(version.message) + "\n" + changes_text(version) + "charts touched    " +
         grouped(version.charts_touched) + "\nvertices moved    " + grouped(version.vertices_moved) +
         "\nvertices added    " + grouped(version.vertices_added) + "\nvertices removed  " +
         grouped(version.vertices_removed) + "\nlargest move      " + model_units(version.max_displacement) +
         " (model units)\nbytes written     " + grouped(version.bytes_written) + "\n";
}

int run_show(const ShowOptions& options) {
  const VersionRecord version = Repository::open(options.folder).show(options.revision);
  say(options.mode.json ? show_json(version) : version_report(version));
  return kDone;
}

}  // namespace

void setup_show(CLI::App& app, Run& run) {
  const auto options = std::make_shared<ShowOptions>();
  CLI::App& verb = *app.add_subcommand("show", "Show what one version touched and by how much");
  add_repository(verb, options->folder);
  verb.add_option("REV", options->revision, "The version: 17, v17, a branch, HEAD, each with ~N")
      ->type_name("")
      ->required();
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb show statues.ramcdb HEAD~1");
  verb.callback([options, &run] { run = [options] { return run_show(*options); }; });
}

}  // namespace ramcdb::cli
