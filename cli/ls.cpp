#include <CLI/CLI.hpp>
#include <memory>

#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/table.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct LsOptions {
  std::string folder;
  MeshAt which;
  OutputMode mode;
};

std::string meshes_text(const std::vector<MeshSummary>& meshes) {
  if (meshes.empty()) return "no meshes\n";
  Table table({{"mesh", Table::Align::left}, {"vertices"}, {"faces"}, {"charts"}, {"bytes"}, {"bits/vertex"}});
  for (const MeshSummary& mesh : meshes)
    table.add({one_line(mesh.name), grouped(mesh.vertices), grouped(mesh.faces), grouped(mesh.charts),
               grouped(mesh.payload), fixed(bits_per_vertex(mesh.payload, mesh.vertices), 3)});
  return table.text();
}

int run_ls(const LsOptions& options) {
  const Repository repository = Repository::open(options.folder);
  const std::vector<MeshSummary> meshes = repository.meshes(options.which.at);
  say(options.mode.json ? meshes_json(meshes, repository.resolve(options.which.at)) : meshes_text(meshes));
  return kDone;
}

}  // namespace

void setup_ls(CLI::App& app, Run& run) {
  const auto options = std::make_shared<LsOptions>();
  CLI::App& verb = *app.add_subcommand("ls", "List the meshes of a repository with their sizes");
  add_repository(verb, options->folder);
  add_at(verb, options->which);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb ls statues.ramcdb");
  verb.callback([options, &run] { run = [options] { return run_ls(*options); }; });
}

}  // namespace ramcdb::cli
