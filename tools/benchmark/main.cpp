// ramcdb-bench [--bits N] [--rounds N] [--chart-faces N,...] [--json FILE] [--plot FILE] [--coder FILE...]
// [--lossless FILE...] [--cut FILE...] [--store FILE...]
//
// Measures the coder against Draco, and the repository's costs, on mesh files. Tables as Markdown on standard output,
// everything as JSON in a file. tools/bench builds it and chooses meshes.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/benchmark/coder_bench.h"
#include "tools/benchmark/cut_bench.h"
#include "tools/benchmark/lossless_bench.h"
#include "tools/benchmark/plot.h"
#include "tools/benchmark/scratch_folder.h"
#include "tools/benchmark/store_bench.h"
#include "tools/benchmark/timing.h"

namespace {

namespace fs = std::filesystem;
using namespace ramcdb::benchmark;
using nlohmann::json;

constexpr const char* kCoderHead =
    "| coder | bits/vertex | to cl10 | connectivity | geometry | wires | index | encode | decode | all cores |\n"
    "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
constexpr const char* kLosslessHead =
    "| mesh | coordinates | positions | XOR + zstd | ratio | everything |\n|---|---|---:|---:|---:|---:|\n";
constexpr const char* kCutHead =
    "| mesh | our charts | bits/vertex | METIS and our refinement | bits/vertex | ours to it |\n"
    "|---|---:|---:|---:|---:|---:|\n";
constexpr const char* kSummaryHead =
    "| ours, faces/chart | against | size, mean | worst | encode speed | decode speed "
    "|\n|---|---|---:|---:|---:|---:|\n";
constexpr const char* kStoreHead =
    "| mesh | faces | charts | import Mfaces/s | store / payload | checkout ms | KiB | blobs | commit ms | KiB | plain "
    "LMDB ms |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";

json mesh_json(const ramcdb::MeshInfo& info) {
  const auto& b = info.bytes;
  return {{"mesh", info.mesh},
          {"faces", info.faces},
          {"vertices", info.vertices},
          {"charts", info.charts},
          {"wire_net", b.wire_net},
          {"wires", b.wires},
          {"connectivity", b.connectivity},
          {"geometry", b.geometry},
          {"chart_headers", b.chart_headers},
          {"tables", b.tables},
          {"payload", b.payload},
          {"store", b.store}};
}

json contestant_json(const Contestant& c) {
  return {{"name", c.name},     {"bytes", c.bytes},   {"connectivity", c.connectivity}, {"geometry", c.geometry},
          {"wires", c.wires},   {"index", c.index},   {"faces", c.back.faces},          {"vertices", c.back.vertices},
          {"encode", c.encode}, {"decode", c.decode}, {"decode_all", c.decode_all}};
}

json coder_table(const CoderFigures& f) {
  const double cl10 = f.find("Draco cl10").bits_per_vertex();
  fmt::print("\n### {}: {} faces, {} vertices\n\n{}", f.mesh, f.faces, f.vertices, kCoderHead);
  json rows = json::array();
  for (const Contestant& c : f.contestants) {
    const auto part = [&](std::uint64_t bytes) {
      return c.connectivity ? fmt::format("{:.2f}", c.bits_per_vertex(bytes)) : "";
    };
    fmt::print("| {} | {:.2f} | {:.3f} | {} | {} | {} | {} | {:.2f} | {:.2f} | {} |\n", c.name, c.bits_per_vertex(),
               c.bits_per_vertex() / cl10, part(c.connectivity), part(c.geometry), part(c.wires), part(c.index),
               c.encode / 1e6, c.decode / 1e6, c.decode_all > 0 ? fmt::format("{:.2f}", c.decode_all / 1e6) : "");
    rows.push_back(contestant_json(c));
  }
  const Contestant& draco = f.find("Draco cl10");
  fmt::print(
      "\none chart: {:.1f} KiB in {:.0f} blobs, {:.2f} ms with opening the repository; all of Draco's file: {:.1f} "
      "KiB, {:.2f} ms\n",
      f.chart_bytes / 1024, f.chart_blobs, 1e3 * f.chart_seconds, static_cast<double>(draco.bytes) / 1024,
      1e3 * static_cast<double>(f.faces) / draco.decode);
  return {{"mesh", f.mesh},
          {"vertices", f.vertices},
          {"faces", f.faces},
          {"contestants", rows},
          {"chart", {{"bytes", f.chart_bytes}, {"blobs", f.chart_blobs}, {"seconds", f.chart_seconds}}}};
}

/// Ours against Draco's level that it is measured by, over all meshes: bits per vertex that came back as geometric mean
/// and worst, speeds as medians of ratios of the same run.
void print_summary(const std::vector<CoderFigures>& all) {
  fmt::print("\n## Over {} meshes\n\n{}", all.size(), kSummaryHead);
  for (const Contestant& ours : all.front().contestants) {
    if (ours.connectivity == 0) continue;
    const std::string peer = ours.name.starts_with("fast") ? "Draco cl7" : "Draco cl10";
    double log_sum = 0, worst = 0;
    std::vector<double> encode, decode;
    for (const CoderFigures& f : all) {
      const Contestant &a = f.find(ours.name), &b = f.find(peer);
      const double ratio = a.bits_per_vertex() / b.bits_per_vertex();
      log_sum += std::log(ratio);
      worst = std::max(worst, ratio);
      encode.push_back(a.encode / b.encode);
      decode.push_back(a.decode / b.decode);
    }
    fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.2f} | {:.2f} |\n", ours.name, peer,
               std::exp(log_sum / static_cast<double>(all.size())), worst, median(encode), median(decode));
  }
}

