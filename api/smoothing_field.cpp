#include "api/smoothing_field.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "api/chart_loader.h"
#include "api/same_values.h"
#include "api/spooled_edit.h"
#include "chartify/parallel.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

constexpr int kFractionBits = 24, kLambdaBits = 20;
constexpr std::int64_t kOne = std::int64_t{1} << kFractionBits;
/// What a face takes while its chart is read.
constexpr std::uint64_t kReadingBytesPerFace = 200;

__extension__ using Wide = __int128;

/// The whole number below num / den. REQUIRES: den > 0.
std::int64_t floor_of(Wide num, Wide den) {
  const auto short_num = static_cast<std::int64_t>(num), short_den = static_cast<std::int64_t>(den);
  if (short_num == num && short_den == den) {  // nearly always, and several times faster
    const std::int64_t quotient = short_num / short_den;
    return quotient - (short_num % short_den < 0);
  }
  const Wide quotient = num / den;
  return static_cast<std::int64_t>(quotient - (num % den < 0));
}

/// `lambda` of the way from `p` to the mean; halves go up.
std::int64_t moved(std::int64_t p, Wide sum, std::uint64_t count, std::int64_t lambda) {
  const Wide n = static_cast<Wide>(count);
  return p + floor_of(lambda * (sum - n * p) + (n << (kLambdaBits - 1)), n << kLambdaBits);
}

double whole_origin(const Lattice& lattice, int axis) {
  return std::floor(lattice.origin[axis] * lattice.steps_per_unit + 0.5);
}

std::int64_t to_fixed(double coordinate, const Lattice& lattice, int axis) {
  const double steps = lattice.steps_per_unit != 0 ? coordinate * lattice.steps_per_unit - whole_origin(lattice, axis)
                                                   : (coordinate - lattice.origin[axis]) / lattice.step;
  return static_cast<std::int64_t>(std::floor(steps * static_cast<double>(kOne) + 0.5));
}

double from_fixed(std::int64_t fixed, const Lattice& lattice, int axis) {
  const double steps = static_cast<double>(fixed) / static_cast<double>(kOne);
  if (lattice.steps_per_unit != 0) return (whole_origin(lattice, axis) + steps) / lattice.steps_per_unit;
  return lattice.origin[axis] + steps * lattice.step;
}

constexpr std::uint64_t aligned(std::uint64_t begin) { return (begin + 15) / 16 * 16; }

}  // namespace

SmoothingField::SmoothingField(const Snapshot::Impl& at, std::vector<ChartId> charts,
                               const std::filesystem::path& scratch_folder)
    : at_(at), charts_(std::move(charts)), scratch_folder_(scratch_folder) {
  number_shared();
  fix_borders();
  lay_out();
}

void SmoothingField::number_shared() {
  for (const ChartId id : charts_) {
    const auto ref = at_.pages().leaf_of(id);
    const PageChart& chart = *find_chart(*ref->leaf, id);
    Part part;
    part.inner = chart.inner_vertices;
    part.faces = chart.faces;
    for (const WireLoop& loop : chart.loops)
      for (const DirectedWire step : loop) {
        const PageWire& wire = *find_wire(*ref->leaf, step.wire);
        part.border += wire.inner_points + 1;
        if (wire_slots_.emplace(wire.id, slots_).second) slots_ += wire.inner_points;
        for (const CornerId corner : {wire.begin, wire.end})
          if (corner_slots_.emplace(corner, slots_).second) ++slots_;
      }
    parts_.push_back(part);
  }
}

/// Wires of the mesh's border and of non-manifold edges stay, and whatever a chart outside passes.
void SmoothingField::fix_borders() {
  fixed_.assign(slots_, false);
  LatticeBox box;
  for (const ChartId id : charts_) {
    const auto ref = at_.pages().leaf_of(id);
    const PageChart& chart = *find_chart(*ref->leaf, id);
    box.add(chart.box);
    for (const WireLoop& loop : chart.loops)
      for (const DirectedWire step : loop)
        if (const PageWire& wire = *find_wire(*ref->leaf, step.wire); wire.charts.size() != 2) fix_wire(wire);
  }
  const auto meets = [&](const LatticeBox& other) {
    for (int a = 0; a < 3; ++a)
      if (other.empty() || other.hi[a] < box.lo[a] || other.lo[a] > box.hi[a]) return false;
    return true;
  };
  at_.pages().visit(meets, [&](const LeafRef& ref) {
    for (const PageChart& chart : ref.leaf->charts) {
      if (std::ranges::binary_search(charts_, chart.id)) continue;
      for (const WireLoop& loop : chart.loops)
        for (const DirectedWire step : loop) fix_wire(*find_wire(*ref.leaf, step.wire));
    }
  });
}

