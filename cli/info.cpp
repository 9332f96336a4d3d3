#include <CLI/CLI.hpp>
#include <memory>

#include "cli/attribute_text.h"
#include "cli/failure.h"
#include "cli/json_out.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/size_table.h"
#include "cli/table.h"
#include "cli/text.h"
#include "cli/verbs.h"
#include "ramcdb/repository.h"

namespace ramcdb::cli {
namespace {

struct InfoOptions {
  std::string folder;
  MeshAt which;
  OutputMode mode;
};

std::string shape_text(const MeshInfo& info) {
  Table table({{one_line(info.mesh), Table::Align::left}, {version_text(info.revision)}});
  table.add({"vertices", grouped(info.vertices)});
  table.add({"  isolated", grouped(info.isolated_vertices)});
  table.add({"  non-manifold", grouped(info.nonmanifold_vertices)});
  table.add({info.polygons ? "faces (triangles)" : "faces", grouped(info.faces)});
  if (info.polygons) table.add({"  polygons they make up", grouped(info.polygons)});
  table.add({"  degenerate", grouped(info.degenerate_faces)});
  table.add({"  duplicate", grouped(info.duplicate_faces)});
  table.add({"non-manifold edges", grouped(info.nonmanifold_edges)});
  table.add({"inconsistently oriented edges", grouped(info.inconsistent_edges)});
  table.add({"components", grouped(info.components)});
  table.add({"boundary loops", grouped(info.boundary_loops)});
  table.add({"charts", grouped(info.charts)});
  table.add({"wires", grouped(info.wires)});
  table.add({"corners", grouped(info.corners)});
  return table.text();
}

std::string place_text(const MeshInfo& info) {
  const auto spread = info.chart_faces;
  const std::string error = info.lossless
                                ? "none (lossless)"
                                : "at most " + model_units(info.max_error) + " along each axis, lattice step " +
                                      model_units(info.lattice.step) + " (model units)";
  return "box          " + point_text(info.lo) + "," + point_text(info.hi) + "\nerror        " + error +
         "\nchart faces  min " + grouped(spread.min) + ", median " + grouped(spread.median) + ", p95 " +
         grouped(spread.p95) + ", max " + grouped(spread.max) + " (target " + grouped(info.target_faces) +
         ")\nprofile      " + one_line(info.profile) + "\n";
}

std::string attributes_text(const MeshInfo& info) {
  std::string text;
  for (const MeshInfo::Layer& layer : info.attributes) text += "attribute    " + attribute_text(layer) + "\n";
  for (const std::string& reference : info.references) text += "reference    " + one_line(reference) + "\n";
  return text;
}

int run_info(const InfoOptions& options) {
  const Repository repository = Repository::open(options.folder);
  const MeshInfo info = repository.snapshot(options.which.mesh, options.which.at).info();
  say(options.mode.json ? info_json(info)
                        : shape_text(info) + "\n" + place_text(info) + attributes_text(info) + "\n" + size_table(info));
  return kDone;
}

}  // namespace

void setup_info(CLI::App& app, Run& run) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App& verb = *app.add_subcommand("info", "Show the figures of one mesh at one version");
  add_repository(verb, options->folder);
  add_mesh(verb, options->which);
  add_at(verb, options->which);
  add_output_mode(verb, options->mode);
  add_example(verb, "ramcdb info statues.ramcdb --mesh dragon --at HEAD~1");
  verb.callback([options, &run] { run = [options] { return run_info(*options); }; });
}

}  // namespace ramcdb::cli
