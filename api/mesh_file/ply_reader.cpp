#include <fmt/format.h>

#include "api/mesh_file/ply_values.h"

/// PLY, text and both binary byte orders. Kept: x, y, z of the element "vertex"; the list vertex_indices (or
/// vertex_index) of "face"; our own vertex ids. Everything else is skipped by its size and named.
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
      name_dropped(element);
      if (element.name == "vertex")
        read_vertices(element);
      else
        read_others(element);
    }
    if (!values_.at_end()) dropped_.add("bytes behind the last element");
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
          skip(p);
      add_vertex(values, ids);
      report(i, element.count);
    }
  }

  double id_half(Type type) {
    const std::uint64_t half = values_.whole(type);
    if (half > 0xffffffffU) values_.refuse(fmt::format("{} is no half of a vertex id", half));
    return static_cast<double>(half);
  }

  /// Vertices of the same size each: the values that are kept stand at fixed places.
  void read_rows(const Element& element, bool ids) {
    std::size_t size = 0, places[kRoles] = {};
    Type types[kRoles] = {};
    for (const Property& p : element.properties) {
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
      for (const Property& p : element.properties) {
        if (p.role == Role::indices)
          end_face(mesh_, read_corners(p));
        else
          skip(p);
      }
      report(i, element.count);
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
