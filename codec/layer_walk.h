#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "codec/layer_codec.h"
#include "codec/layer_numbers.h"
#include "ramcdb/error.h"

namespace ramcdb::codec {

/// The walk over a chart's values, for encoder and decoder alike.
///
///     layer = value*                     in the order of LayerOrder
///     value = absent:bit same:bit miss*  a miss per component; absent only if the layer has such values, same only
///     where
///                                        something is predicted to be equal (corners and faces)
///
/// A vertex is predicted per component (directions as vectors) by the mean of its neighbours, by the parallelogram over
/// the edge that its face was entered through, or by the vertex at the begin of that edge, whichever missed least
/// lately. A corner is likely to have the value that the neighbouring face has there, a face that of the face it was
/// entered from; where they differ (a seam, another material), they are predicted by what the face has already.
template <class Coder>
class LayerWalk {
 public:
  LayerWalk(Coder& coder, LayerValues& values, const LayerShape& shape, const Chart& chart, const LayerOrder& order,
            bool some_absent)
      : coder_(coder),
        values_(values),
        shape_(shape),
        chart_(chart),
        order_(order),
        ring_(shape.bits),
        some_absent_(some_absent),
        is_direction_(shape.kind == ValueKind::direction),
        components_(shape.components),
        known_(value_count(chart, shape.of), false) {}

  void run() {
    switch (shape_.of) {
      case AttributeOf::vertex:
        return walk_vertices();
      case AttributeOf::corner:
        return walk_corners();
      case AttributeOf::face:
        return walk_faces();
    }
  }

 private:
  static constexpr std::uint32_t kNone = LayerOrder::kNone;
  enum Predictor : std::size_t { kMean, kParallelogram, kBegin, kPredictors };

  struct Component {
    MissNumber miss;
    BestOf<kPredictors> best;
    std::uint64_t fading = 0;  ///< mean size of misses lately, in 1/16
  };

  // ---- vertices ----

  void walk_vertices() {
    const std::uint32_t border = chart_.border_count();
    for (std::uint32_t v = 0; v < border; ++v) code_alone(v, v == 0 ? kNone : v - 1);
    for (const std::uint32_t entry : order_.entries())
      for (const std::uint32_t c : {entry, LayerOrder::next(entry), LayerOrder::prev(entry)})
        if (!known_[vertex_at(c)]) code_vertex(c, entry);
    for (const std::uint32_t v : order_.vertices())
      if (!known_[v]) code_alone(v, last_);
  }

  [[nodiscard]] std::uint32_t vertex_at(std::uint32_t corner) const { return chart_.faces[corner / 3][corner % 3]; }

  void code_vertex(std::uint32_t corner, std::uint32_t entry) {
    find_neighbours(corner);
    const std::uint32_t v = vertex_at(corner);
    if (neighbours_.empty()) return code_alone(v, last_);
    const std::uint32_t a = vertex_at(entry), b = vertex_at(LayerOrder::next(entry));
    const std::uint32_t twin = order_.twin(entry);
    const std::uint32_t across = twin == kNone ? kNone : vertex_at(LayerOrder::prev(twin));
    const bool has_parallelogram = corner == LayerOrder::prev(entry) && across != kNone && across != v && is_there(a) &&
                                   is_there(b) && is_there(across);
    if (!begin_value(v, 0)) return;
    if (is_direction_)
      code_direction_between(v, a, b, has_parallelogram ? across : kNone);
    else
      code_numbers_between(v, a, b, has_parallelogram ? across : kNone);
    end_value(v);
  }

  /// A vertex among its neighbours; `across` is what the parallelogram over a and b begins at, if there is one.
  void code_numbers_between(std::uint32_t v, std::uint32_t a, std::uint32_t b, std::uint32_t across) {
    for (std::size_t k = 0; k < components_; ++k) {
      const std::uint64_t first = number(neighbours_[0], k);
      std::array<std::uint64_t, kPredictors> guesses;
      guesses[kMean] = ring_.wrap(first + static_cast<std::uint64_t>(mean_difference(first, k)));
      guesses[kParallelogram] =
          across != kNone ? ring_.wrap(number(a, k) + number(b, k) - number(across, k)) : guesses[kMean];
      guesses[kBegin] = first;
      Component& model = components_models_[k];
      const std::uint64_t guess = guesses[model.best.best()];
      const std::uint64_t coded = code_number(v, k, guess, spread(guess, k));
      for (std::size_t p = 0; p < kPredictors; ++p) model.best.learn(p, magnitude(ring_.difference(coded, guesses[p])));
    }
  }

