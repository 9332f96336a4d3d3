#include <fmt/format.h>

#include <limits>

#include "api/mesh_file/attribute_names.h"
#include "api/mesh_file/ply_columns.h"
#include "api/mesh_file/ply_values.h"

/// PLY, text and both binary byte orders. Kept: x, y, z of the element "vertex"; the list vertex_indices (or
/// vertex_index) of "face"; our own vertex ids; every other number of vertices and faces, and the list "texcoord" of
/// faces, as attributes. Other lists and elements are skipped by their size and named.
namespace ramcdb::mesh_file {
namespace {

using namespace ply;
using Kind = Target::Kind;

/// Binary vertices are taken by so many bytes, property by property: they stay in the cache.
constexpr std::size_t kBlockBytes = 1 << 14;

template <class Values>
class BodyReader {
 public:
  BodyReader(Values values, const Header& header, MeshData& mesh, MeshSink* sink, const Progress& progress)
      : values_(std::move(values)),
        vertex_(*header.find("vertex")),
        vertices_(vertex_.count),
        mesh_(mesh),
        sink_(sink),
        progress_(progress) {
    // Vertices first: a face's attribute of the same name gets another.
    vertex_targets_ = plan_columns(vertex_, mesh, dropped_);
    if (const Element* face = header.find("face")) face_targets_ = plan_columns(*face, mesh, dropped_);
  }

  void run(const Header& header) {
    for (const Element& element : header.elements) {
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else
        skip_element(element);
    }
    if (!values_.at_end()) dropped_.add("bytes behind the last element");
    mesh_.dropped = dropped_.take();
  }

 private:
  /// The count was checked against the file: every element takes some bytes.
  void take_memory(const std::vector<Target>& targets, std::size_t count) {
    for (const Target& target : targets)
      if (target.kind == Kind::value) mesh_.attributes[target.attribute].values.resize(count * target.components);
  }

  /// Calls read(begin, count) for an element, piece by piece where there is a sink.
  template <class Read>
  void in_pieces(const Element& element, Read&& read) {
    const std::size_t all = element.count, most = sink_ ? kPiece : std::max<std::size_t>(all, 1);
    for (std::size_t begin = 0; begin < all; begin += most) {
      read(begin, std::min(most, all - begin));
      if (sink_) sink_->take(mesh_);
    }
  }

  void read_vertices(const Element& element) {
    const bool fixed = Values::kBinary && std::none_of(element.properties.begin(), element.properties.end(),
                                                       [](const Property& p) { return p.count_type.has_value(); });
    in_pieces(element, [&](std::size_t begin, std::size_t count) {
      mesh_.positions.resize(count);
      if (has(vertex_targets_, Kind::id_half)) mesh_.vertex_ids.assign(count, 0);
      take_memory(vertex_targets_, count);
      if constexpr (Values::kBinary)
        if (fixed) return read_rows(element, begin, count);
      for (std::size_t v = 0; v < count; ++v) {
        for (std::size_t p = 0; p < element.properties.size(); ++p)
          read_number(element.properties[p], vertex_targets_[p], v);
        report(begin + v, element.count);
      }
    });
  }

  [[nodiscard]] static bool has(const std::vector<Target>& targets, Kind kind) {
    return std::any_of(targets.begin(), targets.end(), [&](const Target& target) { return target.kind == kind; });
  }

  /// One property of vertex or face i, unless it is the list of corners or of their texture coordinates.
  void read_number(const Property& p, const Target& target, std::size_t i) {
    switch (target.kind) {
      case Kind::axis:
        mesh_.positions[i][target.axis] = values_.number(p.type);
        break;
      case Kind::id_half:
        mesh_.vertex_ids[i] |= id_half(p.type) << target.axis;
        break;
      case Kind::value:
        mesh_.attributes[target.attribute].values[i * target.components + target.component] = values_.value(p.type);
        break;
      default:
        values_.skip(p.type, p.count_type ? values_.whole(*p.count_type) : 1);
    }
  }

  std::uint64_t id_half(Type type) {
    const std::uint64_t half = values_.whole(type);
    if (half > 0xffffffffU) values_.refuse(fmt::format("{} is no half of a vertex id", half));
    return half;
  }

  /// Vertices of the same size each: the values of a property stand at fixed places.
  /// \param before vertices of earlier pieces
  void read_rows(const Element& element, std::size_t before, std::size_t all) {
    std::size_t size = 0;
    for (const Property& p : element.properties) size += size_of(p.type);
    const std::size_t block = std::max<std::size_t>(kBlockBytes / size, 1);
    for (std::size_t begin = 0; begin < all; begin += block) {
      const std::size_t count = std::min<std::size_t>(block, all - begin);
      const char* rows = values_.rows(count, size);
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        read_column(rows, size, begin, count, element.properties[p].type, vertex_targets_[p]);
        rows += size_of(element.properties[p].type);
      }
      if (progress_) progress_(static_cast<double>(before + begin) / static_cast<double>(element.count));
    }
  }