void SmoothingField::fix_wire(const PageWire& wire) {
  if (const auto slot = wire_slots_.find(wire.id); slot != wire_slots_.end())
    std::fill_n(fixed_.begin() + slot->second, wire.inner_points, true);
  for (const CornerId corner : {wire.begin, wire.end})
    if (const auto slot = corner_slots_.find(corner); slot != corner_slots_.end()) fixed_[slot->second] = true;
}

/// Positions and sums of shared vertices; then chart by chart the positions of its own vertices, its triangles in its
/// own numbering, and the slots of its border vertices.
void SmoothingField::lay_out() {
  std::uint64_t end = aligned(slots_ * sizeof(Position));
  sums_begin_ = end;
  end += slots_ * sizeof(Sum);
  for (Part& part : parts_) {
    part.positions = std::exchange(end, aligned(end + part.inner * sizeof(Position)));
    part.triangles = std::exchange(end, aligned(end + part.faces * sizeof(Triangle)));
    part.slots = std::exchange(end, aligned(end + part.border * sizeof(std::uint32_t)));
  }
  memory_.emplace(scratch_folder_, end);
}

void SmoothingField::load(std::uint64_t memory, unsigned threads, const Report& progress) {
  std::size_t done = 0;
  for (const auto batch : in_batches(at_, charts_, memory, kReadingBytesPerFace, threads)) {
    progress(static_cast<double>(done) / static_cast<double>(charts_.size()));
    for (const LoadedChart& chart : ChartLoader(at_).load(batch, threads)) store(chart, parts_[done++]);
  }
}

void SmoothingField::store(const LoadedChart& chart, const Part& part) {
  const auto shared = memory_->at<Position>(0, slots_), own = memory_->at<Position>(part.positions, part.inner);
  const auto slots = memory_->at<std::uint32_t>(part.slots, part.border);
  const auto triangles = memory_->at<Triangle>(part.triangles, part.faces);
  const Lattice& lattice = at_.record().lattice;
  std::unordered_map<std::uint32_t, std::uint32_t> first_with;  // copies of a vertex count as the first of them
  std::vector<std::uint32_t> same(chart.keys.size());
  for (std::uint32_t v = 0; v < chart.keys.size(); ++v) {
    const LatticePoint from = chart.chart.positions[v];
    const Position start = start_of(from, chart.exact.empty() ? lattice.position(from) : chart.exact[v]);
    same[v] = v;
    if (v >= part.border) {
      own[v - part.border] = start;
      continue;
    }
    slots[v] = static_cast<std::uint32_t>(slot_of(chart.keys[v]));
    shared[slots[v]] = start;
    same[v] = first_with.emplace(slots[v], v).first->second;
  }
  for (std::size_t f = 0; f < triangles.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i) triangles[f][i] = same[chart.chart.faces[f][i]];
}

/// What the faces of a chart give to each of its vertices.
void SmoothingField::add_up(const Part& part, std::vector<Sum>& sums) const {
  const auto shared = memory_->at<Position>(0, slots_), own = memory_->at<Position>(part.positions, part.inner);
  const auto slots = memory_->at<std::uint32_t>(part.slots, part.border);
  sums.assign(part.border + part.inner, {});
  const auto add = [&](std::uint32_t to, std::uint32_t neighbour, const Position& p) {
    if (to == neighbour) return;  // a degenerate face
    for (std::size_t a = 0; a < 3; ++a) sums[to].of[a] += p[a];
    ++sums[to].count;
  };
  for (const Triangle& t : memory_->at<Triangle>(part.triangles, part.faces))
    for (std::size_t i = 0; i < 3; ++i) {
      const Position& p = t[i] < part.border ? shared[slots[t[i]]] : own[t[i] - part.border];
      add(t[(i + 1) % 3], t[i], p);
      add(t[(i + 2) % 3], t[i], p);
    }
}

