#pragma once

#include "ramcdb/names.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace ramcdb::cli {

/// --owner; sets `owner` to whom commits name as their author first.
void add_owner(CLI::App& verb, std::string& owner);

/// --for, --why and --steal. `needs`: an option without which they make no sense; may be null.
void add_lock_options(CLI::App& verb, LockOptions& options, CLI::Option* needs);

}  // namespace ramcdb::cli
