#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "cli/built_in_edit.h"
#include "cli/failure.h"
#include "cli/progress_bar.h"
#include "cli/verbs.h"
#include "ramcdb/built_in_edits.h"

namespace ramcdb::cli {
namespace {

struct TransformCommand {
  BuiltInEdit edit;
  std::string matrix, translate, scale, rotate, center;
  TransformOptions options;
};

Point point_of(const std::vector<double>& n) { return {n[0], n[1], n[2]}; }

Matrix matrix_of(const TransformCommand& command) {
  const Point center =
      command.center.empty() ? Point{} : point_of(numbers_of("--center", command.center, {3}, "X,Y,Z"));
  if (!command.translate.empty())
    return translation(point_of(numbers_of("--translate", command.translate, {3}, "X,Y,Z")));
  if (!command.scale.empty()) {
    const std::vector<double> n = numbers_of("--scale", command.scale, {1, 3}, "S or X,Y,Z");
    return scaling(n.size() == 3 ? point_of(n) : Point{n[0], n[0], n[0]}, center);
  }
  if (!command.rotate.empty()) {
    const std::vector<double> n = numbers_of("--rotate", command.rotate, {4}, "X,Y,Z,DEGREES");
    return rotation(point_of(n), n[3], center);
  }
  if (command.matrix.empty())
    throw UsageError(usage_text("none of --matrix, --translate, --scale, --rotate is given", "transform"));
  const std::vector<double> n = numbers_of("--matrix", command.matrix, {16}, "16 numbers, row by row");
  Matrix matrix{};
  std::copy(n.begin(), n.end(), matrix.begin());
  return matrix;
}

int run_transform(TransformCommand& command) {
  const Region region = region_of(command.edit.region, "transform");
  command.options.matrix = matrix_of(command);
  Repository repository = Repository::open(command.edit.folder);
  command.options.memory = command.edit.memory;
  command.options.commit = command.edit.commit;
  CommitReport report;
  {
    ProgressBar bar("transform", command.edit.mode.quiet);
    command.options.commit.progress = bar.callback();
    report = repository.transform(command.edit.which.mesh, region, command.options);
  }
  return finish_built_in_edit(report, command.edit.mode, "transform");
}

void add_maps(CLI::App& verb, TransformCommand& command) {
  const char* group = "MAP (one of)";
  CLI::Option* matrix = verb.add_option("--matrix", command.matrix, "16 numbers, row by row; the last row 0,0,0,1");
  CLI::Option* translate = verb.add_option("--translate", command.translate, "Move by so much (model units)");
  CLI::Option* scale = verb.add_option("--scale", command.scale, "Scale about --center, alike or axis by axis");
  CLI::Option* rotate =
      verb.add_option("--rotate", command.rotate, "Turn about the axis through --center, counter-clockwise");
  matrix->type_name("M00,M01,...,M33")->group(group);
  translate->type_name("X,Y,Z")->group(group)->excludes(matrix);
  scale->type_name("S|X,Y,Z")->group(group)->excludes(matrix)->excludes(translate);
  rotate->type_name("X,Y,Z,DEGREES")->group(group)->excludes(matrix)->excludes(translate)->excludes(scale);
  verb.add_option("--center", command.center, "What --scale and --rotate leave in place (default: 0,0,0)")
      ->type_name("X,Y,Z")
      ->group(group)
      ->excludes(matrix)
      ->excludes(translate);
}

}  // namespace

void setup_transform(CLI::App& app, Run& run) {
  const auto command = std::make_shared<TransformCommand>();
  CLI::App& verb = *app.add_subcommand("transform", "Move, scale or turn a region of any size and commit");
  add_maps(verb, *command);
  verb.add_option("--falloff", command->options.falloff,
                  "Vertices up to so far outside the shape go along, the less the farther (model units); the region "
                  "is then boxes, spheres or points")
      ->type_name("R")
      ->check(CLI::PositiveNumber.description(""));
  add_built_in_edit(verb, command->edit);
  add_example(verb,
              "ramcdb transform statues.ramcdb --near 0,1.5,0.2 --falloff 0.1 --translate 0,0,0.05 -m \"longer nose\"");
  verb.callback([command, &run] { run = [command] { return run_transform(*command); }; });
}

}  // namespace ramcdb::cli
