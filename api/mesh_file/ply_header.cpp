#include "api/mesh_file/ply_header.h"

#include <fmt/format.h>

namespace ramcdb::mesh_file::ply {
namespace {

std::optional<Type> type_of(std::string_view name) {
  static constexpr std::pair<std::string_view, Type> kNames[] = {
      {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
      {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
      {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
      {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64}};
  for (const auto& [known, type] : kNames)
    if (known == name) return type;
  return std::nullopt;
}

Role role_of(const Element& element, const Property& p) {
  if (element.name == "vertex" && !p.count_type) {
    if (p.name == "x") return Role::x;
    if (p.name == "y") return Role::y;
    if (p.name == "z") return Role::z;
    if (p.name == "ramcdb_id_hi" && p.type == Type::uint32) return Role::id_high;
    if (p.name == "ramcdb_id_lo" && p.type == Type::uint32) return Role::id_low;
  }
  if (element.name == "face" && p.count_type && !is_float(p.type) &&
      (p.name == "vertex_indices" || p.name == "vertex_index"))
    return Role::indices;
  if (element.name == "face" && p.count_type && is_float(p.type) && p.name == "texcoord") return Role::texcoord;
  return Role::none;
}

class HeaderReader {
 public:
  explicit HeaderReader(const FileBytes& file) : file_(file), scan_(file) {}

  Header run() {
    if (!scan_.next_line() || scan_.word() != "ply") throw scan_.bad("this is not PLY");
    while (true) {
      if (!scan_.next_line()) throw scan_.bad("the header does not end");
      const std::string_view keyword = scan_.word();
      if (keyword == "end_header") break;
      read_line(keyword);
    }
    if (!header_.encoding) throw scan_.bad("the header names no format");
    header_.size = scan_.offset();
    header_.lines = scan_.line();
    check_elements();
    check_counts();
    return std::move(header_);
  }

 private:
  void read_line(std::string_view keyword) {
    if (keyword == "format") {
      read_format(scan_.word());
    } else if (keyword == "element") {
      Element element;
      element.name = scan_.word();
      if (header_.find(element.name)) throw scan_.bad(fmt::format("element '{}' stands twice", shown(element.name)));
      const std::int64_t count = scan_.integer("the count of an element");
      if (count < 0) throw scan_.bad("the count of an element is negative");
      element.count = static_cast<std::uint64_t>(count);
      header_.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      read_property();
    } else if (keyword == "comment") {
      if (scan_.word() == "TextureFile") add_reference(scan_.rest());
    } else if (!keyword.empty() && keyword != "obj_info") {
      throw scan_.bad(fmt::format("unknown header line '{}'", shown(keyword)));
    }
  }

  void add_reference(std::string_view texture) {
    if (!texture.empty()) header_.references.push_back(fmt::format("texture {}", texture));
  }

  void read_format(std::string_view name) {
    if (header_.encoding) throw scan_.bad("the format stands twice");
    if (name == "ascii")
      header_.encoding = Encoding::ascii;
    else if (name == "binary_little_endian")
      header_.encoding = Encoding::little;
    else if (name == "binary_big_endian")
      header_.encoding = Encoding::big;
    else
      throw scan_.bad(fmt::format("unknown encoding '{}'", shown(name)));
  }

  Type read_type() {
    const std::string_view name = scan_.word();
    const auto type = type_of(name);
    if (!type) throw scan_.bad(fmt::format("unknown type '{}'", shown(name)));
    return *type;
  }

  void read_property() {
    if (header_.elements.empty()) throw scan_.bad("a property stands before any element");
    Element& element = header_.elements.back();
    Property p;
    std::string_view first = scan_.word();
    if (first == "list") {
      p.count_type = read_type();
      if (is_float(*p.count_type)) throw scan_.bad("the count type of a list must be an integer");
      first = scan_.word();
    }
    const auto type = type_of(first);
    if (!type) throw scan_.bad(fmt::format("unknown type '{}'", shown(first)));
    p.type = *type;
    p.type_name = first;
    p.name = scan_.word();
    if (p.name.empty()) throw scan_.bad("a property has no name");
    if (std::any_of(p.name.begin(), p.name.end(), [](char c) { return c >= 0 && c < ' '; }))
      throw scan_.bad(fmt::format("the name of a property holds a control character: '{}'", shown(p.name)));
    p.role = role_of(element, p);
    if (p.role != Role::none && element.has(p.role))
      throw scan_.bad(fmt::format("property '{}' stands twice", shown(p.name)));
    element.properties.push_back(std::move(p));
  }

  /// What is not read must not pass for an empty mesh.
  void check_elements() const {
    const Element* vertex = header_.find("vertex");
    if (!vertex) throw scan_.bad("the file has no element 'vertex'");
    if (!vertex->has(Role::x) || !vertex->has(Role::y) || !vertex->has(Role::z))
      throw scan_.bad("vertices have no x, y and z");
    const Element* face = header_.find("face");
    if (face && face->count && !face->has(Role::indices))
      throw scan_.bad("faces have no list vertex_indices of integers");
    const Element* strips = header_.find("tristrips");
    if (strips && strips->count) throw scan_.bad("triangle strips are not read: convert them to faces");
    for (const Element& e : header_.elements)
      if (e.count && e.properties.empty()) throw scan_.bad(fmt::format("element '{}' has no property", shown(e.name)));
  }

  void check_counts() const {
    const bool ascii = header_.encoding == Encoding::ascii;
    // The last number of a text file needs no blank behind it.
    std::size_t left = file_.text().size() - header_.size + ascii;
    for (const Element& e : header_.elements) {
      const std::size_t each = e.least_bytes(ascii);
      if (each && e.count > left / each)
        throw bad_byte(file_, header_.size,
                       fmt::format("the file is cut off: no room for {} of '{}'", e.count, shown(e.name)));
      left -= std::min<std::size_t>(left, e.count * each);
    }
  }

  const FileBytes& file_;
  TextScanner scan_;
  Header header_;
};

}  // namespace

std::size_t Element::least_bytes(bool ascii) const {
  std::size_t bytes = 0;
  for (const Property& p : properties) {
    const std::size_t corners = p.role == Role::indices ? 3 : 0;  // fewer are refused
    bytes += ascii ? 2 + 2 * corners : size_of(p.count_type.value_or(p.type)) + corners * size_of(p.type);
  }
  return bytes;
}

Header read_header(const FileBytes& file) { return HeaderReader(file).run(); }

}  // namespace ramcdb::mesh_file::ply
