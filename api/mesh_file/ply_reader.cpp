#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "api/mesh_file/file_bytes.h"

/// PLY, text and both binary byte orders. Kept: x, y, z of the element "vertex"; the list vertex_indices (or
/// vertex_index) of "face"; our own vertex ids. Everything else is skipped by its size and named.
namespace ramcdb::mesh_file {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

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

std::size_t size_of(Type type) {
  static constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

bool is_integer(Type type) { return type != Type::float32 && type != Type::float64; }

/// What becomes of a property.
enum class Role { x, y, z, id_high, id_low, indices, none };

struct Property {
  std::string name, type_name;
  Type type = Type::float32;
  std::optional<Type> count_type;  ///< of a list
  Role role = Role::none;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  /// Fewest bytes that one of it takes.
  [[nodiscard]] std::size_t least_bytes(bool ascii) const {
    std::size_t bytes = 0;
    for (const Property& p : properties) bytes += ascii ? 2 : size_of(p.count_type.value_or(p.type));
    return bytes;
  }
  [[nodiscard]] bool has(Role role) const {
    return std::any_of(properties.begin(), properties.end(), [&](const Property& p) { return p.role == role; });
  }
};

enum class Encoding { ascii, little, big };

struct Header {
  std::optional<Encoding> encoding;
  std::vector<Element> elements;
  std::size_t size = 0, lines = 0;

  [[nodiscard]] const Element* find(std::string_view name) const {
    const auto found = std::find_if(elements.begin(), elements.end(), [&](const Element& e) { return e.name == name; });
    return found == elements.end() ? nullptr : &*found;
  }
};

Role role_of(const Element& element, const Property& p) {
  if (element.name == "vertex" && !p.count_type) {
    if (p.name == "x") return Role::x;
    if (p.name == "y") return Role::y;
    if (p.name == "z") return Role::z;
    if (p.name == "ramcdb_id_hi" && p.type == Type::uint32) return Role::id_high;
    if (p.name == "ramcdb_id_lo" && p.type == Type::uint32) return Role::id_low;
  }
  if (element.name == "face" && p.count_type && is_integer(p.type) &&
      (p.name == "vertex_indices" || p.name == "vertex_index"))
    return Role::indices;
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
    } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
      throw scan_.bad(fmt::format("unknown header line '{}'", shown(keyword)));
    }
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
      if (!is_integer(*p.count_type)) throw scan_.bad("the count type of a list must be an integer");
      first = scan_.word();
    }
    const auto type = type_of(first);
    if (!type) throw scan_.bad(fmt::format("unknown type '{}'", shown(first)));
    p.type = *type;
    p.type_name = first;
    p.name = scan_.word();
    if (p.name.empty()) throw scan_.bad("a property has no name");
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
    std::size_t left = file_.text().size() - header_.size;
    for (const Element& e : header_.elements) {
      const std::size_t each = e.least_bytes(header_.encoding == Encoding::ascii);
      // The last number of a text file needs no blank behind it.
      if (each && e.count > (left + 1) / each)
        throw bad_byte(file_, header_.size,
                       fmt::format("the file is cut off: no room for {} of '{}'", e.count, shown(e.name)));
      left -= std::min<std::size_t>(left, e.count * each);
    }
  }

  const FileBytes& file_;
  TextScanner scan_;
  Header header_;
};

/// Values of a text body.
class AsciiValues {
 public:
  AsciiValues(const FileBytes& file, const Header& header, const Progress& progress)
      : scan_(file, header.size, header.lines, progress) {}

  double number(Type) { return scan_.number_anywhere("a value"); }
  std::uint64_t whole(Type) {
    const std::int64_t value = scan_.integer_anywhere("a value");
    if (value < 0) refuse(fmt::format("{} is negative", value));
    return static_cast<std::uint64_t>(value);
  }
  void skip(Type, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i)
      if (scan_.word_anywhere().empty()) refuse("the file is cut off");
  }
  [[nodiscard]] std::size_t left_for(Type) const { return scan_.left() / 2 + 1; }
  [[noreturn]] void refuse(std::string_view what) const { throw scan_.bad(what); }
  [[nodiscard]] bool at_end() { return scan_.word_anywhere().empty(); }
  [[nodiscard]] bool saw_doubles() const { return scan_.saw_doubles(); }

 private:
  TextScanner scan_;
};

/// Values of a binary body.
template <std::endian order>
class BinaryValues {
 public:
  BinaryValues(const FileBytes& file, const Header& header) : file_(file), at_(header.size) {}

  double number(Type type) {
    const char* p = take(size_of(type));
    switch (type) {
      case Type::int8:
        return load<std::int8_t>(p);
      case Type::uint8:
        return load<std::uint8_t>(p);
      case Type::int16:
        return load<std::int16_t>(p);
      case Type::uint16:
        return load<std::uint16_t>(p);
      case Type::int32:
        return load<std::int32_t>(p);
      case Type::uint32:
        return load<std::uint32_t>(p);
      case Type::float32:
        return load<float>(p);
      case Type::float64:
        break;
    }
    return load<double>(p);
  }
  std::uint64_t whole(Type type) {
    const double value = number(type);
    if (!(value >= 0)) refuse(fmt::format("{} is negative", value));
    return static_cast<std::uint64_t>(value);
  }
  void skip(Type type, std::uint64_t count) {
    if (count > left_for(type)) refuse("the file is cut off");
    at_ += static_cast<std::size_t>(count) * size_of(type);
  }
  [[nodiscard]] std::size_t left_for(Type type) const { return (file_.text().size() - at_) / size_of(type); }
  [[noreturn]] void refuse(std::string_view what) const { throw bad_byte(file_, at_, what); }
  [[nodiscard]] bool at_end() const { return at_ == file_.text().size(); }
  [[nodiscard]] bool saw_doubles() const { return false; }

