#include <CLI/CLI.hpp>
#include <memory>

#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/name_text.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/region_options.h"
#include "cli/table.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct LogOptions {
  std::string folder;
  MeshAt which;
  std::string branch;
  RegionOptions region;
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
               grouped(version.charts_touched), one_line(version.message) + ref_text(version.refs)});
  return table.text();
}

/// --branch names a branch, where --at takes any version.
void require_branch(const Repository& repository, const std::string& name) {
  std::string names;
  for (const Branch& branch : repository.branches()) {
    if (branch.name == name) return;
    names += (names.empty() ? "" : ", ") + branch.name;
  }
  throw Error(Errc::not_found, "there is no branch '" + one_line(name) + "'", {},
              names.empty() ? "nothing is published yet" : "there are " + names);
}

std::vector<VersionRecord> versions_of(const LogOptions& options) {
  const bool everywhere = is_empty(options.region);
  const Region region = everywhere ? Region{} : region_of(options.region, "log");
  const Repository repository = Repository::open(options.folder);
  if (!options.branch.empty()) require_branch(repository, options.branch);
  const std::string& from = options.branch.empty() ? options.which.at : options.branch;
  return everywhere ? repository.log(from, options.limit, options.which.mesh)
                    : repository.log_of_region(region, from, options.limit, options.which.mesh);
}

int run_log(const LogOptions& options) {
  const auto versions = versions_of(options);
  say(options.mode.json ? log_json(versions) : log_text(versions));
  return kDone;
}

}  // namespace

void setup_log(CLI::App& app, Run& run) {
  const auto options = std::make_shared<LogOptions>();
  CLI::App& verb =
      *app.add_subcommand("log", "List the versions, newest first; with a REGION those that touched that place");
  add_repository(verb, options->folder);
  verb.add_option("-n,--limit", options->limit, "At most N versions")->type_name("N")->check(CLI::NonNegativeNumber);
  verb.add_option("--mesh", options->which.mesh, "Only versions that changed this mesh")->type_name("NAME");
  add_at(verb, options->which);
  verb.add_option("--branch", options->branch, "The versions of this branch")
      ->type_name("NAME")
      ->excludes(verb.get_option("--at"));
  add_region(verb, options->region);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb log statues.ramcdb -n 10 --mesh dragon\n  ramcdb log statues.ramcdb --box -1,-1,0,1,1,2.5");
  verb.callback([options, &run] { run = [options] { return run_log(*options); }; });
}

}  // namespace ramcdb::cli