  void code_direction_between(std::uint32_t v, std::uint32_t a, std::uint32_t b, std::uint32_t across) {
    std::array<OctahedronPoint, kPredictors> guesses;
    OctahedronVector sum;
    for (const std::uint32_t n : neighbours_) sum = sum + octahedron_vector(direction(n));
    guesses[kMean] = octahedron_point(sum);
    guesses[kParallelogram] = across != kNone ? parallelogram(a, b, across) : guesses[kMean];
    guesses[kBegin] = direction(neighbours_[0]);
    BestOf<kPredictors>& best = components_models_[0].best;
    const OctahedronPoint guess = guesses[best.best()];
    std::array<std::uint64_t, 2> spread{};
    for (const std::uint32_t n : neighbours_) {
      const auto away = distance(guess, direction(n));
      for (std::size_t k = 0; k < 2; ++k) spread[k] = std::max(spread[k], away[k]);
    }
    code_direction(v, guess, spread);
    for (std::size_t p = 0; p < kPredictors; ++p) {
      const auto missed = distance(guesses[p], direction(v));
      best.learn(p, missed[0] + missed[1]);
    }
  }

  [[nodiscard]] OctahedronPoint parallelogram(std::uint32_t a, std::uint32_t b, std::uint32_t across) const {
    return octahedron_point(octahedron_vector(direction(a)) + octahedron_vector(direction(b)) -
                            octahedron_vector(direction(across)));
  }

  /// The known, present neighbours of the vertex at a corner, from the edge that its face was entered through on.
  void find_neighbours(std::uint32_t corner) {
    neighbours_.clear();
    const auto add = [&](std::uint32_t v) {
      if (is_there(v) && neighbours_.size() < kMostNeighbours) neighbours_.push_back(v);
    };
    add(vertex_at(LayerOrder::next(corner)));
    add(vertex_at(LayerOrder::prev(corner)));
    std::uint32_t c = corner;
    for (std::size_t step = 0; step < kMostNeighbours; ++step) {  // one way round
      const std::uint32_t t = order_.twin(LayerOrder::prev(c));
      if (t == kNone || t == corner) break;
      c = t;
      if (c == corner) return;
      add(vertex_at(LayerOrder::prev(c)));
    }
    c = corner;
    for (std::size_t step = 0; step < kMostNeighbours; ++step) {  // and the other, when there was a border
      const std::uint32_t t = order_.twin(c);
      if (t == kNone || LayerOrder::next(t) == corner) break;
      c = LayerOrder::next(t);
      add(vertex_at(LayerOrder::next(c)));
    }
  }

  [[nodiscard]] std::int64_t mean_difference(std::uint64_t first, std::size_t k) const {
    const auto n = static_cast<std::int64_t>(neighbours_.size());
    const std::int64_t part = shape_.bits <= 56 ? 1 : n;  // so that sums of wide numbers do not overflow
    std::int64_t sum = 0;
    for (const std::uint32_t v : neighbours_) sum += ring_.difference(number(v, k), first) / part;
    return part == 1 ? sum / n : sum;
  }

  [[nodiscard]] std::uint64_t spread(std::uint64_t guess, std::size_t k) const {
    std::uint64_t most = 0;
    for (const std::uint32_t v : neighbours_) most = std::max(most, magnitude(ring_.difference(number(v, k), guess)));
    return most;
  }

  /// A value without neighbours, from one other, or from 0.
  void code_alone(std::uint32_t v, std::uint32_t from) {
    if (!begin_value(v, 1)) return;
    code_from(v, from);
    end_value(v);
  }

  /// From one other value, if it is there, else from the last one, or 0.
  void code_from(std::uint32_t at, std::uint32_t from) {
    if (from == kNone || !here(from)) from = last_;
    if (is_direction_) {
      const OctahedronPoint guess = from == kNone ? OctahedronPoint{} : direction(from);
      return code_direction(at, guess, {components_models_[0].fading / 16, components_models_[1].fading / 16});
    }
    for (std::size_t k = 0; k < components_; ++k)
      (void)code_number(at, k, from == kNone ? 0 : number(from, k), components_models_[k].fading / 16);
  }

