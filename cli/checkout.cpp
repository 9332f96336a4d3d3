#include <CLI/CLI.hpp>
#include <memory>

#include "cli/attribute_text.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/lock_options.h"
#include "cli/name_text.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/output_file_options.h"
#include "cli/progress_bar.h"
#include "cli/region_options.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct CheckoutOptions {
  std::string folder;
  MeshAt which;
  RegionOptions region;
  OutputFileOptions output;
  std::optional<bool> local_origin;
  bool take_lock = false;
  LockOptions lock;
  unsigned threads = 1;
  OutputMode mode;
};

std::string origin_text(const CheckoutReport& report) {
  if (report.local_origin == Point{}) return {};
  return "coordinates are relative to " + point_text(report.local_origin) +
         ", which commit adds again (--no-local-origin writes them whole)\n";
}

std::string report_text(const CheckoutReport& report, const std::string& file) {
  return file + ": " + counted(report.charts, "chart") + " of " + version_text(report.revision) + ", " +
         counted(report.vertices, "vertex", "vertices") + ", " + counted(report.faces, "face") + "; read " +
         counted(report.blobs_read, "blob") + ", " + counted(report.bytes_read, "byte") + " in " +
         duration(report.seconds) + "\n" + origin_text(report) + left_out_text(report.left_out) +
         (report.lock ? lock_report_text(*report.lock) : std::string());
}

/// Where the owner works is told by --at, when that is a branch.
LockOptions lock_of(const CheckoutOptions& options, const Repository& repository) {
  LockOptions lock = options.lock;
  for (const Branch& branch : repository.branches())
    if (branch.name == options.which.at) lock.branch = branch.name;
  return lock;
}

CheckoutReport checkout(const CheckoutOptions& options, const Region& region) {
  const Repository repository = Repository::open(options.folder);
  const Snapshot snapshot = repository.snapshot(options.which.mesh, options.which.at);
  FileOptions file = file_options_of(options.output);
  file.local_origin = options.local_origin;
  if (options.take_lock) file.lock = lock_of(options, repository);
  file.threads = options.threads;
  ProgressBar bar("checkout", options.mode.quiet);
  file.progress = bar.callback();
  ReadCost finding;
  const std::vector<ChartId> charts = snapshot.find(region, &finding);
  CheckoutReport report = repository.checkout_file(snapshot, charts, options.output.file, file);
  report.blobs_read += finding.blobs;
  report.pages_read += finding.pages;
  report.bytes_read += finding.bytes;
  return report;
}

int run_checkout(const CheckoutOptions& options) {
  const CheckoutReport report = checkout(options, region_of(options.region, "checkout"));
  if (options.mode.json)
    say(checkout_json(report));
  else if (!options.mode.quiet)
    say(report_text(report, options.output.file));
  return kDone;
}

}  // namespace

void setup_checkout(CLI::App& app, Run& run) {
  const auto options = std::make_shared<CheckoutOptions>();
  CLI::App& verb = *app.add_subcommand("checkout", "Write a region as an ordinary mesh file, for editing and commit");
  add_repository(verb, options->folder);
  add_region(verb, options->region);
  add_output_file(verb, options->output);
  CLI::Option* local = verb.add_flag_callback(
      "--local-origin", [options] { options->local_origin = true; },
      "Write coordinates relative to a point near the region, which commit adds again "
      "(default: where float32 or six digits would not hold them)");
  verb.add_flag_callback(
          "--no-local-origin", [options] { options->local_origin = false; }, "Write coordinates whole")
      ->excludes(local);
  CLI::Option* lock = verb.add_flag("--lock", options->take_lock, "Lock the charts until the file is committed");
  add_lock_options(verb, options->lock, lock);
  add_owner(verb, options->lock.owner);
  add_mesh(verb, options->which);
  add_at(verb, options->which);
  add_threads(verb, options->threads);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb checkout statues.ramcdb --near 0.1,0.5,0 --grow 1 -o horn.ply");
  verb.callback([options, &run] { run = [options] { return run_checkout(*options); }; });
}

}  // namespace ramcdb::cli
