#include "codec/polygon_codec.h"

#include <xxhash.h>

#include <algorithm>
#include <array>

#include "codec/range_coder.h"
#include "codec/varint.h"

namespace ramcdb::codec {

// polygons = format:1 check:fixed32 stream
// check    = the lower half of XXH3-64 over all sizes, then all corners of the polygons as decoded, each as 4 bytes
// stream   = joined:bit*  count listed*
//            joined: for each face in order, for its edges from the one it was entered through on: whether the edge
//            joins it to the face behind, where that is visited later
// listed   = faces  (face - face before)*  (corner)*
//            faces and corners by when they are visited; a corner is 3 * visit + its distance from the entry

namespace {

constexpr std::uint8_t kPolygonFormat = 1;
constexpr std::uint32_t kNone = LayerOrder::kNone;

struct Listed {
  std::vector<std::uint32_t> faces, corners;
};

/// What a stream says.
struct Joins {
  std::vector<bool> joined;  ///< per corner: the edge from it to the next one is a diagonal
  std::vector<Listed> listed;
};

class JoinCoder {
 public:
  JoinCoder(const Chart& chart, const LayerOrder& order) : order_(order), diagonals_(chart.faces.size(), 0) {}

  template <class Coder>
  void code(Coder& coder, Joins& joins) {
    for (std::uint32_t visit = 0; visit < order_.entries().size(); ++visit) {
      const std::uint32_t entry = order_.entries()[visit];
      std::uint32_t left = 0;
      std::array<std::uint32_t, 3> open{};
      for (const std::uint32_t c : {entry, LayerOrder::next(entry), LayerOrder::prev(entry)})
        if (const std::uint32_t t = order_.twin(c); t != kNone && order_.visit_of(t / 3) > visit) open[left++] = c;
      for (std::uint32_t i = 0; i < left; ++i) code_edge(coder, joins, open[i], left - i);
    }
    code_listed(coder, joins);
  }

 private:
  template <class Coder>
  void code_edge(Coder& coder, Joins& joins, std::uint32_t c, std::uint32_t left) {
    const std::uint32_t t = order_.twin(c);
    std::uint32_t &here = diagonals_[c / 3], &there = diagonals_[t / 3];
    AdaptiveBit& model = joined_[(std::min(here, 2U) * 3 + std::min(there, 2U)) * 4 + left];
    const bool joined = coder.code(model, Coder::kEncodes && joins.joined[c]);
    joins.joined[c] = joins.joined[t] = joined;
    here += joined;
    there += joined;
  }

  template <class Coder>
  void code_listed(Coder& coder, Joins& joins) {
    const auto faces = static_cast<std::uint32_t>(diagonals_.size());
    const std::uint32_t count = count_.code(coder, static_cast<std::uint32_t>(joins.listed.size()));
    if (count > faces) refuse();
    joins.listed.resize(count);
    std::uint32_t left = faces;
    for (Listed& polygon : joins.listed) {
      const std::uint32_t size = size_.code(coder, static_cast<std::uint32_t>(polygon.faces.size()));
      if (size < 1 || size > left) refuse();
      left -= size;
      polygon.faces.resize(size);
      polygon.corners.resize(std::size_t{size} + 2);
      std::uint32_t before = 0;
      for (std::uint32_t& face : polygon.faces) {
        const std::uint32_t visit = Coder::kEncodes ? order_.visit_of(face) : 0;
        const std::int64_t step = face_.code(coder, static_cast<std::int32_t>(visit - before));
        if (before + step < 0 || before + step >= faces) refuse();
        before = static_cast<std::uint32_t>(before + step);
        face = order_.entries()[before] / 3;
      }
      for (std::uint32_t& corner : polygon.corners) code_corner(coder, corner, before, faces);
    }
  }

  template <class Coder>
  void code_corner(Coder& coder, std::uint32_t& corner, std::uint32_t& before, std::uint32_t faces) {
    std::uint32_t visit = 0, turn = 0;
    if (Coder::kEncodes) {
      visit = order_.visit_of(corner / 3);
      turn = (corner + 3 - order_.entries()[visit] % 3) % 3;
    }
    const std::int64_t step = face_.code(coder, static_cast<std::int32_t>(visit - before));
    if (before + step < 0 || before + step >= faces) refuse();
    before = static_cast<std::uint32_t>(before + step);
    turn = coder.code_raw(turn, 2);
    if (turn > 2) refuse();
    const std::uint32_t entry = order_.entries()[before];
    corner = 3 * (entry / 3) + (entry + turn) % 3;
  }

  [[noreturn]] static void refuse() { throw Error(Errc::corrupt, "a polygon blob names faces that its chart has not"); }

