#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "api/mesh_file/attribute_names.h"
#include "api/mesh_file/gltf_columns.h"

/// glTF 2.0, as .glb or .gltf: the meshes of a scene, each where its node places it, as one. Materials and nodes become
/// attributes of faces. Where a node mirrors its mesh, faces are turned, as glTF says that they are seen.
namespace ramcdb::mesh_file {
namespace gltf {
namespace {

/// Instances and accessors without data make more of a file than it holds; this much is taken for meant.
constexpr std::size_t kNumbersPerByte = 256, kNumbersAtLeast = 1 << 24;

class GltfReader {
 public:
  GltfReader(const FileBytes& file, MeshData& mesh, const Progress& progress)
      : file_(file),
        mesh_(mesh),
        progress_(progress),
        document_(read_document(file, dropped_)),
        accessors_(file, document_),
        scene_(plan_scene(file, document_, accessors_, dropped_)),
        columns_(plan_columns(scene_, document_)) {}

  void run() {
    check_memory();
    mesh_.references = std::move(document_.references);
    read_positions();
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      read_column(columns_[i], scene_, document_, accessors_, mesh_);
      report(1 + i);
    }
    mesh_.corners.resize(3 * scene_.faces);
    for (const Piece& piece : scene_.pieces) read_faces(piece);
    add_objects();
    add_materials();
    mesh_.dropped = dropped_.take();
  }

 private:
  void check_memory() const {
    std::size_t per_vertex = 3;
    for (const Column& column : columns_) per_vertex += column.info.components;
    const std::size_t most = kNumbersAtLeast + kNumbersPerByte * accessors_.bytes_there();
    const std::size_t per_face = 5;
    if (scene_.vertices > most / per_vertex || scene_.faces > (most - scene_.vertices * per_vertex) / per_face)
      throw Error(Errc::limit_exceeded,
                  fmt::format("{} vertices and {} faces in a file of {} bytes", scene_.vertices, scene_.faces,
                              accessors_.bytes_there()),
                  file_.name(), "write instances out as meshes of their own, or split the file");
  }

  void report(std::size_t step) const {
    if (progress_) progress_(static_cast<double>(step) / static_cast<double>(columns_.size() + 2));
  }

  void read_positions() {
    mesh_.positions.resize(scene_.vertices);
    for (const Block& block : scene_.blocks) {
      Point* points = mesh_.positions.data() + block.first;
      accessors_.read_points(block.position, points);
      const Transform& transform = scene_.transforms[block.transform];
      if (transform.is_identity()) continue;
      for (std::size_t i = 0; i < block.count; ++i) points[i] = transform.point(points[i]);
    }
  }

  void read_faces(const Piece& piece) {
    const Block& block = scene_.blocks[piece.block];
    std::vector<std::uint32_t> indices;
    if (piece.primitive->indices) indices = accessors_.indices(*piece.primitive->indices, block.count, piece.name);
    const auto first = static_cast<std::uint32_t>(block.first);
    const auto vertex = [&](std::size_t i) {
      return first + (piece.primitive->indices ? indices[i] : static_cast<std::uint32_t>(i));
    };
    std::uint32_t* to = mesh_.corners.data() + 3 * face_;
    // The places in the list of a face's corners.
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      if (scene_.transforms[block.transform].mirrors()) std::swap(b, c);
      *to++ = vertex(a);
      *to++ = vertex(b);
      *to++ = vertex(c);
    };
    for (std::size_t f = 0; f < piece.faces; ++f) switch (piece.primitive->mode) {
        case 4:
          add(3 * f, 3 * f + 1, 3 * f + 2);
          break;
        case 5:
          add(f, f + 1 + f % 2, f + 2 - f % 2);
          break;
        default:
          add(f + 1, f + 2, 0);
      }
    face_ += piece.faces;
  }

  Attribute& add_face_attribute(std::string_view name, Meaning meaning) {
    Attribute attribute;
    attribute.info.name = unique_name(mesh_.attributes, AttributeOf::face, name);
    attribute.info.of = AttributeOf::face;
    attribute.info.type = NumberType::uint32;
    attribute.info.meaning = meaning;
    mesh_.attributes.push_back(std::move(attribute));
    mesh_.attributes.back().values.reserve(scene_.faces);
    return mesh_.attributes.back();
  }

