#include "tools/benchmark/coder_bench.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>

#include "chartify/wire_net_builder.h"
#include "codec/chart_codec.h"
#include "codec/dense_training.h"
#include "codec/fast_training.h"
#include "ramcdb/repository.h"
#include "tools/benchmark/peer.h"
#include "tools/benchmark/timing.h"

namespace ramcdb::benchmark {
namespace {

struct ProfileName {
  codec::Profile profile;
  ChartProfile wanted;
  const char* name;
};
constexpr std::array<ProfileName, 2> kProfiles{
    {{codec::Profile::dense, ChartProfile::dense, "dense"}, {codec::Profile::fast, ChartProfile::fast, "fast"}}};

/// The mesh as the repository holds it: lattice points and faces.
chartify::IndexedMesh read_back(const Snapshot& snapshot) {
  RegionMesh region = snapshot.read(snapshot.find({.shapes = {WholeMesh{}}}));
  return {std::move(region.points), std::move(region.faces)};
}

/// Charts in one of our profiles.
class OurCharts {
 public:
  OurCharts(const std::vector<chartify::NetChart>& charts, codec::Profile profile, const LatticeBox& range,
            std::uint64_t vertices)
      : charts_(charts), profile_(profile), range_(range), on_wires_(vertices), blobs_(charts.size()) {
    for (const auto& chart : charts) on_wires_ -= chart.chart.positions.size() - chart.chart.border_count();
    if (profile == codec::Profile::dense) {
      std::vector<const Chart*> all;
      for (const auto& chart : charts) all.push_back(&chart.chart);
      tables_ = codec::train_dense(all, vertices);
    } else {
      codec::FastTrainer trainer(tables_.fast);
      for (const auto& chart : charts) trainer.add(chart.chart);
      tables_.fast = trainer.learn();
    }
  }

  void encode() {
    for (std::size_t c = 0; c < charts_.size(); ++c) {
      codec::EncodedChart encoded = codec::encode_chart(charts_[c].chart, profile_, tables_, range_);
      blobs_[c] = std::move(encoded.blob);
    }
  }

  [[nodiscard]] CameBack decode(unsigned threads = 1) const {
    std::atomic<std::size_t> next{0}, faces{0}, inner{0};
    const auto work = [&] {
      for (std::size_t c = next++; c < charts_.size(); c = next++) {
        const Chart chart = decode_chart(c).chart;
        faces += chart.faces.size();
        inner += chart.positions.size() - chart.border_count();
      }
    };
    std::vector<std::jthread> others;
    for (unsigned t = 1; t < threads; ++t) others.emplace_back(work);
    work();
    others.clear();
    return {faces, on_wires_ + inner};
  }

  [[nodiscard]] Contestant sizes(const std::string& name, const MeshInfo& info) const {
    Contestant result;
    result.name = name;
    for (std::size_t c = 0; c < charts_.size(); ++c) {
      const codec::ChartCost cost = decode_chart(c).cost;
      result.connectivity += cost.connectivity;
      result.geometry += cost.geometry;
      result.bytes += blobs_[c].size() + kBlobOverhead;
    }
    result.connectivity /= 2048;
    result.geometry /= 2048;
    result.index = result.bytes - result.connectivity - result.geometry + info.bytes.wire_net + info.bytes.tables;
    result.wires = info.bytes.wires;
    result.bytes = result.connectivity + result.geometry + result.index + result.wires;
    return result;
  }

 private:
  [[nodiscard]] codec::DecodedChart decode_chart(std::size_t c) const {
    const Chart& chart = charts_[c].chart;
    const std::span border(chart.positions.data(), chart.border_count());
    return codec::decode_chart(blobs_[c], border, chart.loop_sizes, tables_, range_);
  }

  const std::vector<chartify::NetChart>& charts_;
  codec::Profile profile_;
  LatticeBox range_;
  std::uint64_t on_wires_;  ///< vertices that charts share
  codec::CoderTables tables_;
  std::vector<Buffer> blobs_;
};

/// What a contestant does in a round, and how long it took.
struct Turn {
  std::function<void()> encode, decode, decode_all;  ///< the last may be missing
  std::vector<double> encode_seconds{}, decode_seconds{}, decode_all_seconds{};

  void take() {
    encode_seconds.push_back(seconds(encode));
    decode_seconds.push_back(seconds(decode));
    if (decode_all) decode_all_seconds.push_back(seconds(decode_all));
  }
};

/// A mesh cut into charts of some size, in a repository of its own for each profile.
struct CutMesh {
  std::array<MeshInfo, 2> info;  ///< by profile
  chartify::IndexedMesh mesh;
  std::vector<chartify::NetChart> charts;
  LatticeBox range;

