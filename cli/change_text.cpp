#include "cli/change_text.h"

#include "cli/chart_list.h"
#include "cli/name_text.h"
#include "cli/table.h"
#include "cli/text.h"

namespace ramcdb::cli {
namespace {

std::string edit_text(const ChangeReport& report) {
  std::string text = "charts touched    " + grouped(report.charts_touched.size()) + " (" +
                     chart_list(report.charts_touched) + ")\nvertices moved    " + grouped(report.vertices_moved) +
                     ", " + grouped(report.border_vertices_moved) +
                     " of them on the region's border (charts outside follow)\n";
  if (report.vertices_added > 0) text += "vertices added    " + grouped(report.vertices_added) + "\n";
  if (report.vertices_removed > 0) text += "vertices removed  " + grouped(report.vertices_removed) + "\n";
  if (report.values_changed > 0) text += "values changed    " + grouped(report.values_changed) + " (attributes)\n";
  return text + "displacement      largest " + model_units(report.max_displacement) + ", rms " +
         model_units(report.rms_displacement) + " (model units)\n";
}

std::string others_text(const ChangeReport& report) {
  if (report.changed_by_others.empty()) return "";
  std::string text = "changed by others since " + version_text(report.base) + ": charts " +
                     chart_list(report.changed_by_others) + "\n";
  if (!report.conflicts.empty())
    text += "conflicts: charts " + chart_list(report.conflicts) + ", which this edit touches too; commit will refuse\n";
  return text;
}

}  // namespace

std::string change_text(const ChangeReport& report, const std::string& file) {
  std::string text = file + ": from " + version_text(report.base);
  if (report.tip != report.base) text += ", the tip is " + version_text(report.tip);
  text += report.clean() ? "\nnothing changed\n" : "\n" + edit_text(report);
  text += others_text(report);
  return report.locks.empty() ? text : text + "locks on its charts\n" + locks_text(report.locks);
}

std::string per_chart_text(const std::vector<ChangeReport::ChartChange>& changes) {
  if (changes.empty()) return "";
  Table table({{"chart"}, {"vertices moved"}, {"largest move"}, {"values changed"}});
  for (const auto& change : changes)
    table.add({std::to_string(change.chart.value), grouped(change.vertices_moved), model_units(change.max_displacement),
               grouped(change.values_changed)});
  return table.text();
}

}  // namespace ramcdb::cli