  /// Names of things that faces have, numbered as they stand in the file. Things that no face has get none.
  class Names {
   public:
    Names(std::vector<bool> used, std::string_view unnamed) : used_(std::move(used)), unnamed_(unnamed) {}

    /// Equal names get a number behind them, and those without a name one made of `unnamed`, unless that is empty.
    template <class NameOf>
    void give(NameOf name_of) {
      std::set<std::string> taken;
      for (Index i = 0; i < used_.size(); ++i)
        if (used_[i] && !name_of(i).empty()) taken.insert(name_of(i));
      std::set<std::string> given;
      std::map<std::string, std::size_t> next;
      number.resize(used_.size(), kNone);
      for (Index i = 0; i < used_.size(); ++i) {
        if (!used_[i]) continue;
        const std::string wanted = name_of(i).empty() ? generated(i) : name_of(i);
        std::string name = wanted;
        const auto is_taken = [&] { return given.contains(name) || (taken.contains(name) && name != name_of(i)); };
        for (std::size_t& n = next.try_emplace(wanted, 2).first->second; is_taken(); ++n)
          name = fmt::format("{}_{}", wanted, n);
        number[i] = static_cast<double>(names.size());
        names.push_back(name);
        given.insert(std::move(name));
      }
    }

    std::vector<std::string> names;
    std::vector<double> number;  ///< by place in the file

   private:
    [[nodiscard]] std::string generated(Index i) const {
      return unnamed_.empty() ? std::string() : fmt::format("{}_{}", unnamed_, i);
    }

    std::vector<bool> used_;
    std::string_view unnamed_;
  };

  /// Which node faces are of, unless no node has a name and all faces are of one.
  void add_objects() {
    std::vector<bool> used(scene_.instances.size());
    for (const Piece& piece : scene_.pieces)
      if (piece.faces) used[piece.instance] = true;
    std::size_t nameless = 0;
    for (Index i = 0; i < used.size(); ++i)
      if (used[i] && scene_.instances[i].name.empty()) ++nameless;
    const auto count = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
    if (count == 0 || (count == 1 && nameless == 1)) return;
    Names names(std::move(used), nameless == 1 ? "" : "object");
    names.give([&](Index i) -> const std::string& { return scene_.instances[i].name; });
    Attribute& attribute = add_face_attribute("object", Meaning::group);
    for (const Piece& piece : scene_.pieces)
      attribute.values.insert(attribute.values.end(), piece.faces, names.number[piece.instance]);
    attribute.info.names = std::move(names.names);
  }

  void add_materials() {
    std::vector<bool> used(document_.materials.size());
    for (const Piece& piece : scene_.pieces)
      if (const auto material = piece.primitive->material) {
        if (*material >= used.size())
          throw bad_part(file_, piece.name, fmt::format("names material {}, which does not exist", *material));
        if (piece.faces) used[*material] = true;
      }
    const auto count = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
    dropped_.add("materials that no face has", used.size() - count);
    if (count == 0) return;
    Names names(std::move(used), "material");
    names.give([&](Index i) -> const std::string& { return document_.materials[i]; });
    Attribute& attribute = add_face_attribute("material", Meaning::material);
    const auto none = static_cast<double>(names.names.size());  // as OBJ has it, called ""
    bool any_none = false;
    for (const Piece& piece : scene_.pieces) {
      const auto material = piece.primitive->material;
      any_none |= !material && piece.faces;
      attribute.values.insert(attribute.values.end(), piece.faces, material ? names.number[*material] : none);
    }
    if (any_none) names.names.emplace_back();
    attribute.info.names = std::move(names.names);
  }

  const FileBytes& file_;
  MeshData& mesh_;
  const Progress& progress_;
  DroppedCounter dropped_;
  Document document_;
  Accessors accessors_;
  Scene scene_;
  std::vector<Column> columns_;
  std::size_t face_ = 0;
};

}  // namespace
}  // namespace gltf

void read_gltf(const FileBytes& file, MeshData& mesh, const Progress& progress) {
  gltf::GltfReader(file, mesh, progress).run();
}

}  // namespace ramcdb::mesh_file
