#include "tools/benchmark/coder_bench.h"

#include <stdexcept>
#include <vector>

#include "chartify/wire_net_builder.h"
#include "codec/chart_codec.h"
#include "ramcdb/repository.h"
#include "tools/benchmark/draco_peer.h"
#include "tools/benchmark/timing.h"

namespace ramcdb::benchmark {
namespace {

/// The mesh as the repository holds it: lattice points and faces.
chartify::IndexedMesh read_back(const Snapshot& snapshot) {
  RegionMesh region = snapshot.read(snapshot.find({.shapes = {WholeMesh{}}}));
  return {std::move(region.points), std::move(region.faces)};
}

struct CodedCharts {
  codec::CoderTables tables;
  LatticeBox range;
  std::vector<chartify::NetChart> charts;
  std::vector<Buffer> blobs;

  void encode() {
    blobs.clear();
    for (const auto& net_chart : charts)
      blobs.push_back(codec::encode_chart(net_chart.chart, codec::Profile::dense, tables, range).blob);
  }

  void decode() const {
    for (std::size_t c = 0; c < charts.size(); ++c) {
      const Chart& chart = charts[c].chart;
      const std::span border(chart.positions.data(), chart.border_count());
      const auto decoded = codec::decode_chart(blobs[c], border, chart.loop_sizes, tables, range);
      if (decoded.chart.faces.size() != chart.faces.size()) throw std::logic_error("a chart lost faces");
    }
  }
};

class DracoRun {
 public:
  DracoRun(const DracoMesh& mesh, int level) : mesh_(mesh), level_(level) {}

  void round() {
    encode_.push_back(seconds([&] { bytes_ = mesh_.encode(level_); }));
    decode_.push_back(seconds([&] { faces_ = draco_decode(bytes_); }));
  }
  [[nodiscard]] CoderFigures::Peer figures(double faces) const {
    return {bytes_.size(), faces_, faces / median(encode_), faces / median(decode_)};
  }

 private:
  const DracoMesh& mesh_;
  int level_;
  std::vector<char> bytes_;
  std::size_t faces_ = 0;
  std::vector<double> encode_, decode_;
};

}  // namespace

CoderFigures measure_coder(const std::filesystem::path& file, const std::filesystem::path& scratch, unsigned bits,
                           unsigned rounds) {
  Repository::create(scratch);
  auto repository = Repository::open(scratch);
  ImportOptions options;
  options.bits = bits;
  CoderFigures figures;
  figures.info = repository.import(file, options).info;
  figures.mesh = figures.info.mesh;

  const auto canonical = chartify::canonical_order(read_back(repository.snapshot()));
  const chartify::IndexedMesh& mesh = canonical.mesh;
  chartify::Charts cut;
  const auto faces = static_cast<double>(mesh.faces.size());
  figures.cut = faces / seconds([&] { cut = chartify::chartify(mesh, {}); });
  CodedCharts ours;
  ours.charts = chartify::build_wire_net(mesh, cut).charts;
  for (const LatticePoint p : mesh.positions) ours.range.add(p);

  const DracoMesh peer(mesh);
  DracoRun draco10(peer, 10), draco7(peer, 7);
  std::vector<double> encode, decode;
  for (unsigned round = 0; round < rounds; ++round) {
    encode.push_back(seconds([&] { ours.encode(); }));
    decode.push_back(seconds([&] { ours.decode(); }));
    draco10.round();
    draco7.round();
  }
  figures.encode = faces / median(encode);
  figures.decode = faces / median(decode);
  figures.draco10 = draco10.figures(faces);
  figures.draco7 = draco7.figures(faces);
  return figures;
}

}  // namespace ramcdb::benchmark
