#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "chartify/half_edge_twins.h"
#include "chartify/move_rules.h"
#include "chartify/partition.h"

namespace ramcdb::chartify {

/// How large charts may get while their borders are improved, in faces.
struct SizeLimits {
  explicit SizeLimits(std::uint32_t target_faces)
      : target(target_faces),
        ceiling(target_faces + target_faces / 2),
        cap(target_faces + target_faces / 10),
        floor(target_faces / 5 * 3),
        hard_floor(target_faces / 10 * 3) {}

  std::uint32_t target;
  std::uint32_t ceiling;     ///< 1.50 of the target, where charts are split
  std::uint32_t cap;         ///< 1.10
  std::uint32_t floor;       ///< 0.60
  std::uint32_t hard_floor;  ///< 0.30, for moves of many faces at once
};

/// Moves single faces from chart to chart so that charts stay connected and get no new holes or pinches: the rules
/// look at the faces around one vertex only. Several threads may use one, if each moves faces between charts that no
/// other does.
class FaceMover {
 public:
  /// \param rules which faces may move; nullptr: all
  FaceMover(const std::vector<HalfEdge>& twins, const SizeLimits& limits, Partition& partition,
            const MoveRules* rules = nullptr)
      : twins_(twins), limits_(limits), partition_(partition), rules_(rules) {}

  static constexpr int kMostGain = 3;

  struct Choice {
    std::uint32_t to = kNone;
    int gain = 0;  ///< edges that stop to be border less edges that become border
  };

  /// What is gained by moving a face to a chart beside it; nothing where that has no face beside it, or it may not
  /// move.
  [[nodiscard]] std::optional<int> gain(std::uint32_t face, std::uint32_t to) const;
  /// The smallest chart around a face that is smaller than the face's own.
  [[nodiscard]] Choice smallest_choice(std::uint32_t face) const;

  /// Whether both charts stay what they are, a connected surface without new holes.
  [[nodiscard]] bool keeps_shape(std::uint32_t face, std::uint32_t to) const;
  [[nodiscard]] bool keeps_sizes(std::uint32_t face, std::uint32_t to) const;

  void move(std::uint32_t face, std::uint32_t to) {
    --partition_.sizes[chart(face)];
    ++partition_.sizes[to];
    std::atomic_ref(partition_.chart_of_face[face]).store(to, std::memory_order_relaxed);
  }

  /// Others may be moving faces between other charts meanwhile.
  [[nodiscard]] std::uint32_t chart(std::uint32_t face) const {
    return std::atomic_ref(partition_.chart_of_face[face]).load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint32_t size(std::uint32_t c) const { return partition_.sizes[c]; }
  [[nodiscard]] std::uint32_t chart_count() const { return static_cast<std::uint32_t>(partition_.sizes.size()); }
  [[nodiscard]] std::uint32_t face_count() const { return static_cast<std::uint32_t>(twins_.size() / 3); }
  /// kNone where the edge has no other face.
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t face, std::uint32_t edge) const {
    const HalfEdge twin = twins_[3 * face + edge];
    return twin == kNoTwin ? kNone : face_of(twin);
  }

 private:
  [[nodiscard]] bool may_move(std::uint32_t face, std::uint32_t to) const {
    return rules_ == nullptr || rules_->allow(face, to);
  }
  [[nodiscard]] std::array<std::uint32_t, 3> charts_around(std::uint32_t face) const;
  /// Whether all other faces around the start of a half-edge form one fan that is wholly in a chart,
  /// and a fan that is not very large.
  [[nodiscard]] bool others_all_in(HalfEdge h, std::uint32_t c) const;
  /// Whether any other face of the fan around the start of a half-edge is in a chart, or the fan is very large.
  [[nodiscard]] bool others_touch(HalfEdge h, std::uint32_t c) const;

  const std::vector<HalfEdge>& twins_;
  const SizeLimits& limits_;
  Partition& partition_;
  const MoveRules* rules_;
};

}  // namespace ramcdb::chartify
