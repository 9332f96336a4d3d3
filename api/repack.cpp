#include "api/repack.h"

#include <chrono>

#include "api/chart_loader.h"
#include "api/commit.h"
#include "api/mesh_encoder.h"
#include "api/store_format.h"

namespace ramcdb::detail {
namespace {

codec::Profile wanted_profile(const Snapshot::Impl& at, const RepackOptions& options) {
  if (!options.profile) return at.record().profile;
  return *options.profile == ChartProfile::fast ? codec::Profile::fast : codec::Profile::dense;
}

codec::CoderTables train_again(const Snapshot::Impl& at, codec::Profile profile, unsigned threads) {
  const std::vector<ChartId> ids = at.pages().all_charts();
  std::vector<ChartId> sample;
  for (std::size_t c = 0; c < ids.size(); c += training_step(at.record().vertices)) sample.push_back(ids[c]);
  const std::vector<LoadedChart> loaded = ChartLoader(at).load(sample, threads);
  std::vector<const Chart*> charts;
  for (const LoadedChart& each : loaded) charts.push_back(&each.chart);
  return train_tables(charts, profile, at.record().vertices);
}

/// Whether charts, layers and tables take less than before.
bool is_smaller(const MeshRecord& before, const MeshRecord& after) {
  const auto bits = [](const MeshRecord& r) {
    return 8 * 256 * (r.table_bytes + r.layer_bytes + r.exact_bytes) + r.chart_cost.header + r.chart_cost.connectivity +
           r.chart_cost.geometry;
  };
  return bits(after) < bits(before);
}

}  // namespace

RepackReport repack_mesh(const Snapshot::Impl& at, const RepackOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto progress = [&](double done) {
    if (options.progress) options.progress("encode", done);
  };
  const codec::Profile profile = wanted_profile(at, options);
  RepackReport report;
  report.revision = report.parent = at.version();
  report.charts = at.record().charts;
  const auto encode = [&](const Snapshot::Impl& tip) -> std::optional<EncodedEdit> {
    EncodedEdit encoded =
        encode_again(tip, profile, train_again(tip, profile, options.threads), options.threads, progress);
    report.nothing_changed = profile == tip.record().profile && !is_smaller(tip.record(), encoded.record);
    if (report.nothing_changed) return std::nullopt;
    return encoded;
  };
  CommitOptions commit{options.message, options.author,   options.branch,
                       options.threads, options.progress, options.ignore_locks};
  if (commit.message.empty()) commit.message = profile == codec::Profile::fast ? "repack as fast" : "repack as dense";
  CommitReport committed;
  publish_on_tip(at, commit, "repack", db::new_attempt_id(), encode, committed);
  if (!report.nothing_changed) {
    report.bytes_written = committed.bytes_written;
    report.revision = committed.revision;
    report.parent = committed.parent;
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb::detail