/// Moves a chart's own vertices: nobody else reads them.
void SmoothingField::step_chart(const Part& part, std::int64_t lambda, std::vector<Sum>& border_sums) {
  std::vector<Sum> sums;
  add_up(part, sums);
  const auto own = memory_->at<Position>(part.positions, part.inner);
  for (std::size_t v = 0; v < own.size(); ++v)
    if (const Sum& sum = sums[part.border + v]; sum.count > 0)
      for (std::size_t a = 0; a < 3; ++a) own[v][a] = moved(own[v][a], sum.of[a], sum.count, lambda);
  sums.resize(part.border);
  border_sums = std::move(sums);
}

void SmoothingField::step(std::int64_t lambda, unsigned threads) {
  const auto shared = memory_->at<Position>(0, slots_);
  const auto sums = memory_->at<Sum>(sums_begin_, slots_);
  std::ranges::fill(sums, Sum{});
  std::mutex sums_mutex;
  parallel_for(parts_.size(), threads, [&](std::size_t c) {
    std::vector<Sum> border;
    step_chart(parts_[c], lambda, border);
    const auto slots = memory_->at<std::uint32_t>(parts_[c].slots, parts_[c].border);
    const std::lock_guard lock(sums_mutex);
    for (std::size_t v = 0; v < border.size(); ++v) {
      for (std::size_t a = 0; a < 3; ++a) sums[slots[v]].of[a] += border[v].of[a];
      sums[slots[v]].count += border[v].count;
    }
  });
  for (std::size_t s = 0; s < slots_; ++s)
    if (!fixed_[s] && sums[s].count > 0)
      for (std::size_t a = 0; a < 3; ++a) shared[s][a] = moved(shared[s][a], sums[s].of[a], sums[s].count, lambda);
}

SmoothingField::Position SmoothingField::start_of(LatticePoint from, const Point& position) const {
  const Lattice& lattice = at_.record().lattice;
  Position start{};
  for (int a = 0; a < 3; ++a)
    start[static_cast<std::size_t>(a)] =
        at_.record().exact ? to_fixed(position[a], lattice, a) : std::int64_t{from[a]} * kOne;
  return start;
}

std::size_t SmoothingField::slot_of(const VertexKey& key) const {
  if (key.where == VertexKey::Where::wire) return wire_slots_.at(WireId(key.id)) + key.index;
  return corner_slots_.at(CornerId(key.id));
}

const SmoothingField::Position& SmoothingField::position_of(const VertexKey& key) const {
  if (key.where != VertexKey::Where::chart) return memory_->at<Position>(0, slots_)[slot_of(key)];
  const auto chart = std::ranges::lower_bound(charts_, ChartId(key.id));
  const Part& part = parts_[static_cast<std::size_t>(chart - charts_.begin())];
  return memory_->at<Position>(part.positions, part.inner)[key.index];
}

std::optional<VertexMove> SmoothingField::move_of(const VertexKey& key, LatticePoint from,
                                                  const Point& position) const {
  const Position& now = position_of(key);
  const Position start = start_of(from, position);
  if (now == start) return std::nullopt;
  const Lattice& lattice = at_.record().lattice;
  VertexMove move{key, from, from, position, position};
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    if (!at_.record().exact)
      move.to[a] = static_cast<std::int32_t>((now[axis] + kOne / 2) >> kFractionBits);
    else if (now[axis] != start[axis])
      move.target[a] = from_fixed(now[axis], lattice, a);
  }
  if (!at_.record().exact) {
    if (move.to == from) return std::nullopt;
    move.target = lattice.position(move.to);
    return move;
  }
  move.target = at_.record().rounded(move.target);
  if (same_bits(move.target, position)) return std::nullopt;
  move.to = lattice.snap(move.target);
  return move;
}

}  // namespace ramcdb::detail