  const LayerOrder& order_;
  std::vector<std::uint32_t> diagonals_;
  std::array<AdaptiveBit, 36> joined_;
  AdaptiveUnsigned count_, size_;
  AdaptiveSigned face_;
};

/// The faces that joined edges connect with `first`, and the walk around them. False unless they are a tree: a disk
/// with no vertex inside.
bool trace(const LayerOrder& order, const std::vector<bool>& joined, std::uint32_t first,
           std::vector<std::uint32_t>& faces, std::vector<std::uint32_t>& around) {
  faces.assign(1, first / 3);
  around.clear();
  std::size_t joins = 0;
  std::uint32_t begin = first;
  while (joined[begin]) {  // a corner whose edge is an outer one
    begin = LayerOrder::next(order.twin(begin));
    if (begin == first) return false;
  }
  std::uint32_t c = begin;
  do {
    if (joined[c]) {
      c = LayerOrder::next(order.twin(c));
      if (++joins > joined.size()) return false;
      faces.push_back(c / 3);
      continue;
    }
    around.push_back(c);
    c = LayerOrder::next(c);
  } while (c != begin);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return joins == 2 * (faces.size() - 1) && around.size() == faces.size() + 2;
}

class PolygonBuilder {
 public:
  explicit PolygonBuilder(std::size_t faces) { polygons_.of_face.assign(faces, kNone); }

  /// False when a face has a polygon already.
  bool add(const std::vector<std::uint32_t>& faces, const std::vector<std::uint32_t>& corners) {
    for (const std::uint32_t face : faces) {
      if (polygons_.of_face[face] != kNone) return false;
      polygons_.of_face[face] = static_cast<std::uint32_t>(polygons_.sizes.size());
    }
    polygons_.sizes.push_back(static_cast<std::uint32_t>(corners.size()));
    polygons_.corners.insert(polygons_.corners.end(), corners.begin(), corners.end());
    return true;
  }
  [[nodiscard]] bool has(std::uint32_t face) const { return polygons_.of_face[face] != kNone; }
  [[nodiscard]] Polygons take() { return std::move(polygons_); }

 private:
  Polygons polygons_;
};

/// Polygons in the order of their first faces. Throws corrupt when joins and lists contradict each other.
Polygons polygons_of(const Joins& joins, const Chart& chart, const LayerOrder& order) {
  const auto refuse = [] { throw Error(Errc::corrupt, "a polygon blob joins faces to what is no polygon"); };
  PolygonBuilder builder(chart.faces.size());
  std::vector<std::uint32_t> listed_at(chart.faces.size(), kNone);
  for (std::uint32_t i = 0; i < joins.listed.size(); ++i)
    for (const std::uint32_t face : joins.listed[i].faces) {
      if (listed_at[face] != kNone) refuse();
      listed_at[face] = i;
      for (std::uint32_t c = 3 * face; c < 3 * face + 3; ++c)
        if (joins.joined[c]) refuse();
    }
  std::vector<std::uint32_t> faces, around;
  for (const std::uint32_t entry : order.entries()) {
    if (builder.has(entry / 3)) continue;
    if (const std::uint32_t i = listed_at[entry / 3]; i != kNone) {
      if (!builder.add(joins.listed[i].faces, joins.listed[i].corners)) refuse();
    } else if (!trace(order, joins.joined, entry, faces, around) || !builder.add(faces, around)) {
      refuse();
    }
  }
  return builder.take();
}

bool same_cycle(const Chart& chart, std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  if (a.size() != b.size()) return false;
  const auto vertex = [&](std::uint32_t c) { return chart.faces[c / 3][c % 3]; };
  for (std::size_t turn = 0; turn < a.size(); ++turn) {
    std::size_t i = 0;
    while (i < a.size() && vertex(a[i]) == vertex(b[(i + turn) % b.size()])) ++i;
    if (i == a.size()) return true;
  }
  return false;
}

/// Polygons as joins; those that joins cannot say are listed.
class JoinFinder {
 public:
  JoinFinder(const Polygons& polygons, const Chart& chart, const LayerOrder& order)
      : polygons_(polygons), chart_(chart), order_(order), first_corner_(polygons.sizes.size() + 1, 0) {
    joins_.joined.assign(3 * chart.faces.size(), false);
    for (std::size_t p = 0; p < polygons.sizes.size(); ++p) first_corner_[p + 1] = first_corner_[p] + polygons.sizes[p];
  }

