#include "cli/built_in_edit.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "cli/chart_list.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/output.h"
#include "cli/text.h"

namespace ramcdb::cli {
namespace {

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::string moved_text(const CommitReport& report) {
  if (report.nothing_changed) return "no vertex moved by as much as a lattice step: no version written\n";
  std::string text = version_text(report.revision) + " after " + version_text(report.parent) + ": " +
                     counted(report.vertices_moved, "vertex", "vertices") + " moved in " +
                     counted(report.charts_touched, "chart") + ", by at most " + model_units(report.max_displacement) +
                     " (model units)\nre-encoded " + counted(report.charts_reencoded, "chart") + " and " +
                     counted(report.wires_reencoded, "wire") + ", wrote " + counted(report.bytes_written, "byte") +
                     " in " + duration(report.seconds) + "\n";
  for (const std::string& name : report.normals_left)
    text += "the normals in '" + one_line(name) + "' stay as they were: they no longer fit the surface\n";
  return text;
}

void add_region_edit(CLI::App& verb, BuiltInEdit& edit) {
  add_repository(verb, edit.folder);
  add_region(verb, edit.region);
  add_mesh(verb, edit.which);
  add_message(verb, edit.commit.message, true);
  add_author(verb, edit.commit.author);
  verb.add_option("--branch", edit.commit.branch, "The branch to edit and commit to (default: main)")
      ->type_name("NAME");
  add_threads(verb, edit.commit.threads);
  add_output_mode(verb, edit.mode);
}

void add_built_in_edit(CLI::App& verb, BuiltInEdit& edit) {
  add_region_edit(verb, edit);
  add_memory(verb, edit.memory);
}

int finish_built_in_edit(const CommitReport& report, const OutputMode& mode, std::string_view verb,
                         std::string (*text)(const CommitReport&)) {
  const bool conflict = !report.conflicts.empty();
  if (mode.json)
    say(commit_json(report));
  else if (!mode.quiet && !conflict)
    say(text(report));
  if (!conflict) return kDone;
  complain("others changed " + std::string(report.conflicts.size() == 1 ? "chart " : "charts ") +
           chart_list(report.conflicts) + " meanwhile, nothing was written: repeat the " + std::string(verb));
  return kConflict;
}

std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               std::initializer_list<std::size_t> counts, const std::string& form) {
  const std::string wrong = "cannot read " + option + " '" + text + "': write it as " + form;
  std::string commas = text;
  std::replace(commas.begin(), commas.end(), ' ', ',');
  std::vector<double> values;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = commas.find(',', begin);
    const auto value = number_of(std::string_view(commas).substr(begin, end - begin));
    if (!value) throw UsageError(wrong);
    values.push_back(*value);
  }
  if (std::find(counts.begin(), counts.end(), values.size()) == counts.end()) throw UsageError(wrong);
  return values;
}

}  // namespace ramcdb::cli
