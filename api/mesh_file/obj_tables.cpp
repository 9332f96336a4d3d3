#include "api/mesh_file/obj_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "api/mesh_file/attribute_names.h"

namespace ramcdb::mesh_file {

void CornerTable::read_line(TextScanner& scan) {
  double numbers[3] = {};
  std::size_t n = 0;
  for (std::string_view word; n < most_ && !(word = scan.word()).empty(); ++n)
    numbers[n] = scan.parse_value(word, NumberType::float64);
  if (n < least_) throw scan.bad(fmt::format("{} with {} numbers, not {}", what_, n, least_));
  further_ += !scan.word().empty();
  components_ = std::max(components_, n);
  values_.insert(values_.end(), numbers, numbers + 3);
}

void CornerTable::read_index(const TextScanner& scan, std::string_view word, std::size_t corner) {
  const std::int64_t i = scan.parse_integer(word, index_);
  const std::int64_t index = i < 0 ? static_cast<std::int64_t>(count()) + i : i - 1;
  if (index < 0 || index >= kNone) {
    ++wrong_;
    return;
  }
  indices_.resize(corner, kNone);
  indices_.push_back(static_cast<std::uint32_t>(index));
}

bool CornerTable::same(std::uint32_t a, std::uint32_t b) const {
  return a == b || std::memcmp(&values_[3 * std::size_t{a}], &values_[3 * std::size_t{b}], 3 * sizeof(double)) == 0;
}

void CornerTable::check_indices(std::size_t corners, DroppedCounter& dropped) {
  indices_.resize(corners, kNone);
  std::vector<bool> used(count());
  for (std::uint32_t& index : indices_) {
    if (index == kNone) continue;
    if (index < count()) {
      used[index] = true;
    } else {
      index = kNone;
      ++wrong_;
    }
  }
  dropped.add(what_, static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false)));
  dropped.add(fmt::format("corners that name {} that do not exist", what_), wrong_);
}

std::vector<std::uint32_t> CornerTable::per_vertex(const MeshData& mesh) const {
  std::vector<std::uint32_t> of_vertex(mesh.positions.size(), kNone);
  for (std::size_t c = 0; c < indices_.size(); ++c) {
    std::uint32_t& index = of_vertex[mesh.corners[c]];
    if (index == kNone) index = indices_[c];
    if (indices_[c] == kNone || !same(index, indices_[c])) return {};
  }
  return of_vertex;
}

std::vector<double> CornerTable::gather(const std::vector<std::uint32_t>& indices) const {
  std::vector<double> values(indices.size() * components_, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] != kNone) std::copy_n(&values_[3 * std::size_t{indices[i]}], components_, &values[i * components_]);
  return values;
}

void CornerTable::hand_over(std::string_view name, Meaning meaning, MeshData& mesh, DroppedCounter& dropped) {
  if (values_.empty() && indices_.empty() && !wrong_) return;
  check_indices(mesh.corners.size(), dropped);
  dropped.add(fmt::format("further numbers of {}", what_), further_);
  if (std::all_of(indices_.begin(), indices_.end(), [](std::uint32_t index) { return index == kNone; })) return;
  const auto of_vertex = per_vertex(mesh);
  Attribute attribute;
  attribute.info.name = name;
  attribute.info.of = of_vertex.empty() ? AttributeOf::corner : AttributeOf::vertex;
  attribute.info.type = NumberType::float64;
  attribute.info.components = static_cast<std::uint8_t>(components_);
  attribute.info.meaning = meaning;
  attribute.values = gather(of_vertex.empty() ? indices_ : of_vertex);
  mesh.attributes.push_back(std::move(attribute));
}

void FaceSwitch::set(std::uint32_t value, std::size_t faces_before) {
  set_ = true;
  if (runs_.back().begin == faces_before) {
    unused_ += runs_.back().written;
    runs_.pop_back();
  }
  runs_.push_back({faces_before, value, true});
}

std::vector<double> FaceSwitch::values(std::size_t faces) {
  std::vector<double> values(faces);
  if (runs_.back().begin == faces) unused_ += runs_.back().written;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::size_t end = r + 1 < runs_.size() ? runs_[r + 1].begin : faces;
    for (std::size_t f = runs_[r].begin; f < end; ++f) values[f] = runs_[r].value;
  }
  return values;
}

void NameSwitch::set(std::string_view name, std::size_t faces_before) {
  settle(faces_before);
  newest_ = name;
  newest_begin_ = faces_before;
}

void NameSwitch::settle(std::size_t faces) {
  if (!newest_) return;
  if (newest_begin_ == faces) {
    ++unused_;
    return;
  }
  const auto [known, added] = known_.emplace(*newest_, static_cast<std::uint32_t>(names_.size()));
  if (added) names_.push_back(*newest_);
  switch_.set(known->second, newest_begin_);
}

void NameSwitch::hand_over(std::string_view name, Meaning meaning, std::string_view what, MeshData& mesh,
                           DroppedCounter& dropped) {
  settle(mesh.face_count());
  dropped.add(what, unused_);
  if (!switch_.used()) return;
  Attribute attribute;
  AttributeInfo& info = attribute.info;
  attribute.values = switch_.values(mesh.face_count());
  // Names that no face has are gone; the others are numbered as they come.
  constexpr double kNew = -1;
  std::vector<double> number(names_.size(), kNew);
  for (double& value : attribute.values) {
    const auto old = static_cast<std::size_t>(value);
    if (number[old] == kNew) {
      number[old] = static_cast<double>(info.names.size());
      info.names.push_back(names_[old]);
    }
    value = number[old];
  }
  if (std::all_of(info.names.begin(), info.names.end(), [](const std::string& n) { return n.empty(); })) return;
  info.name = name;
  info.of = AttributeOf::face;
  info.type = NumberType::uint32;
  info.meaning = meaning;
  mesh.attributes.push_back(std::move(attribute));
}

}  // namespace ramcdb::mesh_file
