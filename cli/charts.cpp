#include <CLI/CLI.hpp>
#include <memory>

#include "cli/chart_list.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/region_options.h"
#include "cli/table.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct ChartsOptions {
  std::string folder;
  MeshAt which;
  RegionOptions region;
  OutputMode mode;
};

std::string charts_text(const std::vector<ChartSummary>& charts) {
  Table table({{"chart"},
               {"faces"},
               {"vertices"},
               {"border"},
               {"bytes"},
               {"changed"},
               {"box (x0,y0,z0,x1,y1,z1)", Table::Align::left},
               {"neighbours", Table::Align::left}});
  for (const ChartSummary& chart : charts)
    table.add({std::to_string(chart.id.value), grouped(chart.faces),
               grouped(chart.inner_vertices + chart.border_vertices), grouped(chart.border_vertices),
               grouped(chart.bytes), version_text(chart.version), point_text(chart.lo) + "," + point_text(chart.hi),
               chart_list(chart.neighbours)});
  return table.text();
}

int run_charts(const ChartsOptions& options) {
  const Region region = region_of(options.region, "charts");
  const Repository repository = Repository::open(options.folder);
  const Snapshot snapshot = repository.snapshot(options.which.mesh, options.which.at);
  const std::vector<ChartSummary> charts = snapshot.describe(snapshot.find(region));
  say(options.mode.json ? charts_json(charts, snapshot.version()) : charts_text(charts));
  return kDone;
}

}  // namespace

void setup_charts(CLI::App& app, Run& run) {
  const auto options = std::make_shared<ChartsOptions>();
  CLI::App& verb = *app.add_subcommand("charts", "List the charts of a region");
  add_repository(verb, options->folder);
  add_region(verb, options->region);
  add_mesh(verb, options->which);
  add_at(verb, options->which);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb charts statues.ramcdb --box -1,-1,0,1,1,2.5");
  verb.callback([options, &run] { run = [options] { return run_charts(*options); }; });
}

}  // namespace ramcdb::cli
