#include "cli/change_text.h"

#include <fmt/format.h>

#include "cli/chart_list.h"
#include "cli/name_text.h"
#include "cli/table.h"
#include "cli/text.h"

namespace ramcdb::cli {
namespace {

std::string charts_text(const std::vector<ChartChange>& changes) {
  std::string text;
  for (const ChangeClass wanted :
       {ChangeClass::remeshed, ChangeClass::moved, ChangeClass::attributes, ChangeClass::untouched}) {
    std::vector<ChartId> charts;
    for (const ChartChange& change : changes)
      if (change.change_class() == wanted) charts.push_back(change.chart);
    if (charts.empty()) continue;
    std::string title = class_text(wanted);
    title.resize(16, ' ');
    text += "  " + title + grouped(charts.size()) + " (" + chart_list(charts) + ")\n";
  }
  return text;
}

std::string with_sign(double change) { return (change > 0 ? "+" : "") + model_units(change); }

std::string volume_text(const ChangeFigures& figures) {
  return figures.volume_change ? with_sign(*figures.volume_change) : "-";
}

std::string border_text(const ChangeReport& report) {
  if (!report.border_vertices_moved) return "";
  return "  on the border   " + grouped(report.border_vertices_moved) +
         " of those that moved; the charts outside follow\n";
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

const char* class_text(ChangeClass change_class) {
  switch (change_class) {
    case ChangeClass::remeshed:
      return "re-meshed";
    case ChangeClass::moved:
      return "moved";
    case ChangeClass::attributes:
      return "attributes";
    case ChangeClass::untouched:
      break;
  }
  return "re-cut only";
}

std::string figures_text(const ChangeFigures& figures, const std::vector<ChartChange>& charts) {
  if (figures.clean() && charts.empty()) return "";
  std::string text = "charts touched    " + grouped(charts.size()) + "\n" + charts_text(charts);
  const auto line = [&](const char* title, std::uint64_t count) {
    if (count) text += title + grouped(count) + "\n";
  };
  line("vertices moved    ", figures.vertices_moved);
  line("vertices added    ", figures.vertices_added);
  line("vertices removed  ", figures.vertices_removed);
  line("faces added       ", figures.faces_added);
  line("faces removed     ", figures.faces_removed);
  line("values changed    ", figures.values_changed);
  if (figures.vertices_moved)
    text += "displacement      largest " + model_units(figures.max_displacement) + ", rms " +
            model_units(figures.rms_displacement) + " (model units)\n";
  if (!figures.vertices_moved && !figures.came_or_went()) return text;
  text += "area              " + model_units(figures.area_before) + " -> " + model_units(figures.area_after) + " (" +
          with_sign(figures.area_after - figures.area_before) + ")\n";
  return text + "volume            " +
         (figures.volume_change ? with_sign(*figures.volume_change)
                                : std::string("not comparable, for an open border changed")) +
         "\n";
}

std::string notes_text(const FileNotes& notes) {
  std::string text;
  if (!notes.frame.empty()) text += "undone            " + notes.frame + "\n";
  if (notes.snapped_back)
    text += "snapped back      " + counted(notes.snapped_back, "border vertex", "border vertices") +
            " that only rounding had moved\n";
  if (notes.values_interpolated)
    text += "interpolated      " + counted(notes.values_interpolated, "value") +
            " of what is new, from the surface that was there\n";
  if (notes.attributes_missing)
    text += "not in the file   " + counted(notes.attributes_missing, "attribute") + ", kept as before\n";
  if (!notes.not_taken.empty())
    text += fmt::format("not taken         {}: the mesh has no such attributes\n", fmt::join(notes.not_taken, ", "));
  return text;
}

std::string change_text(const ChangeReport& report, const std::string& file) {
  std::string text = file + ": from " + version_text(report.base);
  if (report.tip != report.base) text += ", the tip is " + version_text(report.tip);
  text += report.clean() ? "\nnothing changed\n" : "\n" + figures_text(report, report.per_chart) + border_text(report);
  text += notes_text(report.notes);
  text += others_text(report);
  return report.locks.empty() ? text : text + "locks on its charts\n" + locks_text(report.locks);
}

std::string per_chart_text(const std::vector<ChartChange>& changes) {
  Table table({{"chart"},
               {"class", Table::Align::left},
               {"moved"},
               {"added"},
               {"removed"},
               {"faces added"},
               {"faces removed"},
               {"values"},
               {"largest move"},
               {"rms"},
               {"area"},
               {"volume"}});
  bool any = false;
  for (const ChartChange& change : changes) {
    if (change.clean()) continue;
    any = true;
    table.add({std::to_string(change.chart.value), class_text(change.change_class()), grouped(change.vertices_moved),
               grouped(change.vertices_added), grouped(change.vertices_removed), grouped(change.faces_added),
               grouped(change.faces_removed), grouped(change.values_changed), model_units(change.max_displacement),
               model_units(change.rms_displacement), with_sign(change.area_after - change.area_before),
               volume_text(change)});
  }
  return any ? table.text() : "";
}

std::string heatmap_text(const std::string& file, const ChangeFigures& figures) {
  return "wrote " + file + ": dark blue where nothing moved to yellow for " + model_units(figures.max_displacement) +
         " (model units); added faces are magenta\n";
}

}  // namespace ramcdb::cli
