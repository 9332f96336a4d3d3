#include "cli/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "cli/failure.h"
#include "cli/output.h"
#include "cli/verbs.h"

namespace ramcdb::cli {
namespace {

constexpr const char* kShortHelp =
    "ramcdb VERB REPO [...]: a versioned, compressed database of meshes. To begin:\n"
    "  ramcdb init statues.ramcdb\n"
    "  ramcdb import statues.ramcdb dragon.ply\n"
    "  ramcdb checkout statues.ramcdb --near 0.1,0.5,0 -o horn.ply\n"
    "  ramcdb commit horn.ply -m \"straighten the left horn\"\n"
    "All verbs: ramcdb --help. One verb: ramcdb VERB --help.\n";

void add_verbs(CLI::App& app, Run& run) {
  setup_init(app, run);
  setup_import(app, run);
  setup_ls(app, run);
  setup_info(app, run);
  setup_charts(app, run);
  setup_checkout(app, run);
  setup_status(app, run);
  setup_diff(app, run);
  setup_commit(app, run);
  setup_smooth(app, run);
  setup_transform(app, run);
  setup_decimate(app, run);
  setup_log(app, run);
  setup_show(app, run);
  setup_export(app, run);
  setup_merge(app, run);
  setup_revert(app, run);
  setup_repack(app, run);
  setup_branch(app, run);
  setup_tag(app, run);
  setup_lock(app, run);
  setup_unlock(app, run);
  setup_locks(app, run);
  setup_verify(app, run);
}

bool knows_verb(const CLI::App& app, const std::string& name) {
  const auto verbs = app.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == name; });
  return !verbs.empty();
}

/// Returns the exit code when parsing already settles it: help, the version, wrong usage. Negative: go on.
int parse(CLI::App& app, int argc, char** argv, const std::string& verb) {
  try {
    app.parse(argc, argv);
    return -1;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // prints help or the version
    complain(usage_text(e.what(), verb));
    return kWrongUsage;
  }
}

int parse_and_run(int argc, char** argv, std::string& verb) {
  if (argc < 2) {
    std::fputs(kShortHelp, stderr);
    return kWrongUsage;
  }
  Run run;
  CLI::App app("A versioned, compressed database for editable triangle meshes", "ramcdb");
  app.set_version_flag("--version", "ramcdb " RAMCDB_VERSION, "Print the version");
  app.footer("Example:\n  ramcdb init statues.ramcdb && ramcdb import statues.ramcdb dragon.ply");
  app.require_subcommand(1);
  add_verbs(app, run);

  const std::string first = argv[1];
  if (knows_verb(app, first)) {
    verb = first;
  } else if (first.empty() || first[0] != '-') {
    complain(usage_text("unknown verb '" + first + "'", ""));
    return kWrongUsage;
  }
  const int settled = parse(app, argc, argv, verb);
  const int code = settled < 0 ? run() : settled;
  finish_output();
  return code;
}

}  // namespace

int run_command_line(int argc, char** argv) noexcept {
  std::string verb = "ramcdb";
  try {
    return parse_and_run(argc, argv, verb);
  } catch (...) {
    return report_exception(verb);
  }
}

}  // namespace ramcdb::cli
