#include <CLI/CLI.hpp>
#include <memory>

#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/progress_bar.h"
#include "cli/table.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct VerifyCommand {
  std::string folder;
  Repository::VerifyOptions options;
  OutputMode mode;
};

std::string problems_text(const std::vector<VerifyReport::Problem>& problems) {
  Table table({{"kind", Table::Align::left},
               {"mesh", Table::Align::left},
               {"object", Table::Align::left},
               {"version"},
               {"problem", Table::Align::left}});
  for (const auto& problem : problems)
    table.add({problem.kind, one_line(problem.mesh), one_line(problem.object), version_text(problem.revision),
               one_line(problem.text)});
  return table.text();
}

std::string report_text(const VerifyReport& report) {
  const std::string looked_at =
      counted(report.objects, "object") + " looked at, " + counted(report.decoded_charts, "chart") + " decoded\n";
  return report.ok() ? looked_at + "no damage\n" : looked_at + problems_text(report.problems);
}

VerifyReport verify(const VerifyCommand& command) {
  const Repository repository = Repository::open(command.folder);
  ProgressBar bar("verify", command.mode.quiet);
  Repository::VerifyOptions options = command.options;
  options.progress = bar.callback();
  return repository.verify(options);
}

int run_verify(const VerifyCommand& command) {
  const VerifyReport report = verify(command);
  if (command.mode.json)
    say(verify_json(report));
  else if (!command.mode.quiet)
    say(report_text(report));
  if (report.ok()) return kDone;
  complain(counted(report.problems.size(), "damaged object") + " found (" + command.folder +
           "): keep a copy of the folder as it is, then take the meshes from a backup or from an undamaged version");
  return kDamageFound;
}

}  // namespace

void setup_verify(CLI::App& app, Run& run) {
  const auto command = std::make_shared<VerifyCommand>();
  CLI::App& verb = *app.add_subcommand("verify", "Check everything in a repository");
  add_repository(verb, command->folder);
  verb.add_flag("--quick", command->options.quick, "Checksums and references only, decode nothing");
  add_threads(verb, command->options.threads);
  add_output_mode(verb, command->mode);
  add_example(verb, "ramcdb verify statues.ramcdb");
  verb.callback([command, &run] { run = [command] { return run_verify(*command); }; });
}

}  // namespace ramcdb::cli
