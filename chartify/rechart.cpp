#include "chartify/rechart.h"

#include <algorithm>
#include <string>

#include "chartify/chart_sizes.h"
#include "chartify/face_moves.h"
#include "chartify/growth.h"
#include "chartify/packing.h"
#include "chartify/polygons.h"
#include "chartify/rebalance.h"
#include "chartify/recut.h"
#include "chartify/regrowth.h"
#include "chartify/small_components.h"
#include "chartify/straighten.h"
#include "chartify/succession.h"
#include "ramcdb/error.h"

namespace ramcdb::chartify {
namespace {

constexpr int kGrowthIterations = 5;
constexpr int kBorderRounds = 2;

void require_consistent(const Rechart& in) {
  if (in.chart_of_face.size() != in.mesh.faces.size())
    throw Error(Errc::invalid_argument, "old charts of another number of faces", "rechart");
  if (in.chart_of_isolated_vertex.size() != isolated_vertices(in.mesh).size())
    throw Error(Errc::invalid_argument, "old charts of another number of isolated vertices", "rechart");
  for (const auto& charts : {in.chart_of_face, in.chart_of_isolated_vertex})
    for (const std::uint32_t c : charts)
      if (c != kNone && c >= in.old_charts)
        throw Error(Errc::invalid_argument, "old chart " + std::to_string(c), "rechart",
                    "there are " + std::to_string(in.old_charts));
}

/// The mesh in canonical order with all that comes with it, and its adjacency between the fixed wires.
struct OrderedMesh {
  OrderedMesh(const Rechart& in, std::uint32_t target) {
    CanonicalMesh canonical = canonical_order(in.mesh);
    mesh = std::move(canonical.mesh);
    source_face = std::move(canonical.source_face);
    source_vertex = std::move(canonical.source_vertex);
    for (const std::uint32_t f : source_face) {
      old_of_face.push_back(in.chart_of_face[f]);
      if (!in.mesh.polygon_of_face.empty()) mesh.polygon_of_face.push_back(in.mesh.polygon_of_face[f]);
    }
    const EdgeGroups edges = group_half_edges(mesh);
    const FixedEdges fixed(mesh, edges, renamed(in.fixed));
    twins = find_twins(mesh, edges);
    for (HalfEdge h = 0; h < twins.size(); ++h)
      if (fixed.contains(edges.edge_of[h])) separate(h);
    neighbours = find_neighbours(twins);
    components = find_components(neighbours, target);
    is_anchored.assign(components.sizes.size(), 0);
    for (HalfEdge h = 0; h < twins.size(); ++h)
      if (fixed.contains(edges.edge_of[h])) is_anchored[components.region_of_face[face_of(h)]] = 1;
  }

  IndexedMesh mesh;
  std::vector<std::uint32_t> source_face, source_vertex, old_of_face;
  std::vector<HalfEdge> twins;
  Neighbours neighbours;
  Regions components;
  std::vector<std::uint8_t> is_anchored;  ///< per component: it has an edge on a fixed wire

 private:
  [[nodiscard]] std::vector<FixedWire> renamed(std::span<const FixedWire> wires) const {
    std::vector<std::uint32_t> to(source_vertex.size());
    for (std::uint32_t v = 0; v < to.size(); ++v) to[source_vertex[v]] = v;
    std::vector<FixedWire> out(wires.begin(), wires.end());
    for (FixedWire& wire : out)
      for (std::uint32_t& v : wire.vertices) v = to[v];
    return out;
  }

