// ramcdb-train-prior FILE... >codec/built_in_prior.h
//
// Counts what the dense coder decides on the charts of some meshes, and fits what its models start from: per model the
// shares and the strength under which the counts of all charts are likeliest (a Dirichlet-multinomial distribution: a
// model that is alike in all charts starts strong, one that every chart has otherwise starts weak). Models that were
// seen little lean on their kin: the same one in other activities, or other angles. tools/train-prior chooses meshes.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <numeric>
#include <string>
#include <type_traits>
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

/// How often a bit was zero and one, or a symbol each of sixteen.
using Count = std::array<double, AdaptiveSymbol::kSymbols>;
/// Per built-in model its counts, one of each chart that it decided in.
using Counts = std::vector<std::vector<Count>>;
/// Of charts on coarse lattices and on fine ones, which begin otherwise.
using BothCounts = std::array<Counts, 2>;

class CountingCoder {
 public:
  static constexpr bool kEncodes = true;

  void watch(DenseModels& models) {
    models.visit_built_in([&](auto& model) { number_.emplace(&model, number_.size()); });
    counts_.resize(number_.size());
  }
  bool code(AdaptiveBit& model, bool bit) { return count(&model, bit), bit; }
  std::uint32_t code_symbol(AdaptiveSymbol& model, std::uint32_t symbol) { return count(&model, symbol), symbol; }
  std::uint32_t code_raw(std::uint32_t value, int /*bits*/) { return value; }
  [[nodiscard]] std::uint64_t position() const { return 0; }
  [[nodiscard]] const std::vector<Count>& counts() const { return counts_; }

 private:
  void count(const void* model, std::uint32_t outcome) {
    if (const auto at = number_.find(model); at != number_.end()) ++counts_[at->second][outcome];
  }

  std::unordered_map<const void*, std::size_t> number_;
  std::vector<Count> counts_;
};

double total(const Count& count) { return std::accumulate(count.begin(), count.end(), 0.0); }

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
    if (total(coder.counts()[i]) > 0) counts[i].push_back(coder.counts()[i]);
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

/// What a model begins with: shares of its outcomes, and for how many earlier ones they stand.
struct Beginning {
  Count shares{};
  std::uint16_t earlier = 0;
};

/// Under a Dirichlet distribution of these shares and this strength.
double likelihood(const std::vector<Count>& counts, const Count& shares, double strength) {
  double sum = 0;
  for (const Count& count : counts) {
    sum += std::lgamma(strength) - std::lgamma(strength + total(count));
    for (std::size_t i = 0; i < count.size(); ++i)
      if (count[i] > 0) sum += std::lgamma(shares[i] * strength + count[i]) - std::lgamma(shares[i] * strength);
  }
  return sum;
}

/// Shares nearer to the likeliest ones (T. Minka, "Estimating a Dirichlet distribution"); `kin` has a say, too.
Count improved(const Count& shares, const std::vector<Count>& counts, const Count& kin, double lean, double strength) {
  Count better{};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    better[i] = lean * kin[i];
    const double own = shares[i] * strength;
    for (const Count& count : counts)
      for (double j = 0; j < count[i]; ++j) better[i] += own / (own + j);
  }
  const double sum = total(better);
  for (double& share : better) share /= sum;
  return better;
}

/// The likeliest beginning, of the strengths that there are.
Beginning fit(const std::vector<Count>& counts, const Count& kin, double lean) {
  Beginning best;
  double most = -1e300;
  for (const std::uint16_t earlier : kPriorBits) {
    const double strength = earlier + 1.6;
    Count shares = kin;
    for (int round = 0; round < 12; ++round) shares = improved(shares, counts, kin, lean, strength);
    if (const double found = likelihood(counts, shares, strength); found > most) most = found, best = {shares, earlier};
  }
  return best;
}

std::uint16_t packed_bit(const Beginning& beginning) {
  const auto p = std::clamp(std::lround(beginning.shares[1] * 65536), 48L, 65488L) & 0xfff8;
  const auto strength = std::find(kPriorBits.begin(), kPriorBits.end(), beginning.earlier);
  return static_cast<std::uint16_t>(p | (strength - kPriorBits.begin()));
}

AdaptiveSymbol::Lanes packed_symbol(const Beginning& beginning) {
  constexpr double kLeast = 8, kRest = 65536 - 16 * kLeast;
  AdaptiveSymbol::Lanes lanes{};
  double limit = 0;
  for (std::size_t i = 0; i < 15; ++i) {
    limit += kLeast + std::floor(kRest * beginning.shares[i]);
    lanes[i] = static_cast<std::uint16_t>(limit);
  }
  lanes[15] = beginning.earlier;
  return lanes;
}

