#include "cli/lock_options.h"

#include <CLI/CLI.hpp>

#include "cli/name_text.h"
#include "cli/options.h"

namespace ramcdb::cli {
namespace {

std::string refuse_no_time(const std::string& text) {
  return seconds_of(text) > 0 ? "" : "must be a time such as 30m, 2h, 3d or 1w, at most ten years";
}

}  // namespace

void add_owner(CLI::App& verb, std::string& owner) {
  owner = default_author();
  verb.add_option("--owner", owner,
                  "Whose locks: whom commits name as their author (default: $RAMCDB_AUTHOR, else user@host)")
      ->type_name("NAME")
      ->check(CLI::Validator(
          [](const std::string& text) { return std::string(text.empty() ? "must not be empty" : ""); }, ""));
}

void add_lock_options(CLI::App& verb, LockOptions& options, CLI::Option* needs) {
  CLI::Option* lasts = verb.add_option_function<std::string>(
                               "--for", [&options](const std::string& text) { options.seconds = seconds_of(text); },
                               "How long the lock lasts: 90s, 30m, 2h, 3d, 1w (default: 1d)")
                           ->type_name("TIME")
                           ->check(CLI::Validator(refuse_no_time, ""));
  CLI::Option* why =
      verb.add_option(needs ? "--why" : "-m,--why", options.reason, "What the lock is for")->type_name("WHY");
  CLI::Option* steal =
      verb.add_flag("--steal", options.steal, "Take charts over that others have locked, and say whose they were");
  if (!needs) return;
  for (CLI::Option* option : {lasts, why, steal}) option->needs(needs);
}

}  // namespace ramcdb::cli
