#include "api/recut_encoder.h"

#include <algorithm>

#include "api/layer_encoder.h"
#include "api/recut_comparison.h"
#include "api/recut_surface.h"
#include "api/region_faces.h"
#include "api/store_format.h"
#include "api/surface_pieces.h"
#include "api/topology.h"
#include "chartify/parallel.h"
#include "chartify/wire_net_builder.h"
#include "codec/wire_codec.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

using chartify::NetChart;
using chartify::NetLoopStep;
using chartify::NetWire;

/// A net's wire under its id. The wire may run the other way than the net has it.
struct NamedWire {
  WireId id;
  bool reversed = false;
  bool is_new = true;
};

class RecutEncoder {
 public:
  RecutEncoder(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited,
               const RecutSurface& surface, unsigned threads, EditBuilder& builder)
      : at_(at), region_(region), edited_(edited), surface_(surface), threads_(threads), builder_(builder) {}

  /// A chart beside one that is too small; none when all are as they may be.
  [[nodiscard]] std::optional<ChartId> cut(const std::function<bool(ChartId)>& may_recut) {
    chartify::Options options;
    options.target_faces = at_.record().target_faces;
    options.threads = threads_;
    charts_ = chartify::rechart({surface_.mesh, surface_.chart_of_face, surface_.chart_of_isolated_vertex,
                                 static_cast<std::uint32_t>(surface_.charts.size()), surface_.fixed},
                                options);
    net_ = chartify::build_wire_net(surface_.mesh, charts_.charts, surface_.fixed, surface_.corners);
    return neighbour_of_small_chart(may_recut);
  }

  void encode() {
    name_charts();
    name_corners();
    name_wires();
    drop_old_wires();
    cut_loops_outside();
    prepare_layers();
    encode_charts();
    drop_old_charts();
    count();
  }

 private:
  [[nodiscard]] MeshRecord& record() { return builder_.record(); }
  [[nodiscard]] PageDelta& pages() { return builder_.edit().pages; }

  /// Of a chart below a quarter of the target, the chart outside that shares most of its border.
  [[nodiscard]] std::optional<ChartId> neighbour_of_small_chart(const std::function<bool(ChartId)>& may_recut) const {
    for (const NetChart& chart : net_.charts) {
      if (chart.chart.faces.size() >= at_.record().target_faces / 4) continue;
      std::map<ChartId, std::size_t> shared;
      for (const auto& loop : chart.loops)
        for (const NetLoopStep step : loop) {
          const std::uint32_t fixed = net_.origin[step.wire].fixed;
          if (fixed == chartify::kNone) continue;
          for (const ChartId other : surface_.wires.at(surface_.fixed_ids[fixed]).entry.charts)
            if (!surface_.holds(other) && may_recut(other)) shared[other] += net_.wires[step.wire].vertices.size() - 1;
        }
      const auto longest = std::ranges::max_element(shared, {}, [](const auto& s) { return s.second; });
      if (longest != shared.end()) return longest->first;
    }
    return std::nullopt;
  }

  template <class IdType>
  static IdType take(IdType& next) {
    const IdType id = next;
    if (next.value == ~std::uint32_t{0}) throw Error(Errc::limit_exceeded, "the mesh has no ids left");
    next = IdType(next.value + 1);
    return id;
  }

  void name_charts() {
    for (const std::uint32_t old : charts_.continues)
      chart_id_.push_back(old == chartify::kNone ? take(record().next_chart) : surface_.charts[old]);
  }

  void name_corners() {
    for (const std::uint32_t v : net_.corners) {
      const auto known = surface_.corner_at.find(v);
      corner_id_.push_back(known == surface_.corner_at.end() ? take(record().next_corner) : known->second);
      pages().corners[corner_id_.back()] = surface_.mesh.positions[v];
    }
  }

  // Wires.

  void name_wires() {
    std::map<std::vector<std::uint32_t>, WireId> inner;
    std::vector<WireId> ids;
    for (const auto& [id, wire] : surface_.wires)
      if (surface_.is_inner(wire.entry)) ids.push_back(id);
    std::ranges::sort(ids);
    for (const WireId id : ids)
      if (auto path = surface_.path_of(surface_.wires.at(id).entry); !path.empty()) inner.emplace(std::move(path), id);
    for (std::uint32_t w = 0; w < net_.wires.size(); ++w) {
      wire_.push_back(net_.origin[w].fixed == chartify::kNone ? name_inner(net_.wires[w], inner) : name_fixed(w));
      put_wire(w);
    }
  }