  void separate(HalfEdge h) {
    const HalfEdge twin = twins[h];
    if (twin == kNoTwin) return;
    const std::vector<std::uint32_t>& polygon = mesh.polygon_of_face;
    if (!polygon.empty() && polygon[face_of(h)] == polygon[face_of(twin)]) return;
    twins[h] = twins[twin] = kNoTwin;
  }
};

class Recharter {
 public:
  Recharter(const Rechart& in, const Options& options)
      : in_(in),
        ordered_(in, options.target_faces),
        cut_{ordered_.mesh, ordered_.neighbours, ordered_.components, options.target_faces, {}} {
    for (std::uint32_t c = 0; c < in.old_charts; ++c) (void)cut_.add_chart();
    for (const std::uint32_t c : ordered_.old_of_face)
      if (c != kNone) ++cut_.partition.sizes[c];
    labels() = ordered_.old_of_face;
  }

  Recharted run() {
    grow_into_new_faces(cut_.neighbours, cut_.target, cut_.partition);
    cut_new_components();
    settle_pieces();
    keep_sizes(cut_, small_);
    refine();
    keep_sizes(cut_, small_);
    place_small_components(cut_, small_);
    keep_polygons_whole(ordered_.mesh.polygon_of_face, cut_.partition);
    return finish();
  }

 private:
  struct Piece {
    std::uint32_t chart = kNone, first_face = kNone, becomes = kNone;
    bool is_component = false;
    bool is_stray = false;  ///< joins a neighbour
  };

  [[nodiscard]] std::vector<std::uint32_t>& labels() { return cut_.partition.chart_of_face; }

  /// Components that touch nothing old: large ones are cut as chartify() does, small ones wait.
  void cut_new_components() {
    Regions regions = cut_.components;
    std::vector<std::uint8_t> seen(regions.sizes.size(), 0);
    for (std::uint32_t f = 0; f < labels().size(); ++f) {
      const std::uint32_t component = cut_.components.region_of_face[f];
      std::uint32_t& charts = regions.charts[component];
      if (labels()[f] != kNone) regions.region_of_face[f] = kNone;
      if (seen[component]) continue;
      seen[component] = 1;
      if (labels()[f] != kNone)
        charts = 0;
      else if (rides(component))
        small_.push_back({component, f, kNone});
      else
        charts = std::max(charts, 1U);
    }
    if (std::ranges::count(regions.charts, 0U) == static_cast<std::ptrdiff_t>(regions.charts.size())) return;
    const Partition grown = grow_charts(cut_.mesh, cut_.neighbours, regions, kGrowthIterations, nullptr);
    const auto offset = static_cast<std::uint32_t>(cut_.partition.sizes.size());
    for (const std::uint32_t size : grown.sizes) cut_.partition.sizes[cut_.add_chart()] = size;
    for (std::size_t f = 0; f < labels().size(); ++f)
      if (grown.chart_of_face[f] != kNone) labels()[f] = offset + grown.chart_of_face[f];
  }

  /// Whether a component shares a chart with others. One between fixed wires is part of something larger.
  [[nodiscard]] bool rides(std::uint32_t component) const {
    const std::uint64_t size = cut_.components.sizes[component];
    return 2 * size < cut_.target && (!ordered_.is_anchored[component] || cut_.is_small(size));
  }

  /// What an edit cut in pieces: the largest keeps the chart, small components stay aboard, other large pieces become
  /// charts, and other small ones join their neighbours.
  void settle_pieces() {
    const Pieces pieces = find_pieces(cut_.neighbours, labels());
    std::vector<Piece> list = list_pieces(pieces);
    for (std::uint32_t p = 0; p < list.size(); ++p) {
      Piece& piece = list[p];
      if (piece.becomes != kNone || piece.chart == kNone) continue;
      const std::uint32_t component = cut_.components.region_of_face[piece.first_face];
      if (piece.is_component && rides(component)) {
        small_.push_back({component, piece.first_face, piece.chart});
      } else if (piece.is_component || !cut_.is_small(pieces.sizes[p])) {
        piece.becomes = cut_.add_chart();
        cut_.partition.sizes[piece.chart] -= pieces.sizes[p];
        cut_.partition.sizes[piece.becomes] = pieces.sizes[p];
      } else {
        piece.is_stray = true;
        piece.becomes = piece.chart;
      }
    }
    settle_strays_alone(pieces, list);
    for (std::size_t f = 0; f < labels().size(); ++f) labels()[f] = list[pieces.piece_of_face[f]].becomes;
    const std::vector<std::uint32_t> before = labels();
    merge_pieces(cut_.neighbours, cut_.partition);
    is_new_.resize(before.size());
    for (std::size_t f = 0; f < before.size(); ++f)
      is_new_[f] = ordered_.old_of_face[f] == kNone || labels()[f] != before[f];
  }

