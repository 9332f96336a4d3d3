#include <chrono>

#include "api/chart_paint.h"
#include "api/checkout.h"
#include "api/output_spool.h"

namespace ramcdb::detail {

CheckoutReport export_mesh(const Snapshot& snapshot, const std::filesystem::path& file, const FileOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  refuse_to_overwrite(file, options);
  check_paint(mesh_file::format_of(file), options.paint, file);
  ReadCost cost;
  const std::vector<ChartId> charts = snapshot.find({{WholeMesh{}}, 0}, &cost);
  std::vector<mesh_file::FaceColor> paint;
  if (options.paint != Paint::none) paint = chart_colors(snapshot, charts, options.paint);
  OutputSpool mesh(snapshot.impl(), std::filesystem::absolute(file).parent_path(), std::move(paint));
  mesh.load(charts, options.memory, options.threads, cost, [&](double done) {
    if (options.progress) options.progress("read", done);
  });
  CheckoutReport report;
  report.revision = snapshot.version();
  report.charts = charts.size();
  report.faces = mesh.faces();
  report.vertices = mesh.vertices();
  add_costs(report, cost, mesh.write(snapshot, file, options));
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace ramcdb::detail