  NamedWire name_inner(const NetWire& wire, std::map<std::vector<std::uint32_t>, WireId>& known) {
    std::vector<std::uint32_t> path = wire.vertices;
    for (const bool reversed : {false, true}) {
      if (const auto it = known.find(path); it != known.end()) {
        const WireId id = it->second;
        known.erase(it);
        return {id, reversed, false};
      }
      std::ranges::reverse(path);
    }
    return {take(record().next_wire)};
  }

  NamedWire name_fixed(std::uint32_t w) {
    const auto [fixed, first] = net_.origin[w];
    if (net_.wires[w].vertices.size() == surface_.fixed[fixed].vertices.size())
      return {surface_.fixed_ids[fixed], false, false};
    const NamedWire named{take(record().next_wire)};
    parts_[surface_.fixed_ids[fixed]].emplace(first, named.id);
    return named;
  }

  void put_wire(std::uint32_t w) {
    const NetWire& wire = net_.wires[w];
    const NamedWire& named = wire_[w];
    PageWire entry;
    if (!named.is_new) entry = surface_.wires.at(named.id).entry;
    entry.id = named.id;
    entry.begin = corner_id_[named.reversed ? wire.end_corner : wire.begin_corner];
    entry.end = corner_id_[named.reversed ? wire.begin_corner : wire.end_corner];
    entry.inner_points = static_cast<std::uint32_t>(wire.vertices.size() - 2);
    entry.charts.clear();
    for (const std::uint32_t chart : wire.charts) entry.charts.push_back(chart_id_[chart]);
    if (const std::uint32_t fixed = net_.origin[w].fixed; fixed != chartify::kNone)
      for (const ChartId other : surface_.wires.at(surface_.fixed_ids[fixed]).entry.charts)
        if (!surface_.holds(other)) {
          entry.charts.push_back(other);
          pages().neighbours.insert(other);
        }
    std::ranges::sort(entry.charts);
    Wire points;
    for (const std::uint32_t v : wire.vertices) points.points.push_back(surface_.mesh.positions[v]);
    if (named.reversed) std::ranges::reverse(points.points);
    if (named.is_new) {
      builder_.add_wire(entry, std::move(points), 0);
      ++record().wires;
    } else if (const LoadedWire& before = surface_.wires.at(named.id); before.wire == points) {
      pages().wires[entry.id] = std::move(entry);
    } else {
      builder_.add_wire(entry, std::move(points), before.blob_bytes);
    }
  }

  void drop_old_wires() {
    std::set<WireId> kept;
    for (const NamedWire& named : wire_)
      if (!named.is_new) kept.insert(named.id);
    for (const auto& [id, wire] : surface_.wires) {
      if (kept.contains(id)) continue;
      record().wire_bytes -= wire.blob_bytes;
      --record().wires;
    }
  }

  /// Charts outside pass the parts of wires that were cut.
  void cut_loops_outside() {
    std::set<ChartId> outside;
    for (const auto& [id, parts] : parts_)
      for (const ChartId chart : surface_.wires.at(id).entry.charts)
        if (!surface_.holds(chart)) outside.insert(chart);
    for (const ChartId id : outside) {
      auto put = pages().charts.find(id);
      if (put == pages().charts.end())
        put = pages().charts.emplace(id, *find_chart(*at_.pages().leaf_of(id)->leaf, id)).first;
      for (WireLoop& loop : put->second.loops) loop = with_parts(loop);
    }
  }

  [[nodiscard]] WireLoop with_parts(const WireLoop& loop) const {
    WireLoop cut;
    for (const DirectedWire step : loop) {
      const auto found = parts_.find(step.wire);
      if (found == parts_.end()) {
        cut.push_back(step);
        continue;
      }
      const std::size_t first = cut.size();
      for (const auto& [place, id] : found->second) cut.push_back({id, step.reversed});
      if (step.reversed) std::reverse(cut.begin() + static_cast<std::ptrdiff_t>(first), cut.end());
    }
    return cut;
  }

  // Charts.

  /// Layers are coded from the mesh as a file would have it: polygons whole, their corners one after another.
  void prepare_layers() {
    table_ = at_.layers();
    const bool has_polygons = !edited_.mesh.polygon_sizes.empty();
    if (has_polygons && !table_.polygons()) add_polygon_layer();
    faces_.emplace(edited_.mesh, !has_polygons);
    for (const Attribute& attribute : edited_.mesh.attributes) attributes_.push_back(faces_->for_file(attribute));
    file_corner_ = faces_->file_corners();
    file_face_ = faces_->file_faces();
  }