  /// Where strays have only each other, as where new faces join small parts of far charts, the largest makes the chart.
  void settle_strays_alone(const Pieces& pieces, std::vector<Piece>& list) {
    std::vector<std::uint32_t> first(cut_.components.sizes.size(), kNone);  // the largest, as long as all are strays
    std::vector<std::uint8_t> has_home(first.size(), 0);
    const auto component_of = [&](const Piece& p) { return cut_.components.region_of_face[p.first_face]; };
    for (std::uint32_t p = 0; p < list.size(); ++p) {
      std::uint32_t& best = first[component_of(list[p])];
      if (!list[p].is_stray) has_home[component_of(list[p])] = 1;
      if (best == kNone || pieces.sizes[p] > pieces.sizes[best]) best = p;
    }
    for (std::uint32_t p = 0; p < list.size(); ++p) {
      Piece& piece = list[p];
      const std::uint32_t component = component_of(piece);
      if (has_home[component]) continue;
      const bool boards = rides(component);
      if (!boards && first[component] != p) continue;
      cut_.partition.sizes[piece.chart] -= pieces.sizes[p];
      const std::uint32_t aboard = list[first[component]].chart;
      piece.becomes = boards ? kNone : cut_.add_chart();
      cut_.partition.sizes[boards ? aboard : piece.becomes] += pieces.sizes[p];
      if (boards && first[component] == p) small_.push_back({component, piece.first_face, aboard});
    }
  }

  /// In each chart the piece that keeps it becomes it: the largest, components only if there is no other.
  [[nodiscard]] std::vector<Piece> list_pieces(const Pieces& pieces) {
    std::vector<Piece> list(pieces.sizes.size());
    std::vector<std::uint32_t> main(cut_.partition.sizes.size(), kNone);
    for (std::uint32_t f = 0; f < labels().size(); ++f) {
      const std::uint32_t p = pieces.piece_of_face[f];
      if (list[p].first_face != kNone) continue;
      list[p].first_face = f;
      if (labels()[f] == kNone) continue;
      const bool is_component = pieces.sizes[p] == cut_.components.sizes[cut_.components.region_of_face[f]];
      list[p] = {labels()[f], f, kNone, is_component};
      std::uint32_t& best = main[labels()[f]];
      if (best == kNone ||
          std::pair(!is_component, pieces.sizes[p]) > std::pair(!list[best].is_component, pieces.sizes[best]))
        best = p;
    }
    for (std::uint32_t c = 0; c < main.size(); ++c)
      if (main[c] != kNone) list[main[c]].becomes = c;
    return list;
  }

  /// Improves the borders that this run made.
  void refine() {
    MoveRules rules{labels(), cut_.group, cut_.open};
    for (std::size_t f = 0; f < labels().size(); ++f) {
      if (labels()[f] == kNone) continue;
      rules.home_of_face[f] = is_new_[f] ? kNone : cut_.group[labels()[f]];
      if (is_new_[f]) rules.open[labels()[f]] = 1;
    }
    if (!has_border_to_move(rules)) return;
    const SizeLimits limits(cut_.target);
    FaceMover mover(ordered_.twins, limits, cut_.partition, &rules);
    rebalance(mover, limits, static_cast<std::uint32_t>(cut_.partition.sizes.size()));
    const BorderStraightener straightener(ordered_.mesh, ordered_.twins);
    for (int round = 0; round < kBorderRounds; ++round) {
      move_faces(mover);
      straightener.run(limits, cut_.partition, &rules);
    }
    merge_pieces(cut_.neighbours, cut_.partition);
  }