  Joins run() {
    for (std::uint32_t c = 0; c < joins_.joined.size(); ++c)
      if (const std::uint32_t t = order_.twin(c); t != kNone)
        joins_.joined[c] = polygons_.of_face[c / 3] == polygons_.of_face[t / 3];
    std::vector<bool> done(polygons_.sizes.size(), false);
    std::vector<std::uint32_t> faces, around;
    for (const std::uint32_t entry : order_.entries()) {
      const std::uint32_t p = polygons_.of_face[entry / 3];
      if (done[p]) continue;
      done[p] = true;
      const auto corners = corners_of(p);
      if (!trace(order_, joins_.joined, entry, faces, around) || !same_cycle(chart_, around, corners)) list(p);
    }
    return std::move(joins_);
  }

 private:
  [[nodiscard]] std::span<const std::uint32_t> corners_of(std::uint32_t p) const {
    return std::span(polygons_.corners).subspan(first_corner_[p], polygons_.sizes[p]);
  }

  void list(std::uint32_t p) {
    if (faces_of_.empty()) {
      faces_of_.resize(polygons_.sizes.size());
      for (const std::uint32_t entry : order_.entries()) faces_of_[polygons_.of_face[entry / 3]].push_back(entry / 3);
    }
    Listed polygon;
    polygon.faces = faces_of_[p];
    const auto corners = corners_of(p);
    polygon.corners.assign(corners.begin(), corners.end());
    for (const std::uint32_t face : polygon.faces)
      for (std::uint32_t c = 3 * face; c < 3 * face + 3; ++c) joins_.joined[c] = false;
    joins_.listed.push_back(std::move(polygon));
  }

  const Polygons& polygons_;
  const Chart& chart_;
  const LayerOrder& order_;
  std::vector<std::size_t> first_corner_;
  std::vector<std::vector<std::uint32_t>> faces_of_;
  Joins joins_;
};

void require_polygons(const Polygons& polygons, const Chart& chart) {
  std::vector<std::uint32_t> faces(polygons.sizes.size(), 0);
  bool good = polygons.of_face.size() == chart.faces.size();
  for (std::size_t f = 0; good && f < polygons.of_face.size(); ++f) {
    good = polygons.of_face[f] < faces.size();
    if (good) ++faces[polygons.of_face[f]];
  }
  std::size_t corner = 0;
  for (std::size_t p = 0; good && p < faces.size(); ++p) {
    good = polygons.sizes[p] == faces[p] + 2 && faces[p] > 0 && corner + polygons.sizes[p] <= polygons.corners.size();
    for (std::size_t i = 0; good && i < polygons.sizes[p]; ++i)
      good = polygons.corners[corner + i] < 3 * chart.faces.size() &&
             polygons.of_face[polygons.corners[corner + i] / 3] == p;
    corner += polygons.sizes[p];
  }
  if (!good || corner != polygons.corners.size())
    throw Error(Errc::invalid_argument, "these are not the polygons of the chart");
}

std::uint32_t check_of(const Polygons& polygons, const LayerOrder& order) {
  Buffer bytes;
  for (const std::uint32_t size : polygons.sizes) put_fixed32(bytes, size);
  for (const std::uint32_t corner : polygons.corners) {
    const std::uint32_t visit = order.visit_of(corner / 3);
    put_fixed32(bytes, 3 * visit + (corner + 3 - order.entries()[visit] % 3) % 3);
  }
  return static_cast<std::uint32_t>(XXH3_64bits(bytes.data(), bytes.size()));
}

}  // namespace

Buffer encode_polygons(const Polygons& polygons, const Chart& chart, const LayerOrder& order) {
  require_polygons(polygons, chart);
  Joins joins = JoinFinder(polygons, chart, order).run();
  RangeEncoder coder;
  JoinCoder(chart, order).code(coder, joins);
  const Polygons decoded = polygons_of(joins, chart, order);
  Buffer blob{kPolygonFormat};
  put_fixed32(blob, check_of(decoded, order));
  const Buffer stream = coder.finish();
  blob.insert(blob.end(), stream.begin(), stream.end());
  if (decode_polygons(blob, chart, order) != decoded)
    throw Error(Errc::invalid_argument, "polygons cannot be coded", {}, "report this: it is a bug");
  return blob;
}

Polygons decode_polygons(Bytes blob, const Chart& chart, const LayerOrder& order) {
  ByteReader reader(blob, "polygon blob");
  if (reader.byte() != kPolygonFormat) reader.fail("has an unknown format");
  const std::uint32_t check = reader.fixed32();
  Joins joins;
  joins.joined.assign(3 * chart.faces.size(), false);
  RangeDecoder coder(reader.rest());
  JoinCoder(chart, order).code(coder, joins);
  coder.finish();
  Polygons polygons = polygons_of(joins, chart, order);
  if (check_of(polygons, order) != check) reader.fail("is damaged, or belongs to another chart");
  return polygons;
}

}  // namespace ramcdb::codec
