#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "api/mesh_file/file_bytes.h"

/// STL, a soup of triangles. Binary: 80 bytes of anything, u32 count, then 50 bytes a triangle, little-endian: normal,
/// three corners, u16 attribute. Which of the two kinds a file is, its length tells, and where that is not what the
/// count says, the count's last byte, a NUL that no text has; not the word "solid". Text: words in any case, a line
/// each, and an "endsolid" without which the file is cut off.
namespace ramcdb::mesh_file {
namespace {

static_assert(std::endian::native == std::endian::little, "byte order of STL and PLY readers");

constexpr std::size_t kHeader = 84, kRecord = 50;

template <class T>
T load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// A word in lower case; exporters of old shout.
std::string lower(std::string_view word) {
  std::string text(word.substr(0, 40));
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

bool begins_as_text(std::string_view text) {
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return lower(text.substr(0, 5)) == "solid";
}

/// Adds corners to a mesh, each with a vertex of its own.
class Soup {
 public:
  Soup(MeshData& mesh, MeshSink* sink) : mesh_(mesh), sink_(sink) {}

  void add_corner(const Point& p) {
    mesh_.corners.push_back(vertices_++);
    mesh_.positions.push_back(p);
  }
  void end_facet() {
    if (sink_ && mesh_.corners.size() >= kPiece) sink_->take(mesh_);
  }

 private:
  MeshData& mesh_;
  MeshSink* sink_;
  std::uint32_t vertices_ = 0;
};

/// The bytes behind each facet, which some programs keep a colour in.
void add_attribute(MeshData& mesh, std::vector<double> values) {
  Attribute attribute;
  attribute.info.name = "attribute";
  attribute.info.of = AttributeOf::face;
  attribute.info.type = NumberType::uint16;
  attribute.values = std::move(values);
  mesh.attributes.push_back(std::move(attribute));
}

void read_binary(const FileBytes& file, MeshData& mesh, MeshSink* sink, const Progress& progress) {
  const std::string_view text = file.text();
  const auto count = load<std::uint32_t>(text.data() + 80);
  if (count > (text.size() - kHeader) / kRecord)
    throw bad_byte(file, 80,
                   fmt::format("the file is cut off: {} triangles announced, room for {}", count,
                               (text.size() - kHeader) / kRecord));
  Soup soup(mesh, sink);
  if (!sink) mesh.positions.reserve(3 * std::size_t{count});
  if (!sink) mesh.corners.reserve(3 * std::size_t{count});
  std::vector<double> attributes;  // none when all are zero
  for (std::uint32_t f = 0; f < count; ++f) {
    const char* at = text.data() + kHeader + kRecord * f;
    for (int c = 0; c < 3; ++c) {
      const char* p = at + 12 + 12 * c;
      soup.add_corner({load<float>(p), load<float>(p + 4), load<float>(p + 8)});
    }
    soup.end_facet();
    const auto attribute = load<std::uint16_t>(at + 48);
    if (attribute && sink) throw NotInPieces("facets with attributes", file.name());
    if (attribute && attributes.empty()) attributes.resize(count);
    if (attribute) attributes[f] = attribute;
    if (progress && f % 65536 == 0) progress(static_cast<double>(f) / count);
  }
  if (!attributes.empty()) add_attribute(mesh, std::move(attributes));
  DroppedCounter dropped;
  dropped.add("bytes behind the last facet", text.size() - kHeader - kRecord * std::size_t{count});
  mesh.dropped = dropped.take();
}

void read_ascii(const FileBytes& file, MeshData& mesh, MeshSink* sink, const Progress& progress) {
  Soup soup(mesh, sink);
  TextScanner scan(file, 0, 0, progress);
  std::size_t corners = 0;
  DroppedCounter dropped;
  bool in_solid = false, in_facet = false, any = false;
  while (scan.next_line()) {
    const std::string keyword = lower(scan.word());
    if (keyword == "facet") {
      if (in_facet) throw scan.bad("a facet begins inside another");
      in_facet = any = true;
      corners = 0;
    } else if (keyword == "vertex") {
      if (!in_facet) throw scan.bad("a vertex stands outside a facet");
      if (++corners > 3) throw scan.bad("a facet has more than three vertices");
      Point p;
      for (int a = 0; a < 3; ++a) p[a] = scan.number("a coordinate");
      soup.add_corner(p);
      if (!scan.word().empty()) dropped.add("further words behind coordinates");
    } else if (keyword == "endfacet") {
      if (!in_facet) throw scan.bad("an 'endfacet' without a facet");
      if (corners != 3) throw scan.bad(fmt::format("a facet has {} vertices", corners));
      soup.end_facet();
      in_facet = false;
    } else if (keyword == "solid" || keyword == "endsolid") {
      in_solid = keyword == "solid";
    } else if (!keyword.empty() && keyword != "outer" && keyword != "endloop") {
      throw scan.bad(fmt::format("'{}' is not STL", shown(keyword)));
    }
  }
  if (in_facet) throw scan.bad("the file is cut off: no 'endfacet'");
  if (in_solid) throw scan.bad("the file is cut off: no 'endsolid'");
  if (!any) throw scan.bad("the file holds no facet");
  mesh.dropped = dropped.take();
}

/// Throws for a file that is neither.
bool is_binary(const FileBytes& file) {
  const std::string_view text = file.text();
  const bool begins_solid = begins_as_text(text) && (text.size() < kHeader || text[kHeader - 1] != '\0');
  const bool fits_binary =
      text.size() >= kHeader && kHeader + kRecord * std::uint64_t{load<std::uint32_t>(text.data() + 80)} == text.size();
  if (!fits_binary && !begins_solid && text.size() < kHeader)
    throw bad_byte(file, text.size(), "the file is too short for STL");
  return fits_binary || !begins_solid;
}

}  // namespace

std::uint64_t count_stl_faces(const FileBytes& file) {
  constexpr std::size_t kTextOfFacet = 200;
  return is_binary(file) ? load<std::uint32_t>(file.text().data() + 80) : file.text().size() / kTextOfFacet;
}

void read_stl(const FileBytes& file, MeshData& mesh, MeshSink* sink, const Progress& progress) {
  if (is_binary(file))
    read_binary(file, mesh, sink, progress);
  else
    read_ascii(file, mesh, sink, progress);
  mesh.soup = true;
}

}  // namespace ramcdb::mesh_file
