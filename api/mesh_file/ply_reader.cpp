#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "api/mesh_file/ply_attributes.h"
#include "api/mesh_file/ply_values.h"

/// PLY, text and both binary byte orders. Kept: x, y, z of the element "vertex"; the list vertex_indices (or
/// vertex_index) of "face"; our own vertex ids; all other numbers of vertices and faces and the list texcoord of faces,
/// as attributes. Everything else is skipped by its size and named.
namespace ramcdb::mesh_file {
namespace {

using namespace ply;

/// Roles of numbers of a vertex, from x to the lower half of its id.
constexpr std::size_t kRoles = 5;
static_assert(kRoles == static_cast<std::size_t>(Role::indices));

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
      columns_.assign(element.properties.size(), {});
      if (element.name == "vertex" || element.name == "face") columns_ = plan_attributes(element, mesh_.attributes);
      name_dropped(element);
      if (element.name == "vertex")
        read_vertices(element);
      else
        read_others(element);
    }
    if (!values_.at_end()) dropped_.add("bytes behind the last element");
    for (const std::string& texture : header_.textures) mesh_.references.push_back("texture " + texture);
    dropped_.hand_over(mesh_);
  }

 private:
  void name_dropped(const Element& element) {
    if (element.name != "vertex" && element.name != "face") {
      dropped_.add(fmt::format("element '{}'", shown(element.name)), element.count);
      return;
    }
    for (const Property& p : element.properties)
      if (p.role == Role::none && column_of(element, p).attribute == Column::kNone)
        dropped_.add(fmt::format("{} property '{}' ({}{})", element.name, shown(p.name), p.count_type ? "list of " : "",
                                 p.type_name),
                     element.count);
  }

  [[nodiscard]] const Column& column_of(const Element& element, const Property& p) const {
    return columns_[static_cast<std::size_t>(&p - element.properties.data())];
  }

  void read_vertices(const Element& element) {
    const bool ids = element.has(Role::id_high) && element.has(Role::id_low);
    mesh_.positions.reserve(element.count);
    if (ids) mesh_.vertex_ids.reserve(element.count);
    if constexpr (Values::kBinary) {
      const bool fixed = std::none_of(element.properties.begin(), element.properties.end(),
                                      [](const Property& p) { return p.count_type.has_value(); });
      if (fixed) return read_rows(element, ids);
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      double values[kRoles] = {};
      for (const Property& p : element.properties)
        if (p.role <= Role::z)
          values[static_cast<std::size_t>(p.role)] = values_.number(p.type);
        else if (p.role < Role::indices)
          values[static_cast<std::size_t>(p.role)] = id_half(p.type);
        else
          read_other(p, column_of(element, p), i);
      add_vertex(values, ids);
      report(i, element.count);
    }
  }

  /// A number of an attribute, or what is skipped.
  void read_other(const Property& p, const Column& column, std::uint64_t i) {
    if (column.attribute == Column::kNone) return skip(p);
    const double number = values_.any_number(p.type);
    const Range range = range_of(p.type);
    if (!Values::kBinary && range.high < 1e300 &&
        !(number >= range.low && number <= range.high &&
          number == static_cast<double>(static_cast<std::int64_t>(number))))
      values_.refuse(fmt::format("{} is no number of type {}", number, p.type_name));
    Attribute& attribute = mesh_.attributes[column.attribute];
    attribute.values[i * attribute.info.components + column.component] = number;
  }

  double id_half(Type type) {
    const std::uint64_t half = values_.whole(type);
    if (half > 0xffffffffU) values_.refuse(fmt::format("{} is no half of a vertex id", half));
    return static_cast<double>(half);
  }

  /// Vertices of the same size each: the values that are kept stand at fixed places.
  void read_rows(const Element& element, bool ids) {
    struct Source {
      std::size_t place;
      Type type;
      double* to;
      std::size_t step;
    };
    std::vector<Source> others;
    std::size_t size = 0, places[kRoles] = {};
    Type types[kRoles] = {};
    for (const Property& p : element.properties) {
      if (const Column& column = column_of(element, p); column.attribute != Column::kNone) {
        Attribute& attribute = mesh_.attributes[column.attribute];
        others.push_back({size, p.type, attribute.values.data() + column.component, attribute.info.components});
      }
      if (p.role < Role::indices) {
        places[static_cast<std::size_t>(p.role)] = size;
        types[static_cast<std::size_t>(p.role)] = p.type;
      }
      size += size_of(p.type);
    }
    const std::size_t roles = ids ? kRoles : 3;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const char* row = values_.row(size);
      double values[kRoles] = {};
      for (std::size_t r = 0; r < roles; ++r) values[r] = Values::number_at(row + places[r], types[r]);
      add_vertex(values, ids);
      for (Source& other : others) {
        *other.to = Values::number_at(row + other.place, other.type);
        other.to += other.step;
      }
      report(i, element.count);
    }
  }

  /// From x, y, z and both halves of its id, which double holds.
  void add_vertex(const double (&values)[kRoles], bool ids) {
    mesh_.positions.push_back({values[0], values[1], values[2]});
    if (ids)
      mesh_.vertex_ids.push_back(static_cast<std::uint64_t>(values[3]) << 32 | static_cast<std::uint64_t>(values[4]));
  }

  void read_others(const Element& element) {
    // As if all were triangles; the count was checked against the file.
    if (element.name == "face") mesh_.corners.reserve(3 * element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const std::size_t first = mesh_.corners.size();
      for (const Property& p : element.properties) {
        const Column& column = column_of(element, p);
        if (p.role == Role::indices)
          end_face(mesh_, read_corners(p));
        else if (column.is_texture_list)
          read_texture_list(p);
        else
          read_other(p, column, i);
      }
      end_texture_lists(element, mesh_.corners.size() - first);
      report(i, element.count);
    }
  }

  void read_texture_list(const Property& p) {
    const std::uint64_t count = values_.whole(*p.count_type);
    if (count > values_.left_for(p.type)) values_.refuse("the file is cut off");
    texture_list_.clear();
    for (std::uint64_t n = 0; n < count; ++n) texture_list_.push_back(values_.any_number(p.type));
  }

  /// Two numbers per corner; lists of another length say nothing.
  void end_texture_lists(const Element& element, std::size_t corners) {
    for (const Property& p : element.properties) {
      const Column& column = column_of(element, p);
      if (!column.is_texture_list) continue;
      if (texture_list_.size() != 2 * corners) {
        if (!texture_list_.empty()) dropped_.add("texture lists with another number of corners than their face");
        texture_list_.assign(2 * corners, std::numeric_limits<double>::quiet_NaN());
      }
      auto& values = mesh_.attributes[column.attribute].values;
      values.insert(values.end(), texture_list_.begin(), texture_list_.end());
    }
  }

  std::uint32_t read_corners(const Property& p) {
    const std::uint64_t corners = values_.whole(*p.count_type);
    if (corners < 3) values_.refuse(fmt::format("a face has {} corners", corners));
    if (corners > values_.left_for(p.type) || corners > 0xffffffffU) values_.refuse("the file is cut off");
    const auto size = static_cast<std::uint32_t>(corners);
    if constexpr (Values::kBinary)
      if (values_.indices(p.type, size, vertices_, mesh_.corners)) return size;
    for (std::uint32_t c = 0; c < size; ++c) {
      const std::uint64_t v = values_.whole(p.type);
      if (v >= vertices_) values_.refuse(fmt::format("vertex index {} does not exist ({} vertices)", v, vertices_));
      mesh_.corners.push_back(static_cast<std::uint32_t>(v));
    }
    return size;
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
  std::vector<Column> columns_;  ///< of the element at hand
  std::vector<double> texture_list_;
};

}  // namespace

void read_ply(const FileBytes& file, MeshData& mesh, const Progress& progress) {
  const Header header = read_header(file);
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
