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

struct LogOptions {
  std::string folder;
  MeshAt which;
  std::size_t limit = ~std::size_t{0};
  OutputMode mode;
};

std::string log_text(const std::vector<VersionRecord>& versions) {
  if (versions.empty()) return "no versions\n";
  Table table({{"version"},
               {"time (UTC)", Table::Align::left},
               {"author", Table::Align::left},
               {"charts"},
               {"message", Table::Align::left}});
  for (const VersionRecord& version : versions)
    table.add({version_text(version.id), iso_time(version.time_us, false), one_line(version.author),
               grouped(version.charts_touched), one_line(version.message)});
  return table.text();
}

int run_log(const LogOptions& options) {
  const Repository repository = Repository::open(options.folder);
  const auto versions = repository.log(options.which.at, options.limit, options.which.mesh);
  say(options.mode.json ? log_json(versions) : log_text(versions));
  return kDone;
}

}  // namespace

void setup_log(CLI::App& app, Run& run) {
  const auto options = std::make_shared<LogOptions>();
  CLI::App& verb = *app.add_subcommand("log", "List the versions, newest first");
  add_repository(verb, options->folder);
  verb.add_option("-n,--limit", options->limit, "At most N versions")->type_name("N")->check(CLI::NonNegativeNumber);
  verb.add_option("--mesh", options->which.mesh, "Only versions that changed this mesh")->type_name("NAME");
  add_at(verb, options->which);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb log statues.ramcdb -n 10 --mesh dragon");
  verb.callback([options, &run] { run = [options] { return run_log(*options); }; });
}

}  // namespace ramcdb::cli
