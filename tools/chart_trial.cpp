// ramcdb-chart-trial [--bits N] [--chart-faces N,...] FILE...
//
// Cuts meshes into charts, codes every chart in both profiles, decodes it with nothing but its border, and compares
// with the chart as it was, vertex by vertex and face by face. One line per mesh, size and profile: charts, those coded
// raw, bytes, and a sum over all bytes, which must be the same whatever compiler built this. Ends with 1 where a chart
// did not come back. tools/trial runs it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "api/mesh_encoder.h"
#include "api/mesh_file/mesh_file.h"
#include "ramcdb/error.h"

namespace {

using namespace ramcdb;
using codec::Profile;

chartify::IndexedMesh read_on_lattice(const std::filesystem::path& file, unsigned bits) {
  const mesh_file::MeshData data = mesh_file::read_mesh(file);
  const mesh_file::Triangulation cut = mesh_file::triangulate(data);
  chartify::IndexedMesh mesh;
  if (data.positions.empty()) return mesh;
  Point lo = data.positions.front(), hi = lo;
  for (const Point& p : data.positions)
    for (int a = 0; a < 3; ++a) lo[a] = std::min(lo[a], p[a]), hi[a] = std::max(hi[a], p[a]);
  const double extent = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
  const Lattice lattice{lo, extent > 0 ? extent / static_cast<double>((std::uint64_t{1} << bits) - 1) : 1};
  for (const Point& p : data.positions) mesh.positions.push_back(lattice.snap(p));
  mesh.faces = mesh_file::triangles_of(data, cut);
  return mesh;
}

/// Whether `decoded` is `chart` with its inner vertices and faces in the order that `encoded` says.
bool came_back(const Chart& chart, const codec::EncodedChart& encoded, const Chart& decoded) {
  const auto& vertices = encoded.source_vertex;
  const auto& corners = encoded.source_corner;
  if (decoded.loop_sizes != chart.loop_sizes || decoded.positions.size() != chart.positions.size() ||
      decoded.faces.size() != chart.faces.size() || vertices.size() != chart.positions.size() ||
      corners.size() != chart.faces.size())
    return false;
  std::vector<bool> vertex_seen(vertices.size()), face_seen(corners.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (vertex_seen[vertices[v]] || decoded.positions[v] != chart.positions[vertices[v]]) return false;
    vertex_seen[vertices[v]] = true;
  }
  for (std::size_t f = 0; f < corners.size(); ++f) {
    const std::uint32_t source = corners[f] / 3, first = corners[f] % 3;
    if (face_seen[source]) return false;
    face_seen[source] = true;
    for (std::uint32_t c = 0; c < 3; ++c)
      if (vertices[decoded.faces[f][c]] != chart.faces[source][(first + c) % 3]) return false;
  }
  return true;
}

struct Outcome {
  std::size_t charts = 0, raw = 0, lost = 0, bytes = 0;
  std::uint64_t sum = 0;
};

Outcome try_charts(const chartify::WireNet& net, Profile profile, std::uint64_t vertices, const LatticeBox& range) {
  const codec::CoderTables tables = detail::train_tables(net, profile, vertices);
  Outcome outcome;
  for (const chartify::NetChart& each : net.charts) {
    const Chart& chart = each.chart;
    const codec::EncodedChart encoded = codec::encode_chart(chart, profile, tables, range);
    const std::span border(chart.positions.data(), chart.border_count());
    const codec::DecodedChart decoded = codec::decode_chart(encoded.blob, border, chart.loop_sizes, tables, range);
    ++outcome.charts;
    outcome.raw += encoded.coding == codec::ChartCoding::raw;
    outcome.lost += !came_back(chart, encoded, decoded.chart);
    outcome.bytes += encoded.blob.size();
    for (const std::uint8_t byte : encoded.blob) outcome.sum = outcome.sum * 1000003 + byte;
  }
  return outcome;
}

/// The number of charts that did not come back.
std::size_t try_mesh(const std::filesystem::path& file, unsigned bits, const std::vector<std::uint32_t>& sizes) {
  const chartify::CanonicalMesh canonical = chartify::canonical_order(read_on_lattice(file, bits));
  LatticeBox range;
  for (const LatticePoint p : canonical.mesh.positions) range.add(p);
  std::size_t lost = 0;
  for (const std::uint32_t faces : sizes) {
    chartify::Options options;
    options.target_faces = faces;
    const auto net = chartify::build_wire_net(canonical.mesh, chartify::chartify(canonical.mesh, options));
    for (const Profile profile : {Profile::dense, Profile::fast}) {
      const Outcome outcome = try_charts(net, profile, canonical.mesh.positions.size(), range);
      fmt::print("{} {} bits, {} faces, {}: {} charts, {} raw, {} bytes, sum {:016x}{}\n", file.filename().string(),
                 bits, faces, profile == Profile::dense ? "dense" : "fast", outcome.charts, outcome.raw, outcome.bytes,
                 outcome.sum, outcome.lost ? fmt::format(", {} LOST", outcome.lost) : "");
      lost += outcome.lost;
    }
  }
  return lost;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Codes every chart of meshes in both profiles and looks whether it comes back");
  unsigned bits = 12;
  std::vector<std::uint32_t> sizes{300, 2000, 5000};
  std::vector<std::string> files;
  app.add_option("--bits", bits, "Lattice bits along the largest extent")->check(CLI::Range(1, 29));
  app.add_option("--chart-faces", sizes, "Chart sizes")->delimiter(',');
  app.add_option("FILE", files, "Meshes")->required()->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);
  std::size_t lost = 0;
  for (const std::string& file : files) {
    try {
      lost += try_mesh(file, bits, sizes);
    } catch (const Error& error) {
      fmt::print("{} is not read: {}\n", std::filesystem::path(file).filename().string(), error.what());
    }
    std::fflush(stdout);
  }
  return lost ? 1 : 0;
} catch (const std::exception& error) {
  std::cerr << "ramcdb-chart-trial: " << error.what() << '\n';
  return 2;
}