  CutMesh(const std::filesystem::path& file, const std::filesystem::path& folder, unsigned bits, std::uint32_t faces) {
    for (std::size_t p = 0; p < kProfiles.size(); ++p) {
      const auto place = folder / kProfiles[p].name;
      std::filesystem::create_directories(place);
      Repository::create(place);
      auto repository = Repository::open(place);
      ImportOptions options;
      options.bits = bits;
      options.chart_faces = faces;
      options.profile = kProfiles[p].wanted;
      info[p] = repository.import(file, options).info;
      if (p == 0) mesh = chartify::canonical_order(read_back(repository.snapshot())).mesh;
    }
    chartify::Options cut;
    cut.target_faces = faces;
    charts = chartify::build_wire_net(mesh, chartify::chartify(mesh, cut)).charts;
    for (const LatticePoint p : mesh.positions) range.add(p);
  }
};

/// A chart from the middle of the mesh, each time through a repository that is opened for it.
void measure_access(const std::filesystem::path& folder, CoderFigures& figures, unsigned rounds) {
  std::vector<double> times;
  for (unsigned round = 0; round < rounds; ++round)
    times.push_back(seconds([&] {
      const auto repository = Repository::open(folder);
      const Snapshot snapshot = repository.snapshot();
      ReadCost cost;
      const auto charts = static_cast<std::uint32_t>(snapshot.info().charts);
      (void)snapshot.read({ChartId(1 + (charts / 2 + round) % charts)}, 1, &cost);
      figures.chart_bytes = static_cast<double>(cost.bytes);
      figures.chart_blobs = static_cast<double>(cost.blobs);
    }));
  figures.chart_seconds = median(times);
}

}  // namespace

const Contestant& CoderFigures::find(const std::string& name) const {
  for (const Contestant& contestant : contestants)
    if (contestant.name == name) return contestant;
  throw std::logic_error("no contestant " + name);
}

CoderFigures measure_coder(const std::filesystem::path& file, const std::filesystem::path& scratch,
                           const CoderOptions& options) {
  CoderFigures figures;
  std::vector<std::unique_ptr<CutMesh>> cuts;
  std::vector<std::unique_ptr<OurCharts>> ours;
  std::vector<std::unique_ptr<Peer>> peers;
  std::vector<Buffer> peer_bytes(8);
  std::vector<Turn> turns;
  std::vector<CameBack> all_back(32);
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  for (const std::uint32_t faces : options.chart_faces) {
    cuts.push_back(std::make_unique<CutMesh>(file, scratch / std::to_string(faces), options.bits, faces));
    const CutMesh& cut = *cuts.back();
    for (std::size_t p = 0; p < kProfiles.size(); ++p) {
      const ProfileName& profile = kProfiles[p];
      OurCharts& charts = *ours.emplace_back(
          std::make_unique<OurCharts>(cut.charts, profile.profile, cut.range, cut.mesh.positions.size()));
      charts.encode();
      figures.contestants.push_back(charts.sizes(fmt::format("{}, {}", profile.name, faces), cut.info[p]));
      CameBack& back = all_back[turns.size()];
      turns.push_back({[&charts] { charts.encode(); }, [&charts, &back] { back = charts.decode(); },
                       [&charts, cores] { (void)charts.decode(cores); }});
    }
  }
  const chartify::IndexedMesh& mesh = cuts.front()->mesh;
  for (const int level : {10, 7, 5}) peers.push_back(draco_peer(mesh, level));
  for (const auto& make : {meshopt_peer, openctm_peer, raw_peer}) peers.push_back(make(mesh));
  for (std::size_t p = 0; p < peers.size(); ++p) {
    Buffer& bytes = peer_bytes[p];
    bytes = peers[p]->encode();
    figures.contestants.push_back({.name = peers[p]->name(), .bytes = bytes.size(), .back = {}});
    CameBack& back = all_back[turns.size()];
    turns.push_back({[&peer = *peers[p], &bytes] { bytes = peer.encode(); },
                     [&peer = *peers[p], &bytes, &back] { back = peer.decode(bytes); },
                     {}});
  }

  for (unsigned round = 0; round < options.rounds; ++round)
    for (Turn& turn : turns) turn.take();
  figures.mesh = cuts.front()->info.front().mesh;
  figures.vertices = mesh.positions.size();
  figures.faces = mesh.faces.size();
  const auto faces = static_cast<double>(figures.faces);
  for (std::size_t t = 0; t < turns.size(); ++t) {
    Contestant& contestant = figures.contestants[t];
    contestant.back = all_back[t];
    contestant.encode = faces / median(turns[t].encode_seconds);
    contestant.decode = faces / median(turns[t].decode_seconds);
    if (turns[t].decode_all) contestant.decode_all = faces / median(turns[t].decode_all_seconds);
  }
  measure_access(scratch / std::to_string(options.chart_faces.front()) / kProfiles[0].name, figures, options.rounds);
  return figures;
}

}  // namespace ramcdb::benchmark
