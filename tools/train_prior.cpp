// ramcdb-train-prior FILE... >codec/built_in_prior.h
//
// Counts what the dense coder decides on the charts of some meshes, and fits what its adaptive bits start from: per bit
// the probability and the strength under which the counts of all charts are likeliest (a beta-binomial distribution: a
// bit that is alike in all charts starts strong, one that every chart has otherwise starts weak). Bits that were seen
// little lean on their kin: the same bit in other edge sizes, or other face classes. tools/train-prior chooses meshes.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <unordered_map>
#include <vector>

#include "api/mesh_file/mesh_file.h"
#include "chartify/wire_net_builder.h"
#include "codec/chart_codec.h"
#include "codec/dense_coder.h"
#include "codec/dense_guide.h"
#include "codec/dense_training.h"

namespace {

using namespace ramcdb;
using namespace ramcdb::codec;

struct Count {
  double zeros = 0, ones = 0;
};
/// Per built-in bit its counts, one of each chart that it was decided in.
using Counts = std::vector<std::vector<Count>>;
/// Of charts on coarse lattices and on fine ones, which begin otherwise.
using BothCounts = std::array<Counts, 2>;

class CountingCoder {
 public:
  static constexpr bool kEncodes = true;

  void watch(DenseModels& models) {
    models.visit_built_in([&](AdaptiveBit& bit) { number_.emplace(&bit, number_.size()); });
    counts_.resize(number_.size());
  }
  bool code(AdaptiveBit& model, bool bit) {
    if (const auto at = number_.find(&model); at != number_.end())
      ++(bit ? counts_[at->second].ones : counts_[at->second].zeros);
    return bit;
  }
  std::uint32_t code_raw(std::uint32_t value, int /*bits*/) { return value; }
  [[nodiscard]] std::uint64_t position() const { return 0; }
  [[nodiscard]] const std::vector<Count>& counts() const { return counts_; }

