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
bool is_smaller(const EncodedEdit& edit) {
  std::int64_t saved = static_cast<std::int64_t>(edit.coding->table_bytes_before);
  if (edit.coding->table) saved -= static_cast<std::int64_t>(edit.coding->tables.size() + kBlobOverhead);
  const auto bits = [](const codec::ChartCost& cost) {
    return static_cast<std::int64_t>(cost.header + cost.connectivity + cost.geometry);
  };
  std::int64_t saved_bits = 0;
  for (const auto& [id, chart] : edit.charts) {
    saved_bits += bits(chart.cost_before) - bits(chart.cost);
    for (const RecodedLayer& layer : chart.layers)
      saved +=
          static_cast<std::int64_t>(layer.bytes_before) - static_cast<std::int64_t>(layer.blob.size() + kBlobOverhead);
  }
  return 8 * 256 * saved + saved_bits > 0;
}

}  // namespace

RepackReport repack_mesh(const Snapshot::Impl& at, const RepackOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto progress = [&](double done) {
    if (options.progress) options.progress("encode", done);
  };
  const codec::Profile profile = wanted_profile(at, options);
  const EncodedEdit encoded =
      encode_again(at, profile, train_again(at, profile, options.threads), options.threads, progress);
  RepackReport report;
  report.revision = report.parent = at.version();
  report.charts = encoded.charts.size();
  if (profile == at.record().profile && !is_smaller(encoded)) {
    report.nothing_changed = true;
  } else {
    CommitOptions commit{options.message, options.author,   options.branch,
                         options.threads, options.progress, options.ignore_locks};
    if (commit.message.empty()) commit.message = profile == codec::Profile::fast ? "repack as fast" : "repack as dense";
    CommitReport committed;
    publish_edit(at, encoded, commit, "repack", db::new_attempt_id(), committed);
    report.conflicts = std::move(committed.conflicts);
    report.bytes_written = committed.bytes_written;
    if (report.conflicts.empty()) {
      report.revision = committed.revision;
      report.parent = committed.parent;
    }
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb::detail
