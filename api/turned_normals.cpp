#include "api/turned_normals.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ramcdb::detail {
namespace {

using Vector = std::array<double, 3>;

double length(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

Vector times(const Derivative& m, const Vector& v) {
  Vector out{};
  for (std::size_t row = 0; row < 3; ++row)
    out[row] = m[3 * row] * v[0] + m[3 * row + 1] * v[1] + m[3 * row + 2] * v[2];
  return out;
}

/// The normals of one layer of a chart.
class NormalsOfChart {
 public:
  NormalsOfChart(const LoadedChart& loaded, const Layer& layer, const codec::LayerValues& values,
                 const std::vector<std::optional<Derivative>>& maps)
      : loaded_(loaded), layer_(layer), values_(values), maps_(maps) {}

  [[nodiscard]] LayerEdit turned() const {
    LayerEdit edit;
    edit.layer = layer_;
    const std::size_t components = layer_.shape().components;
    for (std::uint32_t i = 0; i < values_.numbers.size() / components; ++i) {
      if (!values_.absent.empty() && values_.absent[i]) continue;
      const auto before = std::span(values_.numbers).subspan(i * components, components);
      CodedValue value{false, {before.begin(), before.end()}};
      if (!turn(i, value.numbers) || std::ranges::equal(value.numbers, before)) continue;
      if (layer_.info.of == AttributeOf::vertex)
        edit.at_vertices.emplace(loaded_.keys[i].packed(), std::move(value));
      else
        edit.in_charts[loaded_.entry.id].emplace(i, std::move(value));
    }
    return edit;
  }

 private:
  /// The vertices that say how a value turns.
  [[nodiscard]] std::vector<std::uint32_t> vertices_of(std::uint32_t at) const {
    if (layer_.info.of == AttributeOf::vertex) return {at};
    if (layer_.info.of == AttributeOf::corner) return {loaded_.chart.faces[at / 3][at % 3]};
    return {loaded_.chart.faces[at].begin(), loaded_.chart.faces[at].end()};
  }

  [[nodiscard]] bool turn(std::uint32_t at, std::vector<std::uint64_t>& numbers) const {
    const std::vector<std::uint32_t> vertices = vertices_of(at);
    if (std::ranges::none_of(vertices, [&](std::uint32_t v) { return maps_[v].has_value(); })) return false;
    Vector normal{}, sum{};
    from_numbers(layer_, numbers, normal);
    for (const std::uint32_t v : vertices) {
      const Vector turned = maps_[v] ? times(*maps_[v], normal) : normal;
      const double size = length(turned);
      for (std::size_t k = 0; size > 0 && k < 3; ++k) sum[k] += turned[k] / size;
    }
    const double scale = (layer_.coding == LayerCoding::direction ? 1 : length(normal)) / length(sum);
    if (!(length(normal) > 0 && std::isfinite(scale))) return false;
    for (double& x : sum)
      x = layer_.info.type == NumberType::float32 ? double{static_cast<float>(x * scale)} : x * scale;
    (void)to_numbers(layer_, sum, numbers);
    return true;
  }

  const LoadedChart& loaded_;
  const Layer& layer_;
  const codec::LayerValues& values_;
  const std::vector<std::optional<Derivative>>& maps_;  ///< per vertex
};

}  // namespace

Derivative normal_map(const Derivative& m) {
  Derivative cofactors{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) {
      const std::size_t r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
      cofactors[3 * row + column] = m[3 * r1 + c1] * m[3 * r2 + c2] - m[3 * r1 + c2] * m[3 * r2 + c1];
    }
  const double determinant = m[0] * cofactors[0] + m[1] * cofactors[1] + m[2] * cofactors[2];
  if (determinant < 0)
    for (double& x : cofactors) x = -x;
  return cofactors;
}

bool holds_turnable_normals(const Layer& layer) {
  const bool is_float = layer.info.type == NumberType::float32 || layer.info.type == NumberType::float64;
  return layer.info.meaning == Meaning::normal && layer.info.components == 3 && is_float;
}

std::vector<LayerEdit> turned_normals(const Snapshot::Impl& at, const LoadedChart& loaded, const NormalTurner& turner) {
  std::vector<std::optional<Derivative>> maps;
  for (std::size_t v = 0; v < loaded.keys.size(); ++v)
    maps.push_back(turner(loaded.keys[v], loaded.exact.empty() ? at.record().lattice.position(loaded.chart.positions[v])
                                                               : loaded.exact[v]));
  std::vector<LayerEdit> edits;
  const auto& layers = at.layers().layers;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (!holds_turnable_normals(layers[i])) continue;
    LayerEdit edit = NormalsOfChart(loaded, layers[i], loaded.layers[i], maps).turned();
    if (edit.count()) edits.push_back(std::move(edit));
  }
  return edits;
}

}  // namespace ramcdb::detail