/// All built-in models in their order: how many outcomes each has, and which are kin, which lean on each other where
/// little was seen.
struct Kind {
  std::size_t outcomes = 0, kin = 0;
};
std::vector<Kind> kinds() {
  const auto models = std::make_unique<DenseModels>(DenseModels::built_in(false));
  std::vector<Kind> kinds;
  std::size_t fan = 0, bits = 0;
  models->fan_size.visit_built_in([&](AdaptiveBit&) { ++fan; });
  const std::size_t per_angle = fan / 40, per_faces = per_angle / 10;
  const auto add_bit = [&] {
    const std::size_t i = bits++;  // of a fan size's, that in other angles; of joins none
    kinds.push_back({2, i < fan ? i / per_angle * per_faces + i % per_faces : i});
  };
  std::size_t symbols = 0;
  const auto add_symbol = [&] {  // of misses that in other activities
    kinds.push_back({AdaptiveSymbol::kSymbols, (std::size_t{1} << 20) + symbols++ / MissModels::kActivities});
  };
  models->visit_built_in([&](auto& model) {
    if constexpr (std::is_same_v<std::decay_t<decltype(model)>, AdaptiveBit>)
      add_bit();
    else
      add_symbol();
  });
  return kinds;
}

std::vector<Beginning> fit_all(const Counts& counts) {
  const std::vector<Kind> kind_of = kinds();
  std::unordered_map<std::size_t, std::vector<Count>> of_kin;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    auto& all = of_kin[kind_of[i].kin];
    all.insert(all.end(), counts[i].begin(), counts[i].end());
  }
  std::vector<Beginning> beginnings;
  std::unordered_map<std::size_t, Beginning> of_all_kin;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto [number, fresh] = of_all_kin.try_emplace(kind_of[i].kin);
    Beginning& kin = number->second;
    if (fresh) {
      Count even{};
      for (std::size_t k = 0; k < kind_of[i].outcomes; ++k) even[k] = 1 / static_cast<double>(kind_of[i].outcomes);
      kin = fit(of_kin[kind_of[i].kin], even, 1);
    }
    constexpr double kLean = 4;
    beginnings.push_back(counts[i].size() < 2 ? kin : fit(counts[i], kin.shares, kLean));
  }
  return beginnings;
}

void print(const std::vector<std::uint16_t>& numbers) {
  std::string line = "    ";
  for (const std::uint16_t x : numbers) {
    const std::string next = fmt::format("{},", x);
    if (line.size() + next.size() > 119) {
      fmt::print("{}\n", line);
      line = "    ";
    }
    line += next;
  }
  fmt::print("{}\n", line);
}

void print(const std::array<std::vector<Beginning>, 2>& both, std::size_t bits) {
  fmt::print(R"(#pragma once

#include <array>
#include <cstdint>

/// What the models of the dense coder start from, in the order of DenseModels::visit_built_in: probability and strength
/// of bits, as built_in_bit() reads them, and the lanes of AdaptiveSymbols; for coarse lattices, then for fine ones.
/// Part of the format, never to change. Written by tools/train-prior, which says from what and how.
namespace ramcdb::codec {{

// clang-format off
inline constexpr std::array<std::array<std::uint16_t, {}>, 2> kBuiltInBits{{{{
)",
             bits);
  for (const auto& beginnings : both) {
    std::vector<std::uint16_t> numbers;
    for (std::size_t i = 0; i < bits; ++i) numbers.push_back(packed_bit(beginnings[i]));
    fmt::print("    {{\n");
    print(numbers);
    fmt::print("    }},\n");
  }
  fmt::print(
      "}}}};\n\ninline constexpr std::array<std::array<std::array<std::uint16_t, 16>, {}>, 2> kBuiltInSymbols{{{{\n",
      both[0].size() - bits);
  for (const auto& beginnings : both) {
    fmt::print("    {{{{\n");
    for (std::size_t i = bits; i < beginnings.size(); ++i)
      fmt::print("    {{{}}},\n", fmt::join(packed_symbol(beginnings[i]), ","));
    fmt::print("    }}}},\n");
  }
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
  print({fit_all(counts[0]), fit_all(counts[1])}, kBuiltInBits[0].size());
  return 0;
} catch (const std::exception& error) {
  std::cerr << "ramcdb-train-prior: " << error.what() << '\n';
  return 1;
}
