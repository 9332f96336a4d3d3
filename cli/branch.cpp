#include <CLI/CLI.hpp>
#include <memory>

#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/name_text.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/table.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct BranchCommand {
  std::string folder, name, at;
  std::string doomed;               ///< -d
  std::vector<std::string> rename;  ///< -m: old and new
  bool force = false;
  OutputMode mode;
};

std::string branches_text(const std::vector<Branch>& branches) {
  if (branches.empty()) return "no branches: nothing is published yet\n";
  Table table({{"branch", Table::Align::left}, {"tip"}, {"ahead of main"}, {"behind"}});
  for (const Branch& branch : branches)
    table.add({branch.name, version_text(branch.tip), grouped(branch.ahead), grouped(branch.behind)});
  return table.text();
}

int list_branches(const BranchCommand& command) {
  const auto branches = Repository::open(command.folder).branches();
  say(command.mode.json ? branches_json(branches) : branches_text(branches));
  return kDone;
}

void say_change(const BranchCommand& command, const NameChange& change) {
  if (command.mode.json)
    say(name_change_json(change));
  else if (!command.mode.quiet)
    say(name_change_text(change));
}

int change_branch(const BranchCommand& command) {
  Repository repository = Repository::open(command.folder);
  NameChange change{"branch", command.name, {}, {}, {}};
  if (!command.doomed.empty()) {
    change.name = command.doomed;
    change.nameless = repository.delete_branch(command.doomed, command.force);
  } else if (!command.rename.empty()) {
    repository.rename_branch(command.rename[0], command.rename[1]);
    change.name = command.rename[1];
    change.before = command.rename[0];
    change.version = repository.resolve(change.name);
  } else {
    change.nameless = repository.create_branch(command.name, command.at, command.force);
    change.version = repository.resolve(command.name);
  }
  say_change(command, change);
  return kDone;
}

int run_branch(const BranchCommand& command) {
  const bool is_list = command.name.empty() && command.doomed.empty() && command.rename.empty();
  if (is_list && command.force) throw UsageError(usage_text("--force goes with a name", "branch"));
  return is_list ? list_branches(command) : change_branch(command);
}

}  // namespace

void setup_branch(CLI::App& app, Run& run) {
  const auto command = std::make_shared<BranchCommand>();
  CLI::App& verb = *app.add_subcommand("branch", "List branches; make, move, rename or delete one");
  add_repository(verb, command->folder);
  CLI::Option* name = verb.add_option("NAME", command->name, "The branch to make")->type_name("");
  CLI::Option* at =
      verb.add_option("AT", command->at, "Where: 17, v17, a branch, a tag, HEAD, each with ~N (default: HEAD)")
          ->type_name("");
  at->needs(name);
  CLI::Option* doomed = verb.add_option("-d,--delete", command->doomed,
                                        "Delete this branch; with -f also when its versions are left without a name")
                            ->type_name("NAME");
  CLI::Option* rename =
      verb.add_option("-m,--move", command->rename, "Rename a branch")->type_name("OLD NEW")->expected(2);
  verb.add_flag("-f,--force", command->force, "Move a branch that is there")->excludes(rename);
  doomed->excludes(name)->excludes(rename);
  rename->excludes(name);
  add_output_mode(verb, command->mode);
  add_example(verb,
              "ramcdb branch statues.ramcdb\n  ramcdb branch statues.ramcdb left-horn HEAD~2\n"
              "  ramcdb branch statues.ramcdb -d left-horn");
  verb.callback([command, &run] { run = [command] { return run_branch(*command); }; });
}

}  // namespace ramcdb::cli
