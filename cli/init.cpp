#include <CLI/CLI.hpp>
#include <memory>

#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct InitOptions {
  std::string folder;
  OutputMode mode;
};

int run_init(const InitOptions& options) {
  Repository::create(options.folder);
  const Repository repository = Repository::open(options.folder);
  if (options.mode.json)
    say(init_json(repository.folder(), repository.id()));
  else if (!options.mode.quiet)
    say("empty repository " + repository.folder().string() + "\n");
  return kDone;
}

}  // namespace

void setup_init(CLI::App& app, Run& run) {
  const auto options = std::make_shared<InitOptions>();
  CLI::App& verb = *app.add_subcommand("init", "Make an empty repository");
  add_repository(verb, options->folder);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb init statues.ramcdb");
  verb.callback([options, &run] { run = [options] { return run_init(*options); }; });
}

}  // namespace ramcdb::cli
