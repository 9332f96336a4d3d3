#include "api/mesh_file/off_values.h"

#include <algorithm>
#include <limits>

#include "api/mesh_file/attribute_names.h"

namespace ramcdb::mesh_file {
namespace {

constexpr double kMostByte = 255;

bool is_whole(std::string_view word) { return word.find_first_not_of("0123456789+-") == word.npos; }

}  // namespace

void OffRows::set(const TextScanner& scan, std::size_t vertex, std::span<const std::string_view> words) {
  values_.resize(vertex * components_, kNone);
  for (const std::string_view word : words) values_.push_back(scan.parse_value(word, NumberType::float64));
}

void OffRows::hand_over(std::string_view name, Meaning meaning, MeshData& mesh) {
  if (values_.empty()) return;
  values_.resize(mesh.positions.size() * components_, kNone);
  Attribute attribute;
  attribute.info.name = name;
  attribute.info.type = NumberType::float64;
  attribute.info.components = components_;
  attribute.info.meaning = meaning;
  attribute.values = std::move(values_);
  mesh.attributes.push_back(std::move(attribute));
}

void OffColors::set(const TextScanner& scan, std::size_t i, std::span<const std::string_view> words) {
  double row[kRow] = {kNone, kNone, kNone, kNone};
  for (std::size_t k = 0; k < words.size(); ++k) row[k] = scan.parse_value(words[k], NumberType::float64);
  const auto numbers = std::span<const double>(row).first(words.size());
  if (std::all_of(numbers.begin(), numbers.end(), [](double value) { return value != value; })) return;
  Kind kind = Kind::fraction;
  if (std::all_of(words.begin(), words.end(), is_whole)) {
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    if (*least < 0 || *most > kMostByte) {
      ++wrong_;
      return;
    }
    kind = *most > 1 ? Kind::whole : Kind::whole_up_to_1;
    for (double& value : row) value += 0.0;  // no whole number is -0
  }
  any_fraction_ |= kind == Kind::fraction;
  any_alpha_ |= words.size() == kRow;
  kinds_.resize(i, Kind::none);
  kinds_.push_back(kind);
  values_.resize(i * kRow, kNone);
  values_.insert(values_.end(), row, row + kRow);
}

void OffColors::hand_over(AttributeOf of, std::size_t count, MeshData& mesh, DroppedCounter& dropped) {
  dropped.add("colours beyond 0..255", wrong_);
  if (kinds_.empty()) return;
  const std::size_t components = any_alpha_ ? kRow : kRow - 1;
  const double opaque = any_fraction_ ? 1 : kMostByte;
  Attribute attribute;
  attribute.info.name = unique_name(mesh.attributes, of, "color");
  attribute.info.of = of;
  attribute.info.type = any_fraction_ ? NumberType::float64 : NumberType::uint8;
  attribute.info.components = static_cast<std::uint8_t>(components);
  attribute.info.meaning = Meaning::color;
  attribute.values.assign(count * components, kNone);
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    if (kinds_[i] == Kind::none) continue;
    const double scale = any_fraction_ && kinds_[i] == Kind::whole ? kMostByte : 1;
    for (std::size_t k = 0; k < components; ++k) {
      const double value = values_[i * kRow + k];
      const bool no_alpha = k + 1 == kRow && value != value;
      attribute.values[i * components + k] = no_alpha ? opaque : value / scale;
    }
  }
  mesh.attributes.push_back(std::move(attribute));
}

}  // namespace ramcdb::mesh_file
