#pragma once

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "api/mesh_file/mesh_file.h"
#include "db/store.h"
#include "ramcdb/repository.h"
#include "tests/api/blobs_of.h"
#include "tests/api/face_records.h"
#include "tests/api/temp_repository.h"

/// A mesh that has attributes of every kind, and a repository with it.
namespace ramcdb::test {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

inline Attribute make_attribute(std::string name, AttributeOf of, NumberType type, std::uint8_t components,
                                Meaning meaning) {
  return {{std::move(name), of, type, components, meaning, {}, {}}, {}};
}

/// A grid of quads, some of them cut to triangles and some joined to octagons, with attributes of every kind: colours,
/// normals, a texture with a seam and corners without one, materials, an odd number per vertex and one per face.
inline mesh_file::MeshData painted_grid(std::uint32_t n) {
  mesh_file::MeshData mesh;
  Attribute color = make_attribute("color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color);
  Attribute normal = make_attribute("normal", AttributeOf::vertex, NumberType::float32, 3, Meaning::normal);
  Attribute heat = make_attribute("heat", AttributeOf::vertex, NumberType::float32, 1, Meaning::other);
  Attribute texture = make_attribute("texture", AttributeOf::corner, NumberType::float32, 2, Meaning::texture);
  Attribute flags = make_attribute("flags", AttributeOf::face, NumberType::int16, 1, Meaning::other);
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) {
      const double height = std::sin(x * 0.3) * std::cos(y * 0.2);
      mesh.positions.push_back({static_cast<double>(x), static_cast<double>(y), height});
      color.values.insert(color.values.end(), {static_cast<double>(x % 256), static_cast<double>(y % 256), 7.0});
      normal.values.insert(normal.values.end(), {0.0, double{0.6F}, double{0.8F}});
      heat.values.push_back(static_cast<double>(static_cast<float>(height * 1e-3)));
    }
  const auto at = [n](std::uint32_t x, std::uint32_t y) { return y * (n + 1) + x; };
  const auto add = [&](std::initializer_list<std::uint32_t> face, std::uint32_t x) {
    mesh.face_sizes.push_back(static_cast<std::uint32_t>(face.size()));
    flags.values.push_back(static_cast<double>(x) - 5);
    for (const std::uint32_t v : face) {
      mesh.corners.push_back(v);
      const double seam = x >= n / 2 ? 0.25 : 0;
      const bool none = x == 1;
      texture.values.push_back(none ? kNone : (v % (n + 1)) / 64.0 + seam);
      texture.values.push_back(none ? kNone : (v / (n + 1)) / 64.0);
    }
  };
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      if (x % 7 == 3) {
        add({at(x, y), at(x + 1, y), at(x + 1, y + 1)}, x);
        add({at(x, y), at(x + 1, y + 1), at(x, y + 1)}, x);
      } else if (x % 7 == 5 && y % 2 == 0 && y + 1 < n) {
        add({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x + 1, y + 2), at(x, y + 2), at(x, y + 1)}, x);
      } else if (x % 7 != 5 || y % 2 == 0) {
        add({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)}, x);
      }
    }
  mesh.attributes = {color, normal, heat, texture, flags};
  return mesh;
}

/// A fresh repository with the painted grid.
class Painted {
 public:
  explicit Painted(const mesh_file::MeshData& mesh, bool lossless = false) {
    Repository::create(folder_ / "r.ramcdb");
    repository_.emplace(Repository::open(folder_ / "r.ramcdb"));
    write_data(mesh, folder_ / "input.ply");
    ImportOptions options;
    options.name = "mesh";
    options.bits = 16;
    options.chart_faces = 300;
    options.lossless_attributes = lossless;
    report_ = repository_->import(folder_ / "input.ply", options);
  }
  [[nodiscard]] Repository* operator->() { return &*repository_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] const ImportReport& report() const { return report_; }
  [[nodiscard]] std::size_t written(VersionId version, db::Kind kind) const {
    return count_blobs(*repository_, version, kind, report_.info.charts);
  }

 private:
  TempFolder folder_;
  std::optional<Repository> repository_;
  ImportReport report_;
};

inline auto records(const Snapshot& snapshot, const mesh_file::MeshData& mesh) {
  return face_records(mesh, snapshot.lattice(), snapshot.info().attributes);
}

}  // namespace ramcdb::test
