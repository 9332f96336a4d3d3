#include "api/mesh_file/obj_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace ramcdb::mesh_file::obj {

void IndexedValues::add(double x, double y, double z) { values_.insert(values_.end(), {x, y, z}); }

void IndexedValues::set_corner(std::size_t corner, std::uint32_t value, std::size_t line) {
  if (value == kNone && of_corner_.empty()) return;
  of_corner_.resize(corner, kNone);
  of_corner_.push_back(value);
  if (value != kNone && (value > largest_ || !largest_line_)) {
    largest_ = value;
    largest_line_ = line;
  }
}

void IndexedValues::check(const FileBytes& file) const {
  if (largest_line_ && largest_ >= count())
    throw bad_line(
        file, largest_line_,
        fmt::format("index {} of a {} does not exist ({} in the file)", std::uint64_t{largest_} + 1, name_, count()));
}

bool IndexedValues::equal(std::uint32_t a, std::uint32_t b) const {
  for (std::size_t k = 0; k < 3; ++k)
    if (std::bit_cast<std::uint64_t>(values_[3 * std::size_t{a} + k]) !=
        std::bit_cast<std::uint64_t>(values_[3 * std::size_t{b} + k]))
      return false;
  return true;
}

bool IndexedValues::are_of_vertices(const MeshData& mesh) const {
  std::vector<std::uint32_t> of_vertex(mesh.positions.size(), kNone);
  for (std::size_t c = 0; c < of_corner_.size(); ++c) {
    std::uint32_t& value = of_vertex[mesh.corners[c]];
    if (of_corner_[c] == kNone || (value != kNone && !equal(value, of_corner_[c]))) return false;
    value = of_corner_[c];
  }
  return std::find(of_vertex.begin(), of_vertex.end(), kNone) == of_vertex.end();
}

void IndexedValues::hand_over(const FileBytes& file, MeshData& mesh, DroppedCounter& dropped) {
  if (values_.empty()) {
    // Some programs number corners through and leave the values out.
    dropped.add(fmt::format("indices of a {} in a file without any", name_),
                static_cast<std::uint64_t>(std::count_if(of_corner_.begin(), of_corner_.end(),
                                                         [](std::uint32_t value) { return value != kNone; })));
    return;
  }
  check(file);
  std::vector<bool> named(count(), false);
  for (const std::uint32_t value : of_corner_)
    if (value != kNone) named[value] = true;
  if (const auto unused = std::count(named.begin(), named.end(), false))
    dropped.add(fmt::format("{} values that no face names", name_), static_cast<std::uint64_t>(unused));
  if (of_corner_.empty()) return;
  of_corner_.resize(mesh.corners.size(), kNone);

  bool three = meaning_ == Meaning::normal;
  for (std::size_t i = 2; i < values_.size(); i += 3) three |= values_[i] != 0;
  const std::size_t components = three ? 3 : 2;
  Attribute attribute;
  attribute.info = {
      name_, AttributeOf::corner, NumberType::float64, static_cast<std::uint8_t>(components), meaning_, {}, {}};
  const bool of_vertices = are_of_vertices(mesh);
  if (of_vertices) attribute.info.of = AttributeOf::vertex;
  attribute.values.assign((of_vertices ? mesh.positions.size() : mesh.corners.size()) * components,
                          std::numeric_limits<double>::quiet_NaN());
  for (std::size_t c = 0; c < of_corner_.size(); ++c) {
    if (of_corner_[c] == kNone) continue;
    const std::size_t at = of_vertices ? mesh.corners[c] : c;
    for (std::size_t k = 0; k < components; ++k)
      attribute.values[at * components + k] = values_[3 * std::size_t{of_corner_[c]} + k];
  }
  mesh.attributes.push_back(std::move(attribute));
}

void FaceState::switch_to(std::string_view name, std::size_t faces_so_far) {
  const auto number = [&](std::string_view text) {
    const auto [it, is_new] = numbers_.try_emplace(std::string(text), static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.emplace_back(text);
    return it->second;
  };
  if (runs_.empty() && faces_so_far > 0) runs_.push_back({0, number("")});
  runs_.push_back({faces_so_far, number(name)});
}

void FaceState::switch_to(std::uint32_t number, std::size_t faces_so_far) {
  if (runs_.empty() && faces_so_far > 0) runs_.push_back({0, 0});
  runs_.push_back({faces_so_far, number});
}

void FaceState::hand_over(MeshData& mesh) {
  if (runs_.empty() || mesh.face_count() == 0) return;
  Attribute attribute;
  attribute.info = {name_, AttributeOf::face, NumberType::uint32, 1, meaning_, {}, std::move(names_)};
  attribute.values.resize(mesh.face_count());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::size_t end = r + 1 < runs_.size() ? runs_[r + 1].first_face : mesh.face_count();
    std::fill(attribute.values.begin() + static_cast<std::ptrdiff_t>(runs_[r].first_face),
              attribute.values.begin() + static_cast<std::ptrdiff_t>(end), runs_[r].value);
  }
  mesh.attributes.push_back(std::move(attribute));
}

}  // namespace ramcdb::mesh_file::obj