  /// A mesh of triangles gets its first polygons.
  void add_polygon_layer() {
    const int id = table_.layers.empty() ? 1 : table_.layers.back().id + 1;
    if (at_.record().layers) record().table_bytes -= encode_layer_table(table_).size() + kBlobOverhead;
    table_.layers.push_back(polygon_layer(static_cast<std::uint16_t>(id)));
    Buffer blob = encode_layer_table(table_);
    record().table_bytes += blob.size() + kBlobOverhead;
    builder_.add_blob(db::Kind::attribute, 0, std::move(blob));
    builder_.edit().new_layer_table = true;
  }

  [[nodiscard]] LayerPlaces places_of(const NetChart& chart, const codec::EncodedChart& encoded) const {
    LayerPlaces places;
    for (const std::uint32_t v : encoded.source_vertex)
      places.vertices.push_back(surface_.vertex[chart.mesh_vertex[v]]);
    for (const std::uint32_t corner : encoded.source_corner) {
      const std::uint32_t face = surface_.face[chart.mesh_face[corner / 3]];
      places.faces.push_back(file_face_[face]);
      for (std::uint32_t i = 0; i < 3; ++i) places.corners.push_back(file_corner_[3 * face + (corner + i) % 3]);
    }
    return places;
  }

  /// A chart as the wires around it now name it.
  [[nodiscard]] PageChart entry_of(std::uint32_t c) const {
    const NetChart& chart = net_.charts[c];
    PageChart entry;
    entry.id = chart_id_[c];
    entry.table = at_.record().table;
    entry.faces = static_cast<std::uint32_t>(chart.chart.faces.size());
    entry.inner_vertices = static_cast<std::uint32_t>(chart.chart.positions.size()) - chart.chart.border_count();
    for (const LatticePoint p : chart.chart.positions) entry.box.add(p);
    for (const auto& steps : chart.loops) {
      WireLoop& loop = entry.loops.emplace_back();
      for (const NetLoopStep step : steps)
        loop.push_back({wire_[step.wire].id, step.reversed != wire_[step.wire].reversed});
    }
    entry.pieces = pieces_of(chart.chart);
    return entry;
  }

  struct Coded {
    PageChart entry;
    codec::EncodedChart encoded;
    std::vector<LayerBlob> layers;
    bool same = false;
  };

  void encode_charts() {
    std::vector<Coded> coded(net_.charts.size());
    const ChartCoder coder = coder_of(at_);
    const RecutComparison comparison(region_, edited_, surface_, net_);
    const LayerEncoder layers(table_, at_.record(), attributes_, edited_.mesh.exact);
    parallel_for(coded.size(), threads_, [&](std::size_t i) {
      const auto c = static_cast<std::uint32_t>(i);
      coded[i].entry = entry_of(c);
      if (charts_.continues[c] != chartify::kNone) {
        coded[i].same = comparison.keep(surface_.loaded[charts_.continues[c]], net_.charts[c], coded[i].entry);
        if (coded[i].same) return;
      }
      coded[i].encoded = codec::encode_chart(net_.charts[i].chart, coder.profile, coder.tables, at_.record().range);
      if (!layers.empty())
        coded[i].layers = layers.encode(places_of(net_.charts[i], coded[i].encoded), coded[i].encoded);
      for (const LayerBlob& layer : coded[i].layers) coded[i].entry.layers.push_back({layer.layer, {}});
    });
    for (std::uint32_t c = 0; c < coded.size(); ++c) put_chart(c, std::move(coded[c]));
  }

  void put_chart(std::uint32_t c, Coded coded) {
    const ChartId id = chart_id_[c];
    const bool continues = charts_.continues[c] != chartify::kNone;
    if (!continues) pages().beside[id] = near_chart(c);
    pages().charts[id] = coded.entry;
    if (coded.same) return;
    EncodedEdit& edit = builder_.edit();
    edit.changed.push_back(id);
    ++edit.charts_reencoded;
    if (!continues) edit.added.push_back(id);
    edit.ranges_expanded += coded.encoded.expanded_range;
    edit.layers_reencoded += coded.layers.size();
    add_cost(coded.encoded.cost);
    builder_.add_blob(db::Kind::chart, id.value, std::move(coded.encoded.blob));
    for (LayerBlob& layer : coded.layers) {
      record().bytes_of_layer(layer.layer) += layer.bytes.size() + kBlobOverhead;
      builder_.add_blob(db::Kind::attribute, id.value, std::move(layer.bytes), layer.layer);
    }
    if (continues) subtract(surface_.loaded[charts_.continues[c]]);
  }

  void add_cost(const codec::ChartCost& cost) {
    record().chart_cost.header += cost.header;
    record().chart_cost.connectivity += cost.connectivity;
    record().chart_cost.geometry += cost.geometry;
  }

  void subtract(const LoadedChart& chart) {
    record().chart_cost.header -= chart.cost.header;
    record().chart_cost.connectivity -= chart.cost.connectivity;
    record().chart_cost.geometry -= chart.cost.geometry;
    for (const auto& [layer, bytes] : chart.layer_bytes) record().bytes_of_layer(layer) -= bytes;
  }