  // ---- corners ----

  void walk_corners() {
    last_at_.assign(chart_.positions.size(), kNone);
    for (const std::uint32_t entry : order_.entries()) {
      const std::uint32_t twin = order_.twin(entry), begin = entry, end = LayerOrder::next(entry),
                          apex = LayerOrder::prev(entry);
      const bool entered = twin != kNone && known_[twin];
      const bool same_begin =
          code_corner(begin, entered ? LayerOrder::next(twin) : last_at_[vertex_at(begin)], last_, 0);
      const bool same_end = code_corner(end, entered ? twin : last_at_[vertex_at(end)], begin, 1 + same_begin);
      code_apex(apex, same_begin && same_end && entered ? twin : kNone);
    }
  }

  void code_apex(std::uint32_t apex, std::uint32_t twin) {
    const std::uint32_t entry = LayerOrder::next(apex);
    std::uint32_t likely = kNone;
    const std::uint32_t left = order_.twin(apex), right = order_.twin(LayerOrder::prev(apex));
    if (left != kNone && known_[LayerOrder::next(left)])
      likely = LayerOrder::next(left);
    else if (right != kNone && known_[right])
      likely = right;
    else
      likely = last_at_[vertex_at(apex)];
    across_ = twin;
    (void)code_corner(apex, likely, entry, 3 + (twin != kNone));
    across_ = kNone;
  }

  /// Returns whether the corner has the value that it likely has.
  bool code_corner(std::uint32_t corner, std::uint32_t likely, std::uint32_t near, std::size_t context) {
    last_at_[vertex_at(corner)] = corner;
    if (likely != kNone && coder_.code(same_[context], Coder::kEncodes && equal(corner, likely))) {
      copy_value(corner, likely);
      return true;
    }
    if (!begin_value(corner, 2)) return false;
    if (across_ != kNone && here(across_) && here(LayerOrder::next(across_)) && here(LayerOrder::prev(across_)))
      code_across(corner);
    else
      code_from(corner, near);
    end_value(corner);
    return false;
  }

  /// An apex from the face behind its entry.
  void code_across(std::uint32_t corner) {
    const std::uint32_t a = LayerOrder::next(across_), b = across_, far = LayerOrder::prev(across_);
    if (is_direction_) {
      const OctahedronPoint guess = parallelogram(a, b, far);
      std::array<std::uint64_t, 2> activity = distance(direction(b), direction(a));
      for (std::size_t k = 0; k < 2; ++k) activity[k] = (components_models_[k].fading / 16 + activity[k]) / 2;
      return code_direction(corner, guess, activity);
    }
    for (std::size_t k = 0; k < components_; ++k) {
      const std::uint64_t along = magnitude(ring_.difference(number(a, k), number(b, k)));
      (void)code_number(corner, k, ring_.wrap(number(a, k) + number(b, k) - number(far, k)),
                        (components_models_[k].fading / 16 + along) / 2);
    }
  }

  // ---- faces ----

  void walk_faces() {
    for (const std::uint32_t entry : order_.entries()) {
      const std::uint32_t face = entry / 3;
      std::array<std::uint32_t, 3> around{kNone, kNone, kNone};
      std::size_t count = 0;
      for (const std::uint32_t c : {entry, LayerOrder::next(entry), LayerOrder::prev(entry)})
        if (const std::uint32_t t = order_.twin(c); t != kNone && known_[t / 3]) around[count++] = t / 3;
      if (count == 0 && last_ != kNone) around[count++] = last_;
      const bool agree = std::all_of(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(count),
                                     [&](std::uint32_t f) { return equal(f, around[0]); });
      const std::size_t context = 2 * count + agree;
      if (count && coder_.code(same_[context], Coder::kEncodes && equal(face, around[0]))) {
        copy_value(face, around[0]);
        continue;
      }
      code_alone(face, around[0]);
    }
  }

  // ---- values ----

