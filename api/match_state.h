#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "api/hash_index.h"
#include "api/surface.h"

namespace ramcdb::detail {

/// The face of another surface that a face is, and how far its corners are turned: corner i is corner
/// (i + turn) % size of face `face`.
struct FaceMatch {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::uint32_t face = kNone;
  std::uint32_t turn = 0;
};

/// The lattice points of two surfaces, numbered: vertices with equal points have one place.
struct Places {
  Places(const Surface& from, const Rings& from_rings, const Surface& to, const Rings& to_rings);

  std::vector<std::uint32_t> from, to;              ///< per vertex
  std::vector<std::uint32_t> count_from, count_to;  ///< per place: vertices that have faces
  std::vector<std::uint32_t> first_from, first_to;  ///< per place: the first of them
};

/// Which vertex of `from` each vertex of `to` is, one to one.
class VertexPairs {
 public:
  VertexPairs(std::size_t from, std::size_t to) : to_(from, kNowhere), from_(to, kNowhere) {}

  [[nodiscard]] std::uint32_t from(std::uint32_t w) const { return from_[w]; }
  [[nodiscard]] std::uint32_t to(std::uint32_t v) const { return to_[v]; }
  void set(std::uint32_t v, std::uint32_t w) {
    from_[w] = v;
    to_[v] = w;
  }
  /// Takes back the pair of a vertex of `to`.
  void unset(std::uint32_t w) {
    to_[from_[w]] = kNowhere;
    from_[w] = kNowhere;
  }

 private:
  std::vector<std::uint32_t> to_, from_;
};

/// Finds faces by their vertices: around the one with the fewest faces or, among hundreds of them, by hash.
class FaceFinder {
 public:
  /// Both must outlive this.
  FaceFinder(const Surface& surface, const Rings& rings)
      : surface_(surface), rings_(rings), taken_(surface.face_count(), false) {}
  [[nodiscard]] bool has(std::span<const std::uint32_t> cycle) { return find(cycle).face != FaceMatch::kNone; }
  /// Takes out the first face whose vertices stand in this cyclic order; none when there is none left.
  [[nodiscard]] FaceMatch take(std::span<const std::uint32_t> cycle);

 private:
  [[nodiscard]] FaceMatch find(std::span<const std::uint32_t> cycle);
  [[nodiscard]] FaceMatch turned(std::uint32_t face, std::span<const std::uint32_t> cycle) const;

  const Surface& surface_;
  const Rings& rings_;
  std::vector<bool> taken_;
  std::optional<HashIndex> index_;  ///< made when first needed
};

/// What is known of two surfaces while they are matched.
struct MatchState {
  MatchState(const Surface& from_surface, const Surface& to_surface);

  Surface from, to;
  Rings from_rings, to_rings;
  Places places;
  FaceFinder faces;  ///< of `from`
  VertexPairs pairs;
  /// Per vertex of `to`: it has no id where ids are to be believed, so that it is new unless it lies where one lay.
  /// Empty without such ids.
  std::vector<bool> without_id;

  /// Whether a pair contradicts nothing.
  [[nodiscard]] bool can_pair(std::uint32_t v, std::uint32_t w) const {
    return pairs.from(w) == v || (pairs.from(w) == kNowhere && pairs.to(v) == kNowhere);
  }
  /// The vertices of `from` that those of a face of `to` are, in `cycle`; false while one of them is not known.
  bool known_cycle(std::uint32_t face, std::vector<std::uint32_t>& cycle) const;
};

}  // namespace ramcdb::detail