  [[nodiscard]] bool has_border_to_move(const MoveRules& rules) {
    for (std::size_t e = 0; e < cut_.neighbours.size(); ++e) {
      if (cut_.neighbours[e] == kNone) continue;
      const std::uint32_t other = labels()[cut_.neighbours[e]];
      if (labels()[e / 3] != other && rules.allow(static_cast<std::uint32_t>(e / 3), other)) return true;
    }
    return false;
  }

  Recharted finish() {
    const std::vector<std::uint32_t> isolated = isolated_vertices(ordered_.mesh);
    std::vector<std::uint32_t> old_of_isolated = old_charts_of(isolated);
    Succession heirs(ordered_.old_of_face, labels(), in_.old_charts);
    const std::vector<std::uint32_t> wished = heirs.wishes(old_of_isolated, cut_);
    const std::vector<std::uint32_t> chart_of_isolated =
        place_isolated_vertices(ordered_.mesh, cut_.target, cut_.partition, wished);
    const Numbering numbering = heirs.number(labels(), old_of_isolated, chart_of_isolated);
    Recharted out;
    out.continues = numbering.continues;
    out.charts.chart_count = static_cast<std::uint32_t>(numbering.continues.size());
    out.charts.chart_of_face.resize(labels().size());
    for (std::size_t f = 0; f < labels().size(); ++f)
      out.charts.chart_of_face[ordered_.source_face[f]] = numbering.number_of_chart[labels()[f]];
    std::vector<std::uint32_t> of_vertex(ordered_.source_vertex.size(), kNone);
    for (std::size_t i = 0; i < isolated.size(); ++i)
      of_vertex[ordered_.source_vertex[isolated[i]]] = numbering.number_of_chart[chart_of_isolated[i]];
    std::ranges::copy_if(of_vertex, std::back_inserter(out.charts.chart_of_isolated_vertex),
                         [](std::uint32_t c) { return c != kNone; });
    return out;
  }

  /// Of the isolated vertices of the ordered mesh.
  [[nodiscard]] std::vector<std::uint32_t> old_charts_of(const std::vector<std::uint32_t>& isolated) const {
    std::vector<std::uint32_t> of_vertex(ordered_.source_vertex.size(), kNone), out;
    const std::vector<std::uint32_t> given = isolated_vertices(in_.mesh);
    for (std::size_t i = 0; i < given.size(); ++i) of_vertex[given[i]] = in_.chart_of_isolated_vertex[i];
    for (const std::uint32_t v : isolated) out.push_back(of_vertex[ordered_.source_vertex[v]]);
    return out;
  }

  const Rechart& in_;
  OrderedMesh ordered_;
  Recut cut_;
  std::vector<SmallComponent> small_;
  std::vector<std::uint8_t> is_new_;  ///< per face, or moved here by settle_pieces()
};

}  // namespace

Recharted rechart(const Rechart& in, const Options& options) {
  require_target(options);
  require_consistent(in);
  Recharted out = Recharter(in, options).run();
  report(options.progress, 1);
  return out;
}

std::vector<std::uint32_t> faces_kept(const Rechart& in, const Recharted& out) {
  std::vector<std::uint32_t> kept(out.continues.size(), 0);
  for (std::size_t f = 0; f < in.chart_of_face.size(); ++f) {
    const std::uint32_t chart = out.charts.chart_of_face[f];
    if (in.chart_of_face[f] == kNone || in.chart_of_face[f] != out.continues[chart])
      kept[chart] = kNone;
    else if (kept[chart] != kNone)
      ++kept[chart];
  }
  return kept;
}

}  // namespace ramcdb::chartify
