#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "api/repository_impl.h"
#include "api/smoothing_field.h"
#include "api/snapshot_impl.h"
#include "api/streamed_edit.h"
#include "ramcdb/built_in_edits.h"

namespace ramcdb {
namespace {

constexpr unsigned kMostIterations = 1'000'000;

void require_smoothing(const SmoothOptions& options) {
  if (options.iterations < 1 || options.iterations > kMostIterations)
    throw Error(Errc::invalid_argument, fmt::format("{} iterations are out of range", options.iterations), {},
                "give 1 to 1,000,000");
  if (!(options.lambda > 0 && options.lambda <= 1))
    throw Error(Errc::invalid_argument, fmt::format("lambda = {} is out of range", options.lambda), {},
                "give a number above 0, at most 1");
}

}  // namespace

CommitReport Repository::smooth(std::string_view mesh, const Region& region, const SmoothOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  require_smoothing(options);
  (void)impl_->store_for_writing();
  detail::sweep_scratch(folder());
  const Snapshot base = snapshot(mesh, options.commit.branch);
  const auto progress = [&](const char* stage, double done) {
    if (options.commit.progress) options.commit.progress(stage, done);
  };
  const std::vector<ChartId> charts = base.find(region);
  detail::SmoothingField field(base.impl(), charts, folder());
  field.load(options.memory, options.commit.threads, [&](double done) { progress("read", done); });
  const auto lambda = static_cast<std::int64_t>(std::floor(options.lambda * (1 << 20) + 0.5));
  for (unsigned i = 0; i < options.iterations; ++i) {
    progress("smooth", static_cast<double>(i) / options.iterations);
    field.step(lambda, options.commit.threads);
  }
  detail::StreamedMoves moves{.region = charts, .mover = {}, .turner = {}, .scratch_folder = folder()};
  moves.mover = [&](const VertexKey& key, LatticePoint from, const Point& position) {
    return field.move_of(key, from, position);
  };
  moves.memory = options.memory;
  CommitReport report = detail::commit_streamed(base.impl(), moves, options.commit, "smooth");
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb
