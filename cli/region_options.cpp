#include "cli/region_options.h"

#include <CLI/CLI.hpp>

#include "cli/failure.h"
#include "ramcdb/error.h"

namespace ramcdb::cli {
namespace {

const char* group_of(RegionUse use) {
  return use == RegionUse::charts
             ? "REGION (one or more, united; always whole charts)"
             : "REGION (one or more, united; boxes, balls and frusta as they are, anything else, and with --grow all, "
               "whole charts)";
}

void add_shape(CLI::App& verb, RegionUse use, const char* name, std::vector<std::string>& texts, const char* form,
               const std::string& help) {
  verb.add_option(name, texts, help)
      ->type_name(form)
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false)  // --box A --box B, never --box A B: B would swallow a positional
      ->group(group_of(use));
}

template <class Parse>
void add_shapes(Region& region, const std::vector<std::string>& texts, Parse parse) {
  for (const std::string& text : texts) region.shapes.emplace_back(parse(text));
}

}  // namespace

void add_region(CLI::App& verb, RegionOptions& options, RegionUse use) {
  const bool whole = use == RegionUse::charts;
  const auto add = [&](const char* name, std::vector<std::string>& texts, const char* form, const std::string& help) {
    add_shape(verb, use, name, texts, form, help);
  };
  add("--box", options.boxes, "X0,Y0,Z0,X1,Y1,Z1",
      whole ? "Charts whose bounding box meets the box" : "What is in a box");
  add("--sphere", options.spheres, "X,Y,Z,R", whole ? "Charts whose bounding box meets the ball" : "What is in a ball");
  add("--charts", options.charts, "5,9-12", "These charts");
  add("--near", options.points, "X,Y,Z", "The chart closest to the point");
  add("--frustum", options.frusta, "M00,M01,...,M33",
      std::string(whole ? "Charts that a camera sees" : "What a camera sees") +
          ": 16 numbers, its row-major clip matrix");
  verb.add_flag("--all", options.all, "The whole mesh")->group(group_of(use));
  verb.add_option("--grow", options.grow, "Then add K rings of neighbour charts")->type_name("K")->group(group_of(use));
}

bool is_empty(const RegionOptions& options) {
  return options.boxes.empty() && options.spheres.empty() && options.charts.empty() && options.points.empty() &&
         options.frusta.empty() && !options.all && options.grow == 0;
}

Region region_of(const RegionOptions& options, const std::string& verb) {
  Region region;
  try {
    add_shapes(region, options.boxes, parse_box);
    add_shapes(region, options.spheres, parse_sphere);
    add_shapes(region, options.charts, parse_charts);
    add_shapes(region, options.points, parse_nearest);
    add_shapes(region, options.frusta, parse_frustum);
  } catch (const Error& e) {
    throw UsageError(e.what());  // malformed text is wrong usage, whatever the library calls it
  }
  if (options.all) region.shapes.emplace_back(WholeMesh{});
  if (region.shapes.empty()) throw UsageError(usage_text("no region given; for everything say --all", verb));
  region.grow = options.grow;
  return region;
}

}  // namespace ramcdb::cli
