#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "api/mesh_file/writers.h"

namespace ramcdb::mesh_file {
namespace {

/// Lines of values (vt, vn), each once, numbered in the order of first use.
class ValueLines {
 public:
  explicit ValueLines(const Attribute& attribute) : attribute_(attribute) {
    const std::size_t count = attribute.count();
    line_of_.reserve(count);
    for (std::size_t at = 0; at < count; ++at) line_of_.push_back(line_for(at));
  }

  /// Counted from 1; 0 for values that are none.
  [[nodiscard]] std::uint32_t line_of(std::size_t at) const { return line_of_[at]; }

  void write(NewFile& out, std::string_view keyword) const {
    for (const std::size_t at : firsts_) {
      out.text(keyword);
      for (const double number : value_of(attribute_, at)) {
        out.text(" ");
        write_number(out, attribute_.info.type, number);
      }
      out.text("\n");
    }
  }

 private:
  std::uint32_t line_for(std::size_t at) {
    std::uint64_t hash = 0;
    bool here = false;
    for (const double number : value_of(attribute_, at)) {
      here |= !std::isnan(number);
      hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 32;
    }
    if (!here) return 0;
    auto [begin, end] = lines_.equal_range(hash);
    for (; begin != end; ++begin)
      if (same(firsts_[begin->second - 1], at)) return begin->second;
    firsts_.push_back(at);
    const auto line = static_cast<std::uint32_t>(firsts_.size());
    lines_.emplace(hash, line);
    return line;
  }

  [[nodiscard]] bool same(std::size_t a, std::size_t b) const {
    const auto x = value_of(attribute_, a), y = value_of(attribute_, b);
    for (std::size_t k = 0; k < x.size(); ++k)
      if (std::bit_cast<std::uint64_t>(x[k]) != std::bit_cast<std::uint64_t>(y[k])) return false;
    return true;
  }

  const Attribute& attribute_;
  std::vector<std::uint32_t> line_of_;
  std::vector<std::size_t> firsts_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> lines_;
};

/// A face attribute that OBJ writes as a line wherever it changes.
struct Switch {
  const Attribute* attribute;
  std::string_view keyword;
};

class ObjWriter {
 public:
  ObjWriter(NewFile& out, const MeshOutput& mesh) : out_(out), mesh_(mesh) {
    for (const Attribute& attribute : mesh.attributes)
      if (!take(attribute)) dropped_.push_back(dropped_attribute(attribute));
  }

  std::vector<Dropped> run() {
    for (const std::string& reference : mesh_.references)
      out_.text(fmt::format("{}{}\n", reference.starts_with("mtllib ") ? "" : "# ", reference));
    write_vertices();
    if (texture_) texture_lines_.emplace(*texture_).write(out_, "vt");
    if (normal_) normal_lines_.emplace(*normal_).write(out_, "vn");
    for_each_face(mesh_, [&](std::size_t f, std::span<const std::uint32_t> face, std::size_t first) {
      write_switches(f);
      write_face(face, first);
    });
    return std::move(dropped_);
  }

 private:
  bool take(const Attribute& attribute) {
    const AttributeInfo& info = attribute.info;
    if (info.of == AttributeOf::face && info.components == 1) {
      const std::string_view keyword = info.meaning == Meaning::material ? "usemtl"
                                       : info.meaning == Meaning::group  ? (info.name == "object" ? "o" : "g")
                                       : info.name == "smoothing"        ? "s"
                                                                         : "";
      if (keyword.empty()) return false;
      switches_.push_back({&attribute, keyword});
      return true;
    }
    const Attribute*& slot = info.meaning == Meaning::texture  ? texture_
                             : info.meaning == Meaning::normal ? normal_
                                                               : color_;
    const bool fits = info.of == AttributeOf::vertex
                          ? info.meaning != Meaning::other && info.meaning < Meaning::material
                          : info.of == AttributeOf::corner && info.meaning != Meaning::color;
    const bool known = info.meaning == Meaning::texture || info.meaning == Meaning::normal ||
                       (info.meaning == Meaning::color && info.components >= 3);
    if (!fits || !known || slot) return false;
    slot = &attribute;
    if (info.meaning == Meaning::color && info.components > 3)
      dropped_.push_back({"alpha of vertex colours", attribute.count()});
    return true;
  }

  /// Colours are 0..1 in OBJ.
  [[nodiscard]] double level(double number) const {
    switch (color_->info.type) {
      case NumberType::uint8:
        return number / 255;
      case NumberType::uint16:
        return number / 65535;
      default:
        return number;
    }
  }

  void write_vertices() {
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v) {
      out_.text("v");
      for (int a = 0; a < 3; ++a) {
        out_.text(" ");
        out_.number(mesh_.positions[v][a], mesh_.scalar);
      }
      if (color_) {
        const auto scalar = color_->info.type == NumberType::float64 ? Scalar::float64 : Scalar::float32;
        for (const double number : value_of(*color_, v).first(3)) {
          out_.text(" ");
          out_.number(level(number), scalar);
        }
      }
      out_.text("\n");
    }
  }

  void write_switches(std::size_t f) {
    for (const Switch& s : switches_) {
      const double value = s.attribute->values[f];
      if (f > 0 ? value == s.attribute->values[f - 1] : name_of(s, value).empty()) continue;
      out_.text(fmt::format("{} {}\n", s.keyword, name_of(s, value)));
    }
  }

  [[nodiscard]] static std::string name_of(const Switch& s, double value) {
    const auto number = static_cast<std::size_t>(value);
    if (s.keyword == "s") return number == 0 ? "off" : std::to_string(number);
    const auto& names = s.attribute->info.names;
    return number < names.size() ? names[number] : fmt::format("{}_{}", s.attribute->info.name, number);
  }

  void write_face(std::span<const std::uint32_t> face, std::size_t first) {
    out_.text("f");
    for (std::size_t i = 0; i < face.size(); ++i) {
      out_.text(" ");
      out_.whole(std::int64_t{face[i]} + 1);
      const std::uint32_t t = texture_ ? texture_lines_->line_of(at(*texture_, face[i], first + i)) : 0;
      const std::uint32_t n = normal_ ? normal_lines_->line_of(at(*normal_, face[i], first + i)) : 0;
      if (t || n) out_.text("/");
      if (t) out_.whole(t);
      if (n) out_.text("/");
      if (n) out_.whole(n);
    }
    out_.text("\n");
  }

  static std::size_t at(const Attribute& attribute, std::uint32_t vertex, std::size_t corner) {
    return attribute.info.of == AttributeOf::vertex ? vertex : corner;
  }

  NewFile& out_;
  const MeshOutput& mesh_;
  const Attribute *texture_ = nullptr, *normal_ = nullptr, *color_ = nullptr;
  std::optional<ValueLines> texture_lines_, normal_lines_;
  std::vector<Switch> switches_;
  std::vector<Dropped> dropped_;
};

}  // namespace

std::vector<Dropped> write_obj(NewFile& out, const MeshOutput& mesh) { return ObjWriter(out, mesh).run(); }

}  // namespace ramcdb::mesh_file
