#include "tools/benchmark/file_edits.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "api/mesh_file/mesh_file.h"

namespace ramcdb::benchmark {
namespace {

class EditedMesh {
 public:
  explicit EditedMesh(mesh_file::MeshData& data) : data_(data), inner_(data.positions.size(), true) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t f = 0; f < faces(); ++f)
      for (std::size_t i = 0; i < 3; ++i) ++edges[std::minmax(at(f, i), at(f, i + 1))];
    for (const auto& [edge, count] : edges)
      if (count != 2) inner_[edge.first] = inner_[edge.second] = false;
  }

  void move() {
    Point middle;
    for (const Point& p : data_.positions)
      for (int a = 0; a < 3; ++a) middle[a] += p[a] / static_cast<double>(data_.positions.size());
    for (std::size_t v = 0; v < inner_.size(); ++v)
      for (int a = 0; inner_[v] && a < 3; ++a) data_.positions[v][a] += 0.01 * (data_.positions[v][a] - middle[a]);
  }

  void remesh() {
    std::vector<std::vector<std::uint32_t>> around(inner_.size());
    for (std::uint32_t f = 0; f < faces(); ++f)
      for (std::size_t i = 0; i < 3; ++i) around[at(f, i)].push_back(f);
    gone_.assign(faces(), false);
    for (std::uint32_t v = 0; v < inner_.size(); v += 30)
      if (inner_[v]) take_out(v, around[v]);
    for (std::uint32_t f = 0; f < gone_.size(); f += 10)
      if (!gone_[f]) split(f);
    for (std::uint32_t f = 0; f < gone_.size(); ++f)
      if (!gone_[f]) add(at(f, 0), at(f, 1), at(f, 2));
    data_.corners = std::move(corners_);
    drop_unused_vertices();
  }

 private:
  [[nodiscard]] std::size_t faces() const { return data_.corners.size() / 3; }
  [[nodiscard]] std::uint32_t at(std::size_t face, std::size_t i) const { return data_.corners[3 * face + i % 3]; }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { corners_.insert(corners_.end(), {a, b, c}); }

  /// Removes a vertex with its faces, and fills the hole with a fan; not beside the border, where an edge of that could
  /// come a second time.
  void take_out(std::uint32_t v, const std::vector<std::uint32_t>& faces) {
    std::map<std::uint32_t, std::uint32_t> next;
    for (const std::uint32_t f : faces) {
      if (gone_[f] || !inner_[at(f, 0)] || !inner_[at(f, 1)] || !inner_[at(f, 2)]) return;
      const auto i = static_cast<std::size_t>(at(f, 1) == v) + 2 * static_cast<std::size_t>(at(f, 2) == v);
      next[at(f, i + 1)] = at(f, i + 2);
    }
    const std::uint32_t hub = next.begin()->first;
    for (const std::uint32_t f : faces) gone_[f] = true;
    for (std::uint32_t a = next[hub]; next[a] != hub; a = next[a]) add(hub, a, next[a]);
  }

  void split(std::uint32_t f) {
    const auto middle = static_cast<std::uint32_t>(data_.positions.size());
    Point p;
    for (std::size_t i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a) p[a] += data_.positions[at(f, i)][a] / 3;
    data_.positions.push_back(p);
    if (!data_.vertex_ids.empty()) data_.vertex_ids.push_back(0);
    for (std::size_t i = 0; i < 3; ++i) add(at(f, i), at(f, i + 1), middle);
    gone_[f] = true;
  }

  void drop_unused_vertices() {
    std::vector<std::uint32_t> now(data_.positions.size(), 0);
    for (const std::uint32_t v : data_.corners) now[v] = 1;
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < now.size(); ++v) {
      if (!now[v]) continue;
      data_.positions[count] = data_.positions[v];
      if (!data_.vertex_ids.empty()) data_.vertex_ids[count] = data_.vertex_ids[v];
      now[v] = count++;
    }
    data_.positions.resize(count);
    if (!data_.vertex_ids.empty()) data_.vertex_ids.resize(count);
    for (std::uint32_t& v : data_.corners) v = now[v];
  }

  mesh_file::MeshData& data_;
  std::vector<bool> inner_, gone_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

void edit_file(const std::filesystem::path& file, FileEdit edit) {
  mesh_file::MeshData data = mesh_file::read_mesh(file);
  EditedMesh mesh(data);
  if (edit == FileEdit::move)
    mesh.move();
  else
    mesh.remesh();
  mesh_file::MeshOutput out;
  out.positions = data.positions;
  out.corners = data.corners;
  out.vertex_ids = data.vertex_ids;
  mesh_file::write_mesh(file, mesh_file::Format::ply, out);
}

}  // namespace ramcdb::benchmark
