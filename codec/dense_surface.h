#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "codec/dense_math.h"
#include "ramcdb/chart.h"
#include "ramcdb/error.h"

namespace ramcdb::codec {

inline constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// What a chart blob declares about itself; the walk over the surface ends exactly there.
struct ChartCounts {
  std::uint32_t inner_vertices = 0;
  std::uint32_t faces = 0;
};

struct alignas(16) DenseVertex {
  LatticePoint position{};
  std::uint32_t faces = 0;  ///< decoded so far
  Vec normal{};             ///< sum of the cross products of the decoded faces, times 2^-32
  float tangential = -1;    ///< how far the predictions of the two tangential coordinates missed; -1: not predicted
  float normal_miss = -1;   ///< twice that of the coordinate along the normal
};

/// From one vertex to another. (The fourth lane is the number of faces, and says nothing.)
inline Vec difference(const DenseVertex& to, const DenseVertex& from) {
  static_assert(offsetof(DenseVertex, position) == 0 && offsetof(DenseVertex, faces) == 12);
  Int4 a, b;
  std::memcpy(&a, &to, sizeof a);
  std::memcpy(&b, &from, sizeof b);
  return difference(a, b);
}

/// The part of a chart that is already decoded; border vertices come first. It never exceeds the declared counts: what
/// would is the work of a hostile stream, and throws corrupt.
class DenseSurface {
 public:
  /// \param expected vertices and faces to make room for; a guess
  DenseSurface(std::span<const LatticePoint> border, ChartCounts declared, ChartCounts expected)
      : border_(static_cast<std::uint32_t>(border.size())),
        max_vertices_(border.size() + declared.inner_vertices),
        max_faces_(declared.faces) {
    vertices_.reserve(border.size() + expected.inner_vertices);
    faces_.reserve(expected.faces);
    for (const LatticePoint p : border) vertices_.push_back({p});
  }

  [[nodiscard]] const DenseVertex& operator[](std::uint32_t vertex) const { return vertices_[vertex]; }
  [[nodiscard]] bool on_border(std::uint32_t vertex) const { return vertex < border_; }
  [[nodiscard]] std::uint32_t border_count() const { return border_; }
  [[nodiscard]] std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vertices_.size()); }
  [[nodiscard]] bool has_all_vertices() const { return vertices_.size() == max_vertices_; }
  [[nodiscard]] bool has_all_faces() const { return faces_.size() == max_faces_; }
  [[nodiscard]] std::size_t faces_left() const { return max_faces_ - faces_.size(); }
  /// All faces; the surface has none afterwards.
  [[nodiscard]] std::vector<Triangle> release_faces() { return std::move(faces_); }

  /// The number that the next vertex will get.
  [[nodiscard]] std::uint32_t next_vertex() const {
    if (has_all_vertices()) throw Error(Errc::corrupt, "a chart has more vertices than it declares");
    return vertex_count();
  }

  void add_vertex(const DenseVertex& vertex) {
    (void)next_vertex();
    vertices_.push_back(vertex);
  }

  void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (has_all_faces()) throw Error(Errc::corrupt, "a chart has more faces than it declares");
    if (a == b || b == c || c == a) throw Error(Errc::corrupt, "a face of a chart has a vertex twice");
    faces_.push_back({a, b, c});
    DenseVertex &va = vertices_[a], &vb = vertices_[b], &vc = vertices_[c];
    const Vec area = cross(difference(vb, va), difference(vc, va)) * 0x1p-32F;  // sums of squares stay finite
    for (DenseVertex* v : {&va, &vb, &vc}) {
      v->normal = v->normal + area;
      ++v->faces;
    }
  }

 private:
  std::uint32_t border_;
  std::size_t max_vertices_;
  std::size_t max_faces_;
  std::vector<DenseVertex> vertices_;
  std::vector<Triangle> faces_;
};

}  // namespace ramcdb::codec
