#include <CLI/CLI.hpp>
#include <memory>

#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/lock_options.h"
#include "cli/name_text.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/region_options.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct LockCommand {
  std::string folder, mesh;
  RegionOptions region;
  LockOptions options;
  OutputMode mode;
};

int run_lock(const LockCommand& command) {
  const Region region = region_of(command.region, "lock");
  Repository repository = Repository::open(command.folder);
  const Snapshot snapshot = repository.snapshot(command.mesh, command.options.branch);
  const LockReport report = repository.lock(snapshot, snapshot.find(region), command.options);
  if (command.mode.json)
    say(lock_json(report));
  else if (!command.mode.quiet)
    say(lock_report_text(report));
  return kDone;
}

struct UnlockCommand {
  std::string folder, mesh, owner;
  std::string branch = "main";
  RegionOptions region;
  std::uint32_t id = 0;
  bool force = false;
  OutputMode mode;
};

/// `--all` is everything that somebody holds, of whatever mesh.
std::vector<LockInfo> unlock(const UnlockCommand& command) {
  if (command.id != 0) {
    if (!is_empty(command.region)) throw UsageError(usage_text("--id goes with no region", "unlock"));
    return Repository::open(command.folder).unlock(command.id, command.owner, command.force);
  }
  if (command.region.all) return Repository::open(command.folder).unlock_all(command.owner, command.force);
  const Region region = region_of(command.region, "unlock");
  Repository repository = Repository::open(command.folder);
  const Snapshot snapshot = repository.snapshot(command.mesh, command.branch);
  return repository.unlock(snapshot, snapshot.find(region), command.owner, command.force);
}

int run_unlock(const UnlockCommand& command) {
  const std::vector<LockInfo> released = unlock(command);
  if (command.mode.json)
    say(locks_json(released, "released"));
  else if (!command.mode.quiet)
    say(released.empty() ? "there was nothing to release\n" : "released\n" + locks_text(released));
  return kDone;
}

struct LocksCommand {
  std::string folder;
  OutputMode mode;
};

int run_locks(const LocksCommand& command) {
  const std::vector<LockInfo> locks = Repository::open(command.folder).locks();
  if (command.mode.json)
    say(locks_json(locks, "locks"));
  else
    say(locks.empty() ? "no locks\n" : locks_text(locks));
  return kDone;
}

}  // namespace

void setup_lock(CLI::App& app, Run& run) {
  const auto command = std::make_shared<LockCommand>();
  CLI::App& verb = *app.add_subcommand(
      "lock", "Say that you are at work on the charts of a region: commits of others to them are refused");
  add_repository(verb, command->folder);
  add_region(verb, command->region);
  add_lock_options(verb, command->options, nullptr);
  add_owner(verb, command->options.owner);
  verb.add_option("--mesh", command->mesh, "The mesh; may be left out where the repository holds one")
      ->type_name("NAME");
  verb.add_option("--branch", command->options.branch, "The branch you work on; locks hold on all (default: main)")
      ->type_name("NAME");
  add_output_mode(verb, command->mode);
  add_example(verb, "ramcdb lock statues.ramcdb --sphere 0.1,0.5,0,0.2 --for 2h -m \"sculpting the left horn\"");
  verb.callback([command, &run] { run = [command] { return run_lock(*command); }; });
}

void setup_unlock(CLI::App& app, Run& run) {
  const auto command = std::make_shared<UnlockCommand>();
  CLI::App& verb =
      *app.add_subcommand("unlock", "Give locks back: those in a region, one by its number, or all of yours");
  add_repository(verb, command->folder);
  add_region(verb, command->region);
  verb.add_option("--id", command->id, "This lock, as `ramcdb locks` numbers it")
      ->type_name("N")
      ->check(CLI::Range(1U, ~0U));
  add_owner(verb, command->owner);
  verb.add_flag("--force", command->force, "Also what others hold; with --all everybody's");
  verb.add_option("--mesh", command->mesh, "The mesh; may be left out where the repository holds one")
      ->type_name("NAME");
  verb.add_option("--branch", command->branch, "On which branch the region is looked up (default: main)")
      ->type_name("NAME");
  add_output_mode(verb, command->mode);
  add_example(verb, "ramcdb unlock statues.ramcdb --sphere 0.1,0.5,0,0.2\n  ramcdb unlock statues.ramcdb --all");
  verb.callback([command, &run] { run = [command] { return run_unlock(*command); }; });
}

void setup_locks(CLI::App& app, Run& run) {
  const auto command = std::make_shared<LocksCommand>();
  CLI::App& verb = *app.add_subcommand("locks", "List who has locked which charts");
  add_repository(verb, command->folder);
  add_output_mode(verb, command->mode);
  add_example(verb, "ramcdb locks statues.ramcdb");
  verb.callback([command, &run] { run = [command] { return run_locks(*command); }; });
}

}  // namespace ramcdb::cli