json lossless_row(const LosslessFigures& f) {
  const auto bpv = [&](std::uint64_t bytes) {
    return 8 * static_cast<double>(bytes) / static_cast<double>(f.vertices);
  };
  fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.2f} | {:.1f} |\n", f.mesh, f.doubles ? "float64" : "float32",
             bpv(f.positions), bpv(f.xor_zstd), bpv(f.positions) / bpv(f.xor_zstd), bpv(f.everything));
  return {{"mesh", f.mesh},           {"vertices", f.vertices},     {"doubles", f.doubles},
          {"positions", f.positions}, {"everything", f.everything}, {"xor_zstd", f.xor_zstd}};
}

json cut_row(const CutFigures& f) {
  const auto bpv = [&](std::uint64_t bytes) {
    return 8 * static_cast<double>(bytes) / static_cast<double>(f.vertices);
  };
  fmt::print("| {} | {} | {:.3f} | {} | {:.3f} | {:.4f} |\n", f.mesh, f.charts, bpv(f.ours), f.metis_charts,
             bpv(f.metis), bpv(f.ours) / bpv(f.metis));
  return {{"mesh", f.mesh},  {"vertices", f.vertices}, {"charts", f.charts}, {"metis_charts", f.metis_charts},
          {"bytes", f.ours}, {"metis_bytes", f.metis}};
}

json store_row(const StoreFigures& f) {
  const double faces = static_cast<double>(f.info.faces);
  const double ratio = static_cast<double>(f.info.bytes.store) / static_cast<double>(f.info.bytes.payload);
  fmt::print("| {} | {} | {} | {:.2f} | {:.3f} | {:.1f} | {:.1f} | {:.0f} | {:.1f} | {:.1f} | {:.1f} |\n", f.info.mesh,
             f.info.faces, f.info.charts, faces / f.import_seconds / 1e6, ratio, f.checkout_seconds * 1e3,
             f.checkout_bytes / 1024, f.checkout_blobs, f.commit_seconds * 1e3, f.commit_bytes / 1024,
             f.plain_lmdb_seconds * 1e3);
  json row = mesh_json(f.info);
  row.update({{"import_seconds", f.import_seconds},
              {"checkout_seconds", f.checkout_seconds},
              {"checkout_bytes", f.checkout_bytes},
              {"checkout_blobs", f.checkout_blobs},
              {"commit_seconds", f.commit_seconds},
              {"commit_bytes", f.commit_bytes},
              {"plain_lmdb_seconds", f.plain_lmdb_seconds}});
  return row;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Size and speed of the coder against Draco, and what a repository costs");
  CoderOptions options;
  std::string json_file, plot;
  std::vector<std::string> coder, lossless, cut, store;
  app.add_option("--bits", options.bits, "Lattice bits along the largest extent");
  app.add_option("--rounds", options.rounds, "Rounds that medians are taken over")->check(CLI::PositiveNumber);
  app.add_option("--json", json_file, "Where all figures go");
  app.add_option("--chart-faces", options.chart_faces, "Chart sizes to code at")->delimiter(',');
  app.add_option("--plot", plot, "Where a picture of sizes and speeds goes, as SVG");
  app.add_option("--coder", coder, "Meshes to code")->check(CLI::ExistingFile);
  app.add_option("--lossless", lossless, "Meshes to keep to the last bit")->check(CLI::ExistingFile);
  app.add_option("--cut", cut, "Meshes to cut into charts by ours and by METIS")->check(CLI::ExistingFile);
  app.add_option("--store", store, "Meshes to keep, check out and commit to")->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);

  const ScratchFolder scratch;
  json all = {{"bits", options.bits},      {"rounds", options.rounds}, {"coder", json::array()},
              {"lossless", json::array()}, {"cut", json::array()},     {"store", json::array()}};
  std::vector<CoderFigures> figures;
  if (!coder.empty())
    fmt::print("\n## Coders: {} bits, speeds in Mtri/s on one thread, medians of {} rounds in turns\n", options.bits,
               options.rounds);
  for (const std::string& file : coder) {
    figures.push_back(measure_coder(file, scratch.clear(), options));
    all["coder"].push_back(coder_table(figures.back()));
    std::fflush(stdout);
  }
  if (!figures.empty()) print_summary(figures);
  if (!figures.empty() && !plot.empty()) write_plot(figures, plot);
  if (!lossless.empty()) {
    fmt::print("\n## Lossless positions, bits/vertex\n\n{}", kLosslessHead);
    for (const std::string& file : lossless)
      all["lossless"].push_back(lossless_row(measure_lossless(file, scratch.clear())));
  }
  if (!cut.empty()) {
    fmt::print("\n## Cut into charts of {} faces: dense, everything counted\n\n{}", options.chart_faces.front(),
               kCutHead);
    double log_sum = 0;
    for (const std::string& file : cut) {
      const CutFigures f = measure_cut(file, options.bits, options.chart_faces.front());
      log_sum += std::log(static_cast<double>(f.ours) / static_cast<double>(f.metis));
      all["cut"].push_back(cut_row(f));
      std::fflush(stdout);
    }
    fmt::print("\ngeometric mean: {:.4f}\n", std::exp(log_sum / static_cast<double>(cut.size())));
  }
  if (!store.empty()) {
    fmt::print("\n## Repository: one-chart checkout and commit\n\n{}", kStoreHead);
    for (const std::string& file : store)
      all["store"].push_back(store_row(measure_store(file, scratch.clear(), options.bits, options.rounds)));
  }
  if (!json_file.empty()) std::ofstream(json_file) << all.dump(2) << '\n';
  return 0;
} catch (const std::exception& error) {
  std::cerr << "ramcdb-bench: " << error.what() << '\n';
  return 1;
}
