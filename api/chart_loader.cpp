#include "api/chart_loader.h"

#include <fmt/format.h>

#include <map>

#include "api/store_format.h"
#include "chartify/parallel.h"
#include "codec/exact_codec.h"
#include "codec/wire_codec.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

/// Blobs read in one LMDB transaction before it is renewed.
constexpr std::size_t kBatch = 256;

std::string place(const Snapshot::Impl& at, const PageChart& chart) {
  return fmt::format("chart {} of mesh {}, written by version {}", chart.id.value, at.root().name, chart.version.value);
}

/// Every triangle a polygon of its own.
codec::Polygons only_triangles(std::size_t faces) {
  codec::Polygons polygons;
  polygons.sizes.assign(faces, 3);
  for (std::uint32_t f = 0; f < faces; ++f) polygons.of_face.push_back(f);
  for (std::uint32_t c = 0; c < 3 * faces; ++c) polygons.corners.push_back(c);
  return polygons;
}

}  // namespace

struct ChartLoader::Job {
  PageChart entry;
  Buffer blob;
  bool with_layers = false;
  std::map<std::uint16_t, Buffer> layers;
};

Border border_of(const std::vector<WireLoop>& loops, const std::function<const LoadedWire&(WireId)>& wire) {
  Border border;
  for (const WireLoop& loop : loops) {
    const std::size_t loop_begin = border.points.size();
    for (const DirectedWire step : loop) {
      const LoadedWire& w = wire(step.wire);
      const auto& points = w.wire.points;
      const auto inner = static_cast<std::uint32_t>(points.size() - 2);
      border.points.push_back(step.reversed ? points.back() : points.front());
      const CornerId first = step.reversed ? w.entry.end : w.entry.begin;
      border.keys.push_back({VertexKey::Where::corner, first.value, 0});
      for (std::uint32_t i = 0; i < inner; ++i) {
        const std::uint32_t index = step.reversed ? inner - 1 - i : i;
        border.points.push_back(points[index + 1]);
        border.keys.push_back({VertexKey::Where::wire, w.entry.id.value, index});
      }
    }
    border.loop_sizes.push_back(static_cast<std::uint32_t>(border.points.size() - loop_begin));
  }
  return border;
}

const ChartLoader::Group& ChartLoader::group_of(const PageWire& entry, db::BlobReader& reader) {
  const std::pair key(entry.group, entry.version);
  auto found = groups_.find(key);
  if (found == groups_.end()) {
    const Buffer blob = reader.get({db::Kind::wire, at_.root().mesh, entry.group.value, entry.version, 0});
    found = groups_.emplace(key, Group{codec::WireGroup(blob), blob.size() + kBlobOverhead}).first;
  }
  return found->second;
}

void ChartLoader::read_wires(const LeafPage& leaf, const PageChart& chart, db::BlobReader& reader) {
  for (const WireLoop& loop : chart.loops) {
    for (const DirectedWire step : loop) {
      if (wires_.contains(step.wire)) continue;
      const PageWire& entry = *find_wire(leaf, step.wire);
      const LatticePoint begin = find_corner(leaf, entry.begin)->position;
      const LatticePoint end = find_corner(leaf, entry.end)->position;
      LoadedWire loaded{entry, {{begin, end}}, 0};
      if (entry.inner_points) {
        const Group& group = group_of(entry, reader);
        loaded.blob_bytes = group.wires.share_of(entry.id, group.bytes);
        loaded.wire = group.wires.wire(entry.id, begin, end, entry.inner_points);
      }
      wires_.emplace(step.wire, std::move(loaded));
    }
  }
}

