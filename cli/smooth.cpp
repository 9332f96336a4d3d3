#include <CLI/CLI.hpp>
#include <memory>

#include "cli/built_in_edit.h"
#include "cli/progress_bar.h"
#include "cli/verbs.h"
#include "ramcdb/built_in_edits.h"

namespace ramcdb::cli {
namespace {

struct SmoothCommand {
  BuiltInEdit edit;
  SmoothOptions options;
};

int run_smooth(SmoothCommand& command) {
  const Region region = region_of(command.edit.region, "smooth");
  Repository repository = Repository::open(command.edit.folder);
  command.options.memory = command.edit.memory;
  command.options.commit = command.edit.commit;
  CommitReport report;
  {
    ProgressBar bar("smooth", command.edit.mode.quiet);
    command.options.commit.progress = bar.callback();
    report = repository.smooth(command.edit.which.mesh, region, command.options);
  }
  return finish_built_in_edit(report, command.edit.mode, "smooth");
}

std::string refuse_bad_lambda(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) && value > 0 && value <= 1 ? "" : "must be above 0, at most 1";
}

}  // namespace

void setup_smooth(CLI::App& app, Run& run) {
  const auto command = std::make_shared<SmoothCommand>();
  CLI::App& verb = *app.add_subcommand(
      "smooth", "Smooth a region of any size and commit; borders of the region and of the mesh stay");
  verb.add_option("--iterations", command->options.iterations, "How often every vertex goes towards its neighbours")
      ->type_name("N")
      ->required()
      ->check(CLI::Range(1U, 1'000'000U));
  verb.add_option("--lambda", command->options.lambda, "How far: 1 is to the mean of its neighbours (default: 0.5)")
      ->type_name("X")
      ->check(CLI::Validator(refuse_bad_lambda, ""));
  add_built_in_edit(verb, command->edit);
  add_example(verb, "ramcdb smooth statues.ramcdb --sphere 0,1.5,0,0.2 --iterations 100 -m \"smooth the face\"");
  verb.callback([command, &run] { run = [command] { return run_smooth(*command); }; });
}

}  // namespace ramcdb::cli
