#include "chartify/border_paths.h"

#include <algorithm>

namespace ramcdb::chartify {

ClosedFans::ClosedFans(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins)
    : leaving_(mesh.positions.size(), kNoTwin) {
  std::vector<std::uint32_t> corners(mesh.positions.size(), 0);
  for (HalfEdge h = 0; h < twins.size(); ++h) {
    const std::uint32_t v = mesh.faces[face_of(h)][h % 3];
    ++corners[v];
    leaving_[v] = std::min(leaving_[v], h);
  }
  for (std::size_t v = 0; v < leaving_.size(); ++v) {
    if (leaving_[v] == kNoTwin) continue;
    std::uint32_t faces = 0;
    HalfEdge h = leaving_[v];
    do {
      h = twins[previous_in_face(h)];
      ++faces;
    } while (h != kNoTwin && h != leaving_[v]);
    if (h == kNoTwin || faces != corners[v]) leaving_[v] = kNoTwin;
  }
}

namespace {

class Tracer {
 public:
  Tracer(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins, const ClosedFans& fans,
         const std::vector<std::uint32_t>& chart_of_face)
      : mesh_(mesh), twins_(twins), fans_(fans), chart_of_face_(chart_of_face), traced_(twins.size(), 0) {}

  std::vector<BorderPath> run() {
    std::vector<BorderPath> paths;
    for (std::uint32_t f = 0; f < chart_of_face_.size(); ++f)
      for (HalfEdge h = 3 * f; h < 3 * f + 3; ++h) {
        if (twins_[h] == kNoTwin || chart_of_face_[face_of(twins_[h])] == chart_of_face_[f] || traced_[h]) continue;
        BorderPath path = trace(h);
        if (!path.empty()) paths.push_back(std::move(path));
      }
    return paths;
  }

 private:
  [[nodiscard]] std::uint32_t start_of(HalfEdge h) const { return mesh_.faces[face_of(h)][h % 3]; }

  [[nodiscard]] bool is_border(HalfEdge h) const {
    return twins_[h] != kNoTwin && chart_of_face_[face_of(h)] != chart_of_face_[face_of(twins_[h])];
  }

  /// The border half-edge that goes on where `h` ends, with the same chart on its left, unless a corner is there.
  [[nodiscard]] HalfEdge next(HalfEdge h) const {
    if (fans_.leaving(start_of(next_in_face(h))) == kNoTwin) return kNoTwin;
    HalfEdge found = kNoTwin;
    int borders = 0;
    const HalfEdge first = next_in_face(h);
    HalfEdge g = first;
    do {
      if (is_border(g)) {
        if (++borders > 2) return kNoTwin;
        if (chart_of_face_[face_of(g)] == chart_of_face_[face_of(h)]) found = g;
      }
      g = next_in_face(twins_[g]);
    } while (g != first);
    return borders == 2 ? found : kNoTwin;
  }

  [[nodiscard]] BorderPath trace(HalfEdge h) {
    HalfEdge first = h;
    for (;;) {  // back to the corner where the path begins; along the twins that is forward
      const HalfEdge before = next(twins_[first]);
      if (before == kNoTwin) break;
      first = twins_[before];
      if (first == h) return mark_ring(h);
    }
    BorderPath path;
    for (HalfEdge g = first; g != kNoTwin; g = next(g)) {
      traced_[g] = traced_[twins_[g]] = 1;
      path.push_back(g);
    }
    return path;
  }

  BorderPath mark_ring(HalfEdge h) {
    HalfEdge g = h;
    do {
      traced_[g] = traced_[twins_[g]] = 1;
      g = next(g);
    } while (g != h);
    return {};
  }

  const IndexedMesh& mesh_;
  const std::vector<HalfEdge>& twins_;
  const ClosedFans& fans_;
  const std::vector<std::uint32_t>& chart_of_face_;
  std::vector<std::uint8_t> traced_;
};

}  // namespace

std::vector<BorderPath> trace_borders(const IndexedMesh& mesh, const std::vector<HalfEdge>& twins,
                                      const ClosedFans& fans, const std::vector<std::uint32_t>& chart_of_face) {
  return Tracer(mesh, twins, fans, chart_of_face).run();
}

}  // namespace ramcdb::chartify