  /// The old chart in whose page a new one goes: that most of its faces come from, else the closest.
  [[nodiscard]] ChartId near_chart(std::uint32_t c) const {
    std::map<std::uint32_t, std::size_t> faces;
    for (const std::uint32_t f : net_.charts[c].mesh_face)
      if (surface_.chart_of_face[f] != chartify::kNone) ++faces[surface_.chart_of_face[f]];
    const auto most = std::ranges::max_element(faces, {}, [](const auto& count) { return count.second; });
    if (most != faces.end()) return surface_.charts[most->first];
    const LatticeBox box = entry_of(c).box;
    const auto distance = [&](const LoadedChart& chart) {
      double sum = 0;
      for (int a = 0; a < 3; ++a) {
        const double apart = double(box.lo[a]) + box.hi[a] - chart.entry.box.lo[a] - chart.entry.box.hi[a];
        sum += apart * apart;
      }
      return sum;
    };
    return std::ranges::min_element(surface_.loaded, {}, distance)->entry.id;
  }

  void drop_old_charts() {
    std::set<ChartId> continued(chart_id_.begin(), chart_id_.end());
    for (const LoadedChart& old : surface_.loaded) {
      if (continued.contains(old.entry.id)) continue;
      subtract(old);
      pages().removed.insert(old.entry.id);
      builder_.edit().changed.push_back(old.entry.id);
    }
    record().charts += net_.charts.size();
    record().charts -= surface_.loaded.size();
  }

  // Totals.

  static std::uint64_t polygons_in(const RegionMesh& mesh) {
    return static_cast<std::uint64_t>(std::ranges::count_if(mesh.polygon_sizes, [](auto size) { return size > 3; }));
  }

  void count() {
    MeshRecord& r = record();
    r.vertices += surface_.mesh.positions.size() - surface_.before.positions.size();
    for (const CornerId id : surface_.shared_corners)  // vertices that other charts still have
      r.vertices += !surface_.vertex_of_key.contains(VertexKey{VertexKey::Where::corner, id.value, 0}.packed());
    r.faces += surface_.mesh.faces.size() - surface_.before.faces.size();
    r.polygons += polygons_in(edited_.mesh) - polygons_in(region_);
    std::set<CornerId> before, after(corner_id_.begin(), corner_id_.end());
    for (const auto& [id, wire] : surface_.wires) before.insert({wire.entry.begin, wire.entry.end});
    for (const CornerId id : after) r.corners += !before.contains(id);
    for (const CornerId id : before) r.corners -= !after.contains(id) && !surface_.shared_corners.contains(id);
    const Topology was = analyze(surface_.around_before), is = analyze(surface_.around);
    r.nonmanifold_edges += is.nonmanifold_edges - was.nonmanifold_edges;
    r.nonmanifold_vertices += is.nonmanifold_vertices - was.nonmanifold_vertices;
    r.inconsistent_edges += is.inconsistent_edges - was.inconsistent_edges;
    r.degenerate_faces += is.degenerate_faces - was.degenerate_faces;
    r.duplicate_faces += is.duplicate_faces - was.duplicate_faces;
    r.isolated_vertices += is.isolated_vertices - was.isolated_vertices;
  }

  const Snapshot::Impl& at_;
  const RegionMesh& region_;
  const EditedRegion& edited_;
  const RecutSurface& surface_;
  unsigned threads_;
  EditBuilder& builder_;
  chartify::Recharted charts_;
  chartify::WireNet net_;
  std::vector<ChartId> chart_id_;
  std::vector<CornerId> corner_id_;
  std::vector<NamedWire> wire_;
  std::map<WireId, std::map<std::uint32_t, WireId>> parts_;  ///< of wires that are cut, by where they begin
  LayerTable table_;
  std::optional<RegionFaces> faces_;
  std::vector<Attribute> attributes_;
  std::vector<std::uint32_t> file_corner_, file_face_;
};

}  // namespace

std::optional<ChartId> encode_recut(const Snapshot::Impl& at, const RegionMesh& region, const EditedRegion& edited,
                                    const ChangeSet& changes, const std::function<bool(ChartId)>& may_recut,
                                    unsigned threads, EditBuilder& builder) {
  const RecutSurface surface = recut_surface(at, region, edited, changes, threads);
  RecutEncoder encoder(at, region, edited, surface, threads, builder);
  if (const std::optional<ChartId> neighbour = encoder.cut(may_recut)) return neighbour;
  encoder.encode();
  return std::nullopt;
}

}  // namespace ramcdb::detail
