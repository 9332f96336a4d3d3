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

struct TagCommand {
  std::string folder, name, at;
  std::string doomed;  ///< -d
  bool force = false;
  OutputMode mode;
};

std::string tags_text(const std::vector<Tag>& tags) {
  if (tags.empty()) return "no tags\n";
  Table table({{"tag", Table::Align::left}, {"version"}});
  for (const Tag& tag : tags) table.add({tag.name, version_text(tag.version)});
  return table.text();
}

int list_tags(const TagCommand& command) {
  const auto tags = Repository::open(command.folder).tags();
  say(command.mode.json ? tags_json(tags) : tags_text(tags));
  return kDone;
}

int change_tag(const TagCommand& command) {
  Repository repository = Repository::open(command.folder);
  NameChange change{"tag", command.name, {}, {}, {}};
  if (!command.doomed.empty()) {
    change.name = command.doomed;
    change.nameless = repository.delete_tag(command.doomed);
  } else {
    change.nameless = repository.create_tag(command.name, command.at, command.force);
    change.version = repository.resolve(command.name);
  }
  if (command.mode.json)
    say(name_change_json(change));
  else if (!command.mode.quiet)
    say(name_change_text(change));
  return kDone;
}

int run_tag(const TagCommand& command) {
  const bool is_list = command.name.empty() && command.doomed.empty();
  if (is_list && command.force) throw UsageError(usage_text("--force goes with a name", "tag"));
  return is_list ? list_tags(command) : change_tag(command);
}

}  // namespace

void setup_tag(CLI::App& app, Run& run) {
  const auto command = std::make_shared<TagCommand>();
  CLI::App& verb = *app.add_subcommand("tag", "List tags; make or delete one");
  add_repository(verb, command->folder);
  CLI::Option* name = verb.add_option("NAME", command->name, "The tag to make")->type_name("");
  verb.add_option("AT", command->at, "Of which version: 17, v17, a branch, HEAD, each with ~N (default: HEAD)")
      ->type_name("")
      ->needs(name);
  verb.add_option("-d,--delete", command->doomed, "Delete this tag")->type_name("NAME")->excludes(name);
  verb.add_flag("-f,--force", command->force, "Have a tag that is there name another version");
  add_output_mode(verb, command->mode);
  add_example(verb,
              "ramcdb tag statues.ramcdb\n  ramcdb tag statues.ramcdb as-scanned 1\n"
              "  ramcdb tag statues.ramcdb -d as-scanned");
  verb.callback([command, &run] { run = [command] { return run_tag(*command); }; });
}

}  // namespace ramcdb::cli
