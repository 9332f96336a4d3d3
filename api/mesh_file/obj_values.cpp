#include "api/mesh_file/obj_values.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace ramcdb::mesh_file {
namespace {

/// Which values are equal, bit by bit, so that -0 is not 0: a hash table of lines, half empty at least.
class KnownLines {
 public:
  KnownLines(const AttributeView& attribute, std::vector<std::size_t>& values)
      : numbers_(attribute.values), components_(attribute.info.components), values_(values), slots_(1024) {}

  /// The line of value i, which is added if there is none yet. From 1.
  std::uint32_t line(std::size_t i) {
    if (2 * values_.size() >= slots_.size()) grow();
    std::uint32_t& slot = find(i);
    if (!slot) {
      values_.push_back(i);
      slot = static_cast<std::uint32_t>(values_.size());
    }
    return slot;
  }

 private:
  [[nodiscard]] const double* at(std::size_t i) const { return &numbers_[i * components_]; }

  [[nodiscard]] std::size_t hash(std::size_t i) const {
    std::uint64_t mixed = 0;
    for (std::size_t k = 0; k < components_; ++k) {
      mixed = (mixed ^ std::bit_cast<std::uint64_t>(at(i)[k])) * 0x9e3779b97f4a7c15U;
      mixed ^= mixed >> 32;
    }
    return static_cast<std::size_t>(mixed);
  }

  /// Where the line of value i stands, or would.
  std::uint32_t& find(std::size_t i) {
    std::size_t s = hash(i) & (slots_.size() - 1);
    while (slots_[s] && std::memcmp(at(values_[slots_[s] - 1]), at(i), components_ * sizeof(double)) != 0)
      s = (s + 1) & (slots_.size() - 1);
    return slots_[s];
  }

  void grow() {
    slots_.assign(2 * slots_.size(), 0);
    for (std::size_t line = 0; line < values_.size(); ++line)
      find(values_[line]) = static_cast<std::uint32_t>(line + 1);
  }

  std::span<const double> numbers_;
  std::size_t components_;
  std::vector<std::size_t>& values_;  ///< per line
  std::vector<std::uint32_t> slots_;  ///< lines, 0: none; a power of two of them
};

/// A line of OBJ ends at its end: a name keeps no control character, no blank around it, and no backslash behind it.
std::string obj_name(std::string_view name) {
  std::string word(name);
  for (char& c : word)
    if (static_cast<unsigned char>(c) < ' ') c = '_';
  word.erase(0, std::min(word.find_first_not_of(' '), word.size()));
  word.erase(word.find_last_not_of(' ') + 1);
  if (!word.empty() && word.back() == '\\') word.back() = '_';
  return word;
}

}  // namespace

CornerLines::CornerLines(const AttributeView& attribute, const MeshOutput& mesh, DroppedCounter& dropped)
    : attribute_(&attribute), lines_(attribute.count()) {
  const bool of_corners = attribute.info.of == AttributeOf::corner;
  std::vector<bool> seen(attribute.count());
  KnownLines known(attribute, values_);
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    const std::size_t i = of_corners ? c : mesh.corners[c];
    if (seen[i]) continue;
    seen[i] = true;
    if (!is_none(attribute, i)) lines_[i] = known.line(i);
  }
  std::uint64_t unused = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) unused += !seen[i] && !is_none(attribute, i);
  dropped.add(fmt::format("attribute '{}' of vertices without a face", shown(attribute.info.name)), unused);
}

void CornerLines::write(NewFile& out, std::string_view keyword) const {
  const std::size_t n = attribute_->info.components;
  for (const std::size_t i : values_) {
    out.text(keyword);
    for (std::size_t k = 0; k < n; ++k) {
      out.text(" ");
      out.number(attribute_->values[i * n + k], attribute_->info.type);
    }
    out.text("\n");
  }
}

NameLines::NameLines(const AttributeView& attribute, std::string_view keyword, DroppedCounter& dropped)
    : attribute_(attribute), keyword_(keyword) {
  std::uint64_t changed = 0;
  for (const std::string& name : attribute.info.names) {
    names_.push_back(obj_name(name));
    changed += names_.back() != name;
  }
  dropped.add(fmt::format("names of attribute '{}' with characters that were changed", shown(attribute.info.name)),
              changed);
}

void NameLines::write(NewFile& out, std::size_t face) {
  const double value = attribute_.values[face];
  const std::string_view name = value >= 0 ? std::string_view(names_[static_cast<std::size_t>(value)]) : "";
  if (name == current_) return;
  current_ = name;
  out.text(keyword_);
  if (!name.empty()) out.text(" ");
  out.text(name);
  out.text("\n");
}

}  // namespace ramcdb::mesh_file
