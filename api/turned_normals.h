#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/chart_loader.h"
#include "api/layer_edit.h"

namespace ramcdb::detail {

/// The first derivative of a map of space, by rows.
using Derivative = std::array<double, 9>;

/// What normals are multiplied by, up to their length, where surfaces follow a map with this derivative: its inverse
/// transpose, or where it has none the nearest to it.
[[nodiscard]] Derivative normal_map(const Derivative& m);

/// What normals at a vertex are multiplied by, up to their length; none where they stay. Asked from several threads.
using NormalTurner = std::function<std::optional<Derivative>(const VertexKey& key, const Point& position)>;

/// Whether a layer holds normals that can be turned: three floats each.
[[nodiscard]] bool holds_turnable_normals(const Layer& layer);

/// What a chart's normals become, their lengths kept. Those of vertices and corners follow their vertex, those of faces
/// the mean of their three. \param loaded with layers
[[nodiscard]] std::vector<LayerEdit> turned_normals(const Snapshot::Impl& at, const LoadedChart& loaded,
                                                    const NormalTurner& turner);

}  // namespace ramcdb::detail