LoadedChart ChartLoader::decode(const Job& job) const {
  Border border = border_of(job.entry.loops, [&](WireId id) -> const LoadedWire& { return wires_.at(id); });
  codec::DecodedChart decoded;
  try {
    decoded = codec::decode_chart(job.blob, border.points, border.loop_sizes, at_.tables(job.entry.table),
                                  at_.record().range);
  } catch (const Error& e) {
    throw Error(e.code(), fmt::format("{}: {}", place(at_, job.entry), e.what()), {}, "run `ramcdb verify`");
  }
  LoadedChart loaded;
  loaded.entry = job.entry;
  loaded.chart = std::move(decoded.chart);
  loaded.keys = std::move(border.keys);
  loaded.cost = decoded.cost;
  loaded.blob_bytes = job.blob.size() + kBlobOverhead;
  const std::size_t inner = loaded.chart.positions.size() - loaded.keys.size();
  if (inner != job.entry.inner_vertices || loaded.chart.faces.size() != job.entry.faces)
    throw Error(Errc::corrupt, "the chart's counts are not those of its index page", place(at_, job.entry),
                "run `ramcdb verify`");
  for (std::uint32_t i = 0; i < inner; ++i) loaded.keys.push_back({VertexKey::Where::chart, job.entry.id.value, i});
  for (const auto& [layer, blob] : job.layers) loaded.layer_bytes.emplace(layer, blob.size() + kBlobOverhead);
  try {
    if (at_.record().exact) decode_exact(job, loaded);
    if (job.with_layers) decode_layers(job, loaded);
  } catch (const Error& e) {
    throw Error(e.code(), fmt::format("{}: {}", place(at_, job.entry), e.what()), {}, "run `ramcdb verify`");
  }
  return loaded;
}

/// Exact positions belong to the geometry; the other layers are read when they are asked for.
void ChartLoader::read_layers(Job& job, db::BlobReader& reader) const {
  for (const LayerRef& ref : job.entry.layers)
    if (job.with_layers || (at_.record().exact && ref.layer == kExactLayer))
      job.layers.emplace(
          ref.layer, reader.get({db::Kind::attribute, at_.root().mesh, job.entry.id.value, ref.version, ref.layer}));
}

void ChartLoader::decode_exact(const Job& job, LoadedChart& loaded) const {
  const auto blob = job.layers.find(kExactLayer);
  if (blob == job.layers.end()) throw Error(Errc::corrupt, "the chart has no exact positions");
  const MeshRecord& record = at_.record();
  loaded.exact = codec::decode_exact(blob->second, loaded.chart.positions, record.lattice, *record.exact);
}

void ChartLoader::decode_layers(const Job& job, LoadedChart& loaded) const {
  const auto& layers = at_.layers().layers;
  if (layers.empty()) return;
  std::size_t known = at_.record().exact.has_value();
  if (at_.layers().polygons()) loaded.polygons = only_triangles(loaded.chart.faces.size());
  const codec::LayerOrder order(loaded.chart);
  loaded.layers.resize(layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const auto blob = job.layers.find(layers[i].id);
    known += blob != job.layers.end();
    if (layers[i].coding == LayerCoding::polygons) {
      if (blob != job.layers.end()) loaded.polygons = codec::decode_polygons(blob->second, loaded.chart, order);
    } else if (blob != job.layers.end()) {
      loaded.layers[i] = codec::decode_layer(blob->second, layers[i].shape(), loaded.chart, order);
    } else {
      throw Error(Errc::corrupt, fmt::format("the chart has no values of '{}'", layers[i].info.name));
    }
  }
  if (known != job.layers.size()) throw Error(Errc::corrupt, "the chart has a layer that the mesh does not know");
}

std::vector<LoadedChart> ChartLoader::load(std::span<const ChartId> charts, unsigned threads, ReadCost* cost,
                                           bool with_layers) {
  const auto reader = at_.store().reader();
  std::vector<Job> jobs;
  jobs.reserve(charts.size());
  for (const ChartId id : charts) {
    const auto leaf = at_.pages().leaf_of(id, cost);
    if (!leaf)
      throw Error(Errc::not_found, fmt::format("there is no chart {}", id.value),
                  fmt::format("mesh {}, version {}", at_.root().name, at_.version().value),
                  "`ramcdb charts REPO --all` lists them");
    if (jobs.size() % kBatch == kBatch - 1) reader->renew();
    const PageChart& entry = *find_chart(*leaf->leaf, id);
    read_wires(*leaf->leaf, entry, *reader);
    jobs.push_back(
        {entry, reader->get({db::Kind::chart, at_.root().mesh, id.value, entry.version, 0}), with_layers, {}});
    read_layers(jobs.back(), *reader);
  }
  if (cost) {
    cost->blobs += reader->blobs_read();
    cost->bytes += reader->bytes_read();
  }
  std::vector<LoadedChart> loaded(jobs.size());
  parallel_for(jobs.size(), threads, [&](std::size_t i) { loaded[i] = decode(jobs[i]); });
  return loaded;
}

}  // namespace ramcdb::detail