  [[nodiscard]] std::uint64_t& number(std::uint32_t at, std::size_t k) {
    return values_.numbers[std::size_t{at} * components_ + k];
  }
  [[nodiscard]] std::uint64_t number(std::uint32_t at, std::size_t k) const {
    return values_.numbers[std::size_t{at} * components_ + k];
  }
  [[nodiscard]] bool is_there(std::uint32_t at) const { return known_[at] && here(at); }
  /// Of a known value.
  [[nodiscard]] bool here(std::uint32_t at) const { return !some_absent_ || !values_.absent[at]; }
  [[nodiscard]] OctahedronPoint direction(std::uint32_t at) const {
    return direction_of(number(at, 0), number(at, 1), ring_);
  }
  void set_direction(std::uint32_t at, OctahedronPoint p) {
    number(at, 0) = ring_.wrap(static_cast<std::uint64_t>(std::int64_t{p.u}));
    number(at, 1) = ring_.wrap(static_cast<std::uint64_t>(std::int64_t{p.v}));
  }
  /// How far a direction is from a guess, as it is coded.
  [[nodiscard]] static std::array<std::uint64_t, 2> distance(OctahedronPoint guess, OctahedronPoint p) {
    const OctahedronPoint from = seen_from(guess, guess), to = seen_from(guess, p);
    return {magnitude(std::int64_t{to.u} - from.u), magnitude(std::int64_t{to.v} - from.v)};
  }

  [[nodiscard]] bool equal(std::uint32_t x, std::uint32_t y) const {
    if (here(x) != here(y)) return false;
    for (std::size_t k = 0; k < components_; ++k)
      if (number(x, k) != number(y, k)) return false;
    return true;
  }

  void copy_value(std::uint32_t to, std::uint32_t from) {
    known_[to] = true;
    if (some_absent_) values_.absent[to] = values_.absent[from];
    for (std::size_t k = 0; k < components_; ++k) number(to, k) = number(from, k);
  }

  /// False when the value is absent: then it is done.
  bool begin_value(std::uint32_t at, std::size_t context) {
    if (!some_absent_) return true;
    const bool absent = coder_.code(absent_[2 * context + absent_before_], Coder::kEncodes && values_.absent[at]);
    absent_before_ = absent;
    values_.absent[at] = absent;
    if (absent) known_[at] = true;
    return !absent;
  }

  void end_value(std::uint32_t at) {
    known_[at] = true;
    last_ = at;
  }

  std::uint64_t code_number(std::uint32_t at, std::size_t k, std::uint64_t guess, std::uint64_t activity) {
    Component& model = components_models_[k];
    const std::uint64_t likely = activity / 2 + model.fading / 32;
    const auto expected = static_cast<unsigned>(std::bit_width(likely));
    const std::int64_t actual = Coder::kEncodes ? ring_.difference(number(at, k), guess) : 0;
    const std::int64_t miss = model.miss.code(coder_, expected, actual);
    number(at, k) = ring_.wrap(guess + static_cast<std::uint64_t>(miss));
    constexpr std::uint64_t kMost = std::uint64_t{1} << 56;
    model.fading += std::min(magnitude(miss), kMost) - model.fading / 16;
    return number(at, k);
  }

  void code_direction(std::uint32_t at, OctahedronPoint guess, const std::array<std::uint64_t, 2>& activity) {
    if (Coder::kEncodes) set_direction(at, seen_from(guess, direction(at)));
    const OctahedronPoint from = seen_from(guess, guess);
    (void)code_number(at, 0, ring_.wrap(static_cast<std::uint64_t>(std::int64_t{from.u})), activity[0]);
    (void)code_number(at, 1, ring_.wrap(static_cast<std::uint64_t>(std::int64_t{from.v})), activity[1]);
    const OctahedronPoint coded = direction(at);
    if (!in_octahedron_square(coded)) throw Error(Errc::corrupt, "a layer blob has a direction that is none");
    set_direction(at, without_twins(seen_from(guess, coded)));
  }

  static constexpr std::size_t kMostNeighbours = 64;

  Coder& coder_;
  LayerValues& values_;
  const LayerShape& shape_;
  const Chart& chart_;
  const LayerOrder& order_;
  Ring ring_;
  bool some_absent_, is_direction_;
  std::size_t components_;
  std::vector<bool> known_;
  std::vector<Component> components_models_{components_};
  std::array<AdaptiveBit, 10> same_;
  std::array<AdaptiveBit, 6> absent_;
  bool absent_before_ = false;
  std::uint32_t last_ = kNone;    ///< the value coded last
  std::uint32_t across_ = kNone;  ///< for an apex: the corner behind the entry edge, when its face continues
  std::vector<std::uint32_t> neighbours_, last_at_;
};

}  // namespace ramcdb::codec