  void read_column(const char* at, std::size_t stride, std::size_t begin, std::size_t count, Type type,
                   const Target& target) {
    if (target.kind == Kind::axis) {
      Point* to = mesh_.positions.data() + begin;
      const int axis = target.axis;
      Values::column(at, stride, count, type, [=](std::size_t i, double value) { to[i][axis] = value; });
    } else if (target.kind == Kind::id_half) {
      std::uint64_t* to = mesh_.vertex_ids.data() + begin;
      const int shift = target.axis;
      Values::column(at, stride, count, type,
                     [=](std::size_t i, double value) { to[i] |= static_cast<std::uint64_t>(value) << shift; });
    } else if (target.kind == Kind::value) {
      const std::size_t n = target.components;
      double* to = mesh_.attributes[target.attribute].values.data() + begin * n + target.component;
      Values::column(at, stride, count, type, [=](std::size_t i, double value) { to[i * n] = value; });
    }
  }

  void read_faces(const Element& element) {
    in_pieces(element, [&](std::size_t begin, std::size_t count) {
      // As if all were triangles.
      mesh_.corners.reserve(3 * count);
      take_memory(face_targets_, count);
      for (const Target& target : face_targets_)
        if (target.kind == Kind::texcoord) mesh_.attributes[target.attribute].values.reserve(6 * count);
      for (std::size_t f = 0; f < count; ++f) {
        read_face(element, f);
        report(begin + f, element.count);
      }
    });
  }

  void read_face(const Element& element, std::size_t f) {
    std::uint32_t corners = 0;
    const Target* texcoord = nullptr;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const Property& p = element.properties[i];
      if (face_targets_[i].kind == Kind::indices) {
        corners = read_corners(p);
        end_face(mesh_, corners);
      } else if (face_targets_[i].kind == Kind::texcoord) {
        texcoord = &face_targets_[i];
        read_texcoord(p);
      } else {
        read_number(p, face_targets_[i], f);
      }
    }
    if (texcoord) add_texcoord(mesh_.attributes[texcoord->attribute].values, 2 * std::size_t{corners});
  }

  std::uint32_t read_corners(const Property& p) {
    const std::uint64_t corners = values_.whole(*p.count_type);
    if (corners < 3) values_.refuse(fmt::format("a face has {} corners", corners));
    if (corners > values_.left_for(p.type) || corners > 0xffffffffU)
      values_.refuse(fmt::format("the file is cut off: no room for the {} corners of a face", corners));
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

  /// The list may stand before the corners that it belongs to.
  void read_texcoord(const Property& p) {
    const std::uint64_t count = values_.whole(*p.count_type);
    if (count > values_.left_for(p.type))
      values_.refuse(fmt::format("the file is cut off: no room for the {} numbers of a list 'texcoord'", count));
    texcoord_.resize(count);
    values_.values(p.type, texcoord_);
  }

  /// Two numbers per corner; a list of another length belongs to no corner.
  void add_texcoord(std::vector<double>& to, std::size_t count) {
    if (texcoord_.size() == count) {
      to.insert(to.end(), texcoord_.begin(), texcoord_.end());
      return;
    }
    to.resize(to.size() + count, kNone);
    if (!texcoord_.empty()) dropped_.add("lists 'texcoord' without two numbers per corner");
  }

  void skip_element(const Element& element) {
    dropped_.add(fmt::format("element '{}'", shown(element.name)), element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Property& p : element.properties) read_number(p, {}, i);
      report(i, element.count);
    }
  }

  void report(std::uint64_t i, std::uint64_t count) const {
    if (progress_ && i % 65536 == 0) progress_(static_cast<double>(i) / static_cast<double>(count));
  }

  Values values_;
  const Element& vertex_;
  std::uint64_t vertices_;
  MeshData& mesh_;
  MeshSink* sink_;
  const Progress& progress_;
  std::vector<Target> vertex_targets_, face_targets_;
  std::vector<double> texcoord_;  ///< of the current face
  DroppedCounter dropped_;
};

}  // namespace

std::uint64_t count_ply_faces(const FileBytes& file) {
  const Header header = read_header(file);
  const Element* face = header.find("face");
  return face ? face->count : 0;
}

void read_ply(const FileBytes& file, MeshData& mesh, MeshSink* sink, const Progress& progress) {
  const Header header = read_header(file);
  mesh.references = header.references;
  switch (*header.encoding) {
    case Encoding::ascii:
      BodyReader(AsciiValues(file, header, progress), header, mesh, sink, progress).run(header);
      break;
    case Encoding::little:
      BodyReader(BinaryValues<std::endian::little>(file, header), header, mesh, sink, progress).run(header);
      break;
    case Encoding::big:
      BodyReader(BinaryValues<std::endian::big>(file, header), header, mesh, sink, progress).run(header);
      break;
  }
}

}  // namespace ramcdb::mesh_file
