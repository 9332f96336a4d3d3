#include <CLI/CLI.hpp>
#include <memory>

#include "cli/built_in_edit.h"
#include "cli/progress_bar.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/built_in_edits.h"

namespace ramcdb::cli {
namespace {

struct DecimateCommand {
  BuiltInEdit edit;
  DecimateOptions options;
};

std::string decimated_text(const CommitReport& report) {
  if (report.nothing_changed) return "no face could go: no version written\n";
  return version_text(report.revision) + " after " + version_text(report.parent) + ": " +
         counted(report.faces_removed - report.faces_added, "face") + " and " +
         counted(report.vertices_removed, "vertex", "vertices") + " less in " +
         counted(report.charts_touched, "chart") + ", " + counted(report.charts_removed, "chart") +
         " merged with others\nre-encoded " + counted(report.charts_reencoded, "chart") + " and " +
         counted(report.wires_reencoded, "wire") + ", wrote " + counted(report.bytes_written, "byte") + " in " +
         duration(report.seconds) + "\n";
}

int run_decimate(DecimateCommand& command) {
  const Region region = region_of(command.edit.region, "decimate");
  Repository repository = Repository::open(command.edit.folder);
  command.options.commit = command.edit.commit;
  CommitReport report;
  {
    ProgressBar bar("decimate", command.edit.mode.quiet);
    command.options.commit.progress = bar.callback();
    report = repository.decimate(command.edit.which.mesh, region, command.options);
  }
  return finish_built_in_edit(report, command.edit.mode, "decimate", decimated_text);
}

}  // namespace

void setup_decimate(CLI::App& app, Run& run) {
  const auto command = std::make_shared<DecimateCommand>();
  CLI::App& verb = *app.add_subcommand(
      "decimate",
      "Take faces out of a region and commit; what charts share stays, as does the mesh's border. Polygons whose "
      "triangles change become triangles. Holds the region in memory");
  CLI::Option* ratio =
      verb.add_option("--ratio", command->options.ratio, "The share of faces that is to stay (default: 0.5)");
  ratio->type_name("X")->check(CLI::Range(0.0, 1.0));
  verb.add_option("--faces", command->options.faces, "Instead: how many of the region's faces are to stay")
      ->type_name("N")
      ->excludes(ratio);
  add_region_edit(verb, command->edit);
  add_example(verb, "ramcdb decimate statues.ramcdb --box -1,0,-1,1,0.2,1 --ratio 0.3 -m \"a coarser base\"");
  verb.callback([command, &run] { run = [command] { return run_decimate(*command); }; });
}

}  // namespace ramcdb::cli
