#pragma once

#include <functional>

namespace CLI {
class App;
}

/// One setup_x per verb, each in a file of its own: it adds the verb with its options and its help, and has `run` do
/// the work when the verb was the one on the command line. Running is kept out of parsing, so that wrong usage and a
/// failed operation never mix.
namespace ramcdb::cli {

/// Does the verb's work and returns the exit code. Empty until a verb is parsed.
using Run = std::function<int()>;

void setup_init(CLI::App& app, Run& run);
void setup_import(CLI::App& app, Run& run);
void setup_ls(CLI::App& app, Run& run);
void setup_info(CLI::App& app, Run& run);
void setup_charts(CLI::App& app, Run& run);
void setup_checkout(CLI::App& app, Run& run);
void setup_status(CLI::App& app, Run& run);
void setup_diff(CLI::App& app, Run& run);
void setup_commit(CLI::App& app, Run& run);
void setup_smooth(CLI::App& app, Run& run);
void setup_transform(CLI::App& app, Run& run);
void setup_decimate(CLI::App& app, Run& run);
void setup_log(CLI::App& app, Run& run);
void setup_show(CLI::App& app, Run& run);
void setup_export(CLI::App& app, Run& run);
void setup_merge(CLI::App& app, Run& run);
void setup_revert(CLI::App& app, Run& run);
void setup_repack(CLI::App& app, Run& run);
void setup_branch(CLI::App& app, Run& run);
void setup_tag(CLI::App& app, Run& run);
void setup_lock(CLI::App& app, Run& run);
void setup_unlock(CLI::App& app, Run& run);
void setup_locks(CLI::App& app, Run& run);
void setup_verify(CLI::App& app, Run& run);

}  // namespace ramcdb::cli
