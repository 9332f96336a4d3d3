#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/layers.h"
#include "api/mesh_file/mesh_file.h"
#include "ramcdb/figures.h"

namespace ramcdb::test {

/// Everything that a file says of each face: positions on the lattice, attributes of vertices and corners, all of that
/// turned to the smallest sequence; then attributes of the face. Sorted: equal for files that say the same, however
/// numbered. Attributes that are kept with an error are compared on their grid, normals as the directions that they are
/// kept as, materials and groups by their names.
/// \param place what three numbers stand for a position
template <class Place>
std::vector<std::vector<double>> face_records(const mesh_file::MeshData& mesh, Place&& place,
                                              const std::vector<MeshInfo::Layer>& layers) {
  struct Source {
    const Attribute* attribute;
    double step;
    std::optional<detail::Layer> directions;
  };
  const auto source_of = [](const Attribute& attribute, double max_error) {
    Source source{&attribute, 2 * max_error, detail::Layer{1, attribute.info, detail::LayerCoding::direction, 0}};
    if (attribute.info.meaning != Meaning::normal || max_error != source.directions->max_error())
      source.directions.reset();
    return source;
  };
  std::map<std::string, Source> sources;
  for (const Attribute& attribute : mesh.attributes)
    for (const MeshInfo::Layer& layer : layers)
      if (layer.info.name == attribute.info.name)
        sources.insert_or_assign(attribute.info.name, source_of(attribute, layer.max_error));

  const auto add = [&](std::vector<double>& record, const Source& source, std::size_t at) {
    const AttributeInfo& info = source.attribute->info;
    if (source.directions) {
      std::array<std::uint64_t, 2> numbers;
      const auto value = std::span(source.attribute->values).subspan(3 * at, 3);
      record.push_back(detail::to_numbers(*source.directions, value, numbers));
      for (const std::uint64_t number : numbers) record.push_back(static_cast<double>(number));
      return;
    }
    for (std::size_t k = 0; k < info.components; ++k) {
      const double number = source.attribute->values[at * info.components + k];
      if (std::isnan(number))
        record.push_back(1e300);
      else if (!info.names.empty())
        record.push_back(
            static_cast<double>(std::hash<std::string>{}(info.names.at(static_cast<std::size_t>(number)))));
      else
        record.push_back(source.step > 0 ? std::floor(number / source.step + 0.5) : number);
    }
  };

  std::vector<std::vector<double>> records;
  std::size_t first = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::size_t size = mesh.face_sizes.empty() ? 3 : mesh.face_sizes[f];
    std::vector<std::vector<double>> corners(size);
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t v = mesh.corners[first + i];
      const Point p = place(mesh.positions[v]);
      corners[i] = {p.x, p.y, p.z};
      for (const auto& [name, source] : sources) {
        if (source.attribute->info.of == AttributeOf::vertex) add(corners[i], source, v);
        if (source.attribute->info.of == AttributeOf::corner) add(corners[i], source, first + i);
      }
    }
    auto best = corners;
    for (std::size_t turn = 1; turn < size; ++turn) {
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
      best = std::min(best, corners);
    }
    std::vector<double> record;
    for (const auto& corner : best) record.insert(record.end(), corner.begin(), corner.end());
    for (const auto& [name, source] : sources)
      if (source.attribute->info.of == AttributeOf::face) add(record, source, f);
    records.push_back(std::move(record));
    first += size;
  }
  std::sort(records.begin(), records.end());
  return records;
}

inline std::vector<std::vector<double>> face_records(const mesh_file::MeshData& mesh, const Lattice& lattice,
                                                     const std::vector<MeshInfo::Layer>& layers) {
  const auto place = [&](const Point& p) {
    const LatticePoint q = lattice.snap(p);
    return Point{static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z)};
  };
  return face_records(mesh, place, layers);
}

}  // namespace ramcdb::test
