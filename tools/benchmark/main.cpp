// ramcdb-bench [--bits N] [--rounds N] [--json FILE] [--coder FILE...] [--store FILE...]
//
// Measures the coder against Draco, and the repository's costs, on mesh files. Tables as Markdown on standard output,
// everything as JSON in a file. tools/bench builds it and chooses meshes.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/benchmark/coder_bench.h"
#include "tools/benchmark/store_bench.h"

namespace {

namespace fs = std::filesystem;
using namespace ramcdb::benchmark;
using nlohmann::json;

/// A folder of this run's own, removed at the end.
class Scratch {
 public:
  Scratch() : folder_(fs::temp_directory_path() / fmt::format("ramcdb-bench-{}", ::getpid())) { clear(); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { fs::remove_all(folder_); }

  const fs::path& clear() const {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    return folder_;
  }

 private:
  fs::path folder_;
};

double bits_per_vertex(std::uint64_t bytes, const ramcdb::MeshInfo& info) {
  return 8 * static_cast<double>(bytes) / static_cast<double>(info.vertices);
}

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

json peer_json(const CoderFigures::Peer& peer) {
  return {{"bytes", peer.bytes}, {"faces", peer.faces}, {"encode", peer.encode}, {"decode", peer.decode}};
}

json coder_row(const CoderFigures& f) {
  const auto bpv = [&](std::uint64_t bytes) { return bits_per_vertex(bytes, f.info); };
  const auto& b = f.info.bytes;
  fmt::print(
      "| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:+.1f} % | {:.2f} / {:.2f} | "
      "{:.2f} / {:.2f} | {:.2f} / {:.2f} | {:.2f} |\n",
      f.mesh, f.info.faces, bpv(b.payload), bpv(b.connectivity), bpv(b.geometry), bpv(b.wires),
      bpv(b.wire_net + b.chart_headers + b.tables), bpv(f.draco10.bytes), bpv(f.draco7.bytes),
      100 * (bpv(b.payload) / bpv(f.draco10.bytes) - 1), f.encode / 1e6, f.decode / 1e6, f.draco10.encode / 1e6,
      f.draco10.decode / 1e6, f.draco7.encode / 1e6, f.draco7.decode / 1e6, f.cut / 1e6);
  json row = mesh_json(f.info);
  row.update({{"encode", f.encode}, {"decode", f.decode}, {"cut", f.cut}});
  row["draco10"] = peer_json(f.draco10);
  row["draco7"] = peer_json(f.draco7);
  return row;
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

constexpr const char* kCoderHead =
    "| mesh | faces | **bits/vertex** | connectivity | geometry | wires | index | Draco cl10 | Draco cl7 | to cl10 | "
    "enc / dec | cl10 enc / dec | cl7 enc / dec | cut |\n"
    "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
constexpr const char* kStoreHead =
    "| mesh | faces | charts | import Mfaces/s | store / payload | checkout ms | KiB | blobs | commit ms | KiB | plain "
    "LMDB ms |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Size and speed of the coder against Draco, and what a repository costs");
  unsigned bits = 12, rounds = 5;
  std::string json_file;
  std::vector<std::string> coder, store;
  app.add_option("--bits", bits, "Lattice bits along the largest extent");
  app.add_option("--rounds", rounds, "Rounds that medians are taken over")->check(CLI::PositiveNumber);
  app.add_option("--json", json_file, "Where all figures go");
  app.add_option("--coder", coder, "Meshes to code")->check(CLI::ExistingFile);
  app.add_option("--store", store, "Meshes to keep, check out and commit to")->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);

  const Scratch scratch;
  json all = {{"bits", bits}, {"rounds", rounds}, {"coder", json::array()}, {"store", json::array()}};
  if (!coder.empty()) {
    fmt::print("\n## Coder: {} bits, charts of 5,000 faces, speeds in Mtri/s on one thread\n\n{}", bits, kCoderHead);
    for (const std::string& file : coder)
      all["coder"].push_back(coder_row(measure_coder(file, scratch.clear(), bits, rounds)));
  }
  if (!store.empty()) {
    fmt::print("\n## Repository: one-chart checkout and commit\n\n{}", kStoreHead);
    for (const std::string& file : store)
      all["store"].push_back(store_row(measure_store(file, scratch.clear(), bits, rounds)));
  }
  if (!json_file.empty()) std::ofstream(json_file) << all.dump(2) << '\n';
  return 0;
} catch (const std::exception& error) {
  std::cerr << "ramcdb-bench: " << error.what() << '\n';
  return 1;
}