 private:
  const char* take(std::size_t bytes) {
    if (bytes > file_.text().size() - at_) refuse("the file is cut off");
    at_ += bytes;
    return file_.text().data() + at_ - bytes;
  }
  template <class T>
  static T load(const char* p) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, p, sizeof(T));
    if constexpr (order != std::endian::native) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  const FileBytes& file_;
  std::size_t at_;
};

template <class Values>
class BodyReader {
 public:
  BodyReader(Values values, const Header& header, MeshData& mesh, const Progress& progress)
      : values_(std::move(values)),
        header_(header),
        vertices_(header.find("vertex")->count),
        mesh_(mesh),
        progress_(progress) {}

  void run() {
    for (const Element& element : header_.elements) {
      name_dropped(element);
      if (element.name == "vertex")
        read_vertices(element);
      else
        read_others(element);
    }
    if (!values_.at_end()) dropped_.add("bytes behind the last element");
    if (values_.saw_doubles()) mesh_.scalar = Scalar::float64;
    dropped_.hand_over(mesh_);
  }

 private:
  void name_dropped(const Element& element) {
    if (element.name != "vertex" && element.name != "face") {
      dropped_.add(fmt::format("element '{}'", shown(element.name)), element.count);
      return;
    }
    for (const Property& p : element.properties)
      if (p.role == Role::none)
        dropped_.add(fmt::format("{} property '{}' ({}{})", element.name, shown(p.name), p.count_type ? "list of " : "",
                                 p.type_name),
                     element.count);
  }

  void read_vertices(const Element& element) {
    const bool ids = element.has(Role::id_high) && element.has(Role::id_low);
    mesh_.positions.reserve(element.count);
    if (ids) mesh_.vertex_ids.reserve(element.count);
    for (const Property& p : element.properties)
      if (p.role <= Role::z && (p.type == Type::float64 || p.type == Type::int32 || p.type == Type::uint32))
        mesh_.scalar = Scalar::float64;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      Point position;
      std::uint64_t high = 0, low = 0;
      for (const Property& p : element.properties) {
        switch (p.role) {
          case Role::x:
            position.x = values_.number(p.type);
            break;
          case Role::y:
            position.y = values_.number(p.type);
            break;
          case Role::z:
            position.z = values_.number(p.type);
            break;
          case Role::id_high:
            high = values_.whole(p.type);
            break;
          case Role::id_low:
            low = values_.whole(p.type);
            break;
          default:
            skip(p);
        }
      }
      mesh_.positions.push_back(position);
      if (ids) mesh_.vertex_ids.push_back(high << 32 | (low & 0xffffffffU));
      report(i, element.count);
    }
  }

  void read_others(const Element& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const Property& p : element.properties) {
        if (p.role == Role::indices)
          read_face(p);
        else
          skip(p);
      }
      report(i, element.count);
    }
  }

  void read_face(const Property& p) {
    const std::uint64_t corners = values_.whole(*p.count_type);
    if (corners < 3) values_.refuse(fmt::format("a face has {} corners", corners));
    if (corners > values_.left_for(p.type)) values_.refuse("the file is cut off");
    for (std::uint64_t c = 0; c < corners; ++c) {
      const std::uint64_t v = values_.whole(p.type);
      if (v >= vertices_) values_.refuse(fmt::format("vertex index {} does not exist ({} vertices)", v, vertices_));
      mesh_.corners.push_back(static_cast<std::uint32_t>(v));
    }
    mesh_.face_sizes.push_back(static_cast<std::uint32_t>(corners));
  }

  void skip(const Property& p) { values_.skip(p.type, p.count_type ? values_.whole(*p.count_type) : 1); }

  void report(std::uint64_t i, std::uint64_t count) const {
    if (progress_ && i % 65536 == 0) progress_(static_cast<double>(i) / static_cast<double>(count));
  }

  Values values_;
  const Header& header_;
  std::uint64_t vertices_;
  MeshData& mesh_;
  const Progress& progress_;
  DroppedCounter dropped_;
};

}  // namespace

void read_ply(const FileBytes& file, MeshData& mesh, const Progress& progress) {
  const Header header = HeaderReader(file).run();
  switch (*header.encoding) {
    case Encoding::ascii:
      BodyReader(AsciiValues(file, header, progress), header, mesh, progress).run();
      break;
    case Encoding::little:
      BodyReader(BinaryValues<std::endian::little>(file, header), header, mesh, progress).run();
      break;
    case Encoding::big:
      BodyReader(BinaryValues<std::endian::big>(file, header), header, mesh, progress).run();
      break;
  }
}

}  // namespace ramcdb::mesh_file