 private:
  std::unordered_map<const AdaptiveBit*, std::size_t> number_;
  std::vector<Count> counts_;
};

void count_chart(const Chart& chart, const CoderTables& tables, const LatticeBox& range, BothCounts& both) {
  const std::optional<HalfEdges> edges = HalfEdges::of(chart);
  if (!edges) return;
  DenseContext context;
  context.border = std::span(chart.positions).first(chart.border_count());
  context.loop_sizes = chart.loop_sizes;
  context.counts.inner_vertices = static_cast<std::uint32_t>(chart.positions.size() - context.border.size());
  context.counts.faces = static_cast<std::uint32_t>(chart.faces.size());
  context.expected = context.counts;
  context.edge_exponent = mean_edge_exponent(chart);
  context.box = range;
  context.tables = &tables;
  CountingCoder coder;
  ChartGuide guide(chart, *edges);
  DenseWalk walk(coder, guide, context);
  coder.watch(walk.models());
  walk.run();
  Counts& counts = both[walk.is_fine()];
  counts.resize(coder.counts().size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (coder.counts()[i].zeros + coder.counts()[i].ones > 0) counts[i].push_back(coder.counts()[i]);
}

chartify::IndexedMesh on_lattice(const mesh_file::MeshData& data, unsigned bits) {
  Point lo = data.positions.at(0), hi = lo;
  for (const Point& p : data.positions)
    for (int a = 0; a < 3; ++a) lo[a] = std::min(lo[a], p[a]), hi[a] = std::max(hi[a], p[a]);
  const double extent = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
  const Lattice lattice{lo, extent / ((1U << bits) - 1), 0};
  chartify::IndexedMesh mesh;
  for (const Point& p : data.positions) mesh.positions.push_back(lattice.snap(p));
  mesh.faces = mesh_file::triangulate(data).corners;
  for (Triangle& face : mesh.faces)
    for (std::uint32_t& v : face) v = data.corners[v];
  return chartify::canonical_order(std::move(mesh)).mesh;
}

/// At most so many charts of a mesh, so that large ones do not say it all.
constexpr std::size_t kMostCharts = 16;

void count_mesh(const mesh_file::MeshData& data, unsigned bits, BothCounts& counts) {
  const chartify::IndexedMesh mesh = on_lattice(data, bits);
  const chartify::WireNet net = chartify::build_wire_net(mesh, chartify::chartify(mesh, {}));
  LatticeBox range;
  for (const LatticePoint p : mesh.positions) range.add(p);
  std::vector<const Chart*> charts;
  for (std::size_t c = 0; c < net.charts.size(); c += net.charts.size() / kMostCharts + 1)
    charts.push_back(&net.charts[c].chart);
  const CoderTables tables = train_dense(charts, mesh.positions.size());
  for (const Chart* chart : charts) {
    const auto encoded = encode_chart(*chart, Profile::dense, tables, range);
    constexpr std::uint8_t kAligned = 2;
    if (encoded.coding == ChartCoding::dense && !(encoded.blob[2] & kAligned))
      count_chart(*chart, tables, range, counts);
  }
}

struct Beta {
  double p = 0.5, strength = 1.6;
};

double log_beta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

double likelihood(const std::vector<Count>& counts, const Beta& beta) {
  const double a = beta.p * beta.strength, b = (1 - beta.p) * beta.strength;
  double sum = 0;
  for (const Count& c : counts) sum += log_beta(c.ones + a, c.zeros + b) - log_beta(a, b);
  return sum;
}

/// The likeliest beginning, of the strengths that there are.
Beta fit(const std::vector<Count>& counts) {
  Beta best;
  double most = -1e300;
  for (const std::uint16_t bits : kPriorBits) {
    double lo = -7, hi = 7;  // logit of p, by golden section
    const auto at = [&](double x) { return likelihood(counts, {1 / (1 + std::exp(-x)), bits + 1.6}); };
    constexpr double kGolden = 0.6180339887498949;
    while (hi - lo > 0.01) {
      const double left = hi - kGolden * (hi - lo), right = lo + kGolden * (hi - lo);
      (at(left) > at(right) ? hi : lo) = at(left) > at(right) ? right : left;
    }
    if (const double found = at((lo + hi) / 2); found > most)
      most = found, best = {1 / (1 + std::exp(-(lo + hi) / 2)), bits + 1.6};
  }
  return best;
}

std::uint16_t packed(const Beta& beta) {
  const auto p = std::clamp(std::lround(beta.p * 65536), 48L, 65488L) & 0xfff8;
  const auto strength = std::find_if(kPriorBits.begin(), kPriorBits.end(),
                                     [&](std::uint16_t bits) { return bits + 1.6 >= beta.strength; });
  return static_cast<std::uint16_t>(p | (strength - kPriorBits.begin()));
}

/// Which bits are kin: they lean on each other where little was seen. One number per built-in bit.
std::vector<std::size_t> kin() {
  DenseModels models = DenseModels::built_in(false);
  std::vector<std::size_t> kin;
  std::size_t fan = 0, misses = 0, joins = 0;
  models.fan_size.visit_built_in([&](AdaptiveBit&) { ++fan; });
  models.misses[0].visit_built_in([&](AdaptiveBit&) { ++misses; });
  for (const auto& bits : models.join) joins += bits.size();
  const std::size_t per_angle = fan / 40, per_faces = per_angle / 10;
  for (std::size_t i = 0; i < fan; ++i) kin.push_back(i / per_angle * per_faces + i % per_faces);
  for (std::size_t i = 0; i < joins; ++i) kin.push_back(fan + i);
  for (std::size_t m = 0; m < models.misses.size(); ++m)
    for (std::size_t i = 0; i < misses; ++i) kin.push_back(fan + joins + m / DenseModels::kEdgeSizes * misses + i);
  return kin;
}

std::vector<std::uint16_t> fit_all(const Counts& counts) {
  const std::vector<std::size_t> kin_of = kin();
  std::unordered_map<std::size_t, std::vector<Count>> of_kin;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    auto& all = of_kin[kin_of[i]];
    all.insert(all.end(), counts[i].begin(), counts[i].end());
  }
  std::unordered_map<std::size_t, Beta> kin_beta;
  for (const auto& [number, all] : of_kin)
    if (!all.empty()) kin_beta[number] = fit(all);
  std::vector<std::uint16_t> prior;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::vector<Count> own = counts[i];
    const Beta beta = kin_beta.contains(kin_of[i]) ? kin_beta.at(kin_of[i]) : Beta{};
    constexpr double kLean = 4;
    own.push_back({kLean * (1 - beta.p), kLean * beta.p});
    prior.push_back(packed(counts[i].size() < 2 ? beta : fit(own)));
  }
  return prior;
}

void print(const std::vector<std::uint16_t>& prior) {
  std::string line = "    ";
  fmt::print("    {{\n");
  for (const std::uint16_t x : prior) {
    const std::string next = fmt::format("{},", x);
    if (line.size() + next.size() > 119) {
      fmt::print("{}\n", line);
      line = "    ";
    }
    line += next;
  }
  fmt::print("{}\n    }},\n", line);
}

void print(const BothCounts& counts) {
  fmt::print(R"(#pragma once

#include <array>
#include <cstdint>

/// What the adaptive bits of the dense coder start from, in the order of DenseModels::visit_built_in: probability and
/// strength, as built_in_bit() reads them; for coarse lattices, then for fine ones. Part of the format, never to
/// change. Written by tools/train-prior, which says from what and how.
namespace ramcdb::codec {{

// clang-format off
inline constexpr std::array<std::array<std::uint16_t, {}>, 2> kBuiltInPrior{{{{
)",
             counts[0].size());
  for (const Counts& of_some : counts) print(fit_all(of_some));
  fmt::print("}}}};\n// clang-format on\n\n}}  // namespace ramcdb::codec\n");
}

}  // namespace

int main(int argc, char** argv) try {
  BothCounts counts;
  for (int i = 1; i < argc; ++i) {
    const mesh_file::MeshData data = mesh_file::read_mesh(argv[i]);
    for (const unsigned bits : {11U, 12U, 14U, 16U, 19U}) count_mesh(data, bits, counts);
    std::cerr << argv[i] << '\n';
  }
  if (counts[0].empty() || counts[1].empty())
    throw std::runtime_error("usage: ramcdb-train-prior FILE... >codec/built_in_prior.h");
  print(counts);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "ramcdb-train-prior: " << error.what() << '\n';
  return 1;
}
