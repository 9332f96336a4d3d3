#include "chartify/partition.h"

#include <algorithm>
#include <map>
#include <string>

#include "ramcdb/error.h"

namespace ramcdb::chartify {

Neighbours find_neighbours(const std::vector<HalfEdge>& twins) {
  Neighbours neighbours = twins;
  for (std::uint32_t& n : neighbours)
    if (n != kNoTwin) n = face_of(n);
  return neighbours;
}

namespace {

/// Floods faces over edges that `joined` lets pass; pieces are numbered by their first faces.
template <class Joined>
Pieces flood_pieces(const Neighbours& neighbours, Joined&& joined) {
  Pieces out;
  const std::size_t faces = neighbours.size() / 3;
  out.piece_of_face.assign(faces, kNone);
  std::vector<std::uint32_t> open;
  for (std::uint32_t seed = 0; seed < faces; ++seed) {
    if (out.piece_of_face[seed] != kNone) continue;
    const auto piece = static_cast<std::uint32_t>(out.sizes.size());
    out.sizes.push_back(0);
    out.piece_of_face[seed] = piece;
    for (open.assign(1, seed); !open.empty();) {
      const std::uint32_t f = open.back();
      open.pop_back();
      ++out.sizes[piece];
      for (std::size_t e = 3 * std::size_t{f}; e < 3 * std::size_t{f} + 3; ++e) {
        const std::uint32_t g = neighbours[e];
        if (g == kNone || out.piece_of_face[g] != kNone || !joined(f, g)) continue;
        out.piece_of_face[g] = piece;
        open.push_back(g);
      }
    }
  }
  return out;
}

/// The pieces that are not the largest of their chart, the smallest first.
std::vector<std::uint32_t> stray_pieces(const Pieces& pieces, const std::vector<std::uint32_t>& chart_of_piece,
                                        std::size_t charts) {
  std::vector<std::uint32_t> largest(charts, kNone), strays;
  for (std::uint32_t p = 0; p < pieces.sizes.size(); ++p) {
    if (chart_of_piece[p] == kNone) continue;
    std::uint32_t& best = largest[chart_of_piece[p]];
    if (best == kNone || pieces.sizes[p] > pieces.sizes[best]) best = p;
  }
  for (std::uint32_t p = 0; p < pieces.sizes.size(); ++p)
    if (chart_of_piece[p] != kNone && largest[chart_of_piece[p]] != p) strays.push_back(p);
  std::stable_sort(strays.begin(), strays.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return pieces.sizes[a] < pieces.sizes[b]; });
  return strays;
}

/// Of the charts around a piece's faces the one with most edges to them, not counting faces of pieces that wait; ties
/// to the smaller chart, then to the lower number.
std::uint32_t closest_chart(const Neighbours& neighbours, const Partition& partition, const Pieces& pieces,
                            const std::vector<std::uint8_t>& waits, const std::vector<std::uint32_t>& faces) {
  std::map<std::uint32_t, std::uint32_t> edges;
  for (const std::uint32_t f : faces)
    for (std::size_t e = 3 * std::size_t{f}; e < 3 * std::size_t{f} + 3; ++e)
      if (neighbours[e] != kNone && !waits[pieces.piece_of_face[neighbours[e]]])
        ++edges[partition.chart_of_face[neighbours[e]]];
  std::uint32_t best = kNone;
  for (const auto& [chart, count] : edges)
    if (best == kNone || count > edges[best] ||
        (count == edges[best] && partition.sizes[chart] < partition.sizes[best]))
      best = chart;
  return best;
}

}  // namespace

Regions find_components(const Neighbours& neighbours, std::uint32_t target) {
  Pieces pieces = flood_pieces(neighbours, [](std::uint32_t, std::uint32_t) { return true; });
  Regions out{std::move(pieces.piece_of_face), std::move(pieces.sizes), {}};
  for (const std::uint64_t size : out.sizes)
    out.charts.push_back(2 * size < target ? 0 : static_cast<std::uint32_t>((2 * size + target) / (2ULL * target)));
  return out;
}

Pieces find_pieces(const Neighbours& neighbours, const std::vector<std::uint32_t>& chart_of_face) {
  return flood_pieces(neighbours,
                      [&](std::uint32_t f, std::uint32_t g) { return chart_of_face[f] == chart_of_face[g]; });
}

void require_target(const Options& options) {
  if (options.target_faces == 0 || options.target_faces > kMostTargetFaces)
    throw Error(Errc::invalid_argument, "charts of " + std::to_string(options.target_faces) + " faces", "chartify",
                "aim at 1 to " + std::to_string(kMostTargetFaces) + " faces");
}

void merge_pieces(const Neighbours& neighbours, Partition& partition) {
  const std::vector<std::uint32_t>& chart_of_face = partition.chart_of_face;
  const Pieces pieces = find_pieces(neighbours, chart_of_face);
  std::vector<std::uint32_t> chart_of_piece(pieces.sizes.size());
  std::vector<std::vector<std::uint32_t>> faces(pieces.sizes.size());
  for (std::uint32_t f = 0; f < chart_of_face.size(); ++f) chart_of_piece[pieces.piece_of_face[f]] = chart_of_face[f];
  const std::vector<std::uint32_t> strays = stray_pieces(pieces, chart_of_piece, partition.sizes.size());
  if (strays.empty()) return;
  std::vector<std::uint8_t> waits(pieces.sizes.size(), 0);
  for (const std::uint32_t p : strays) waits[p] = 1;
  for (std::uint32_t f = 0; f < chart_of_face.size(); ++f)
    if (waits[pieces.piece_of_face[f]]) faces[pieces.piece_of_face[f]].push_back(f);
  for (bool any = true; any;) {  // strays among strays wait until one beside them has joined
    any = false;
    for (const std::uint32_t p : strays) {
      if (!waits[p]) continue;
      const std::uint32_t to = closest_chart(neighbours, partition, pieces, waits, faces[p]);
      if (to == kNone) continue;
      partition.sizes[chart_of_face[faces[p].front()]] -= pieces.sizes[p];
      partition.sizes[to] += pieces.sizes[p];
      for (const std::uint32_t f : faces[p]) partition.chart_of_face[f] = to;
      waits[p] = 0;
      any = true;
    }
  }
}

void renumber(Partition& partition) {
  std::vector<std::uint32_t> to(partition.sizes.size(), kNone);
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t& chart : partition.chart_of_face) {
    if (chart == kNone) continue;
    if (to[chart] == kNone) {
      to[chart] = static_cast<std::uint32_t>(sizes.size());
      sizes.push_back(0);
    }
    chart = to[chart];
    ++sizes[chart];
  }
  partition.sizes = std::move(sizes);
}

}  // namespace ramcdb::chartify
