#include "chartify/rebalance.h"

#include <array>
#include <deque>

namespace ramcdb::chartify {
namespace {

constexpr int kPasses = 3;

/// One chart above the cap and the faces on its border by gain; first in, first out within a gain.
class Donor {
 public:
  Donor(FaceMover& mover, std::uint32_t chart, std::uint32_t cap) : mover_(mover), chart_(chart), cap_(cap) {}

  void push(std::uint32_t face) {
    if (mover_.chart(face) != chart_) return;
    const FaceMover::Choice choice = mover_.smallest_choice(face);
    if (choice.to != kNone) queue(choice.gain).push_back(face);
  }

  void hand_over() {
    for (int gain = FaceMover::kMostGain; gain >= -FaceMover::kMostGain && mover_.size(chart_) > cap_;) {
      if (queue(gain).empty()) {
        --gain;
        continue;
      }
      const std::uint32_t face = queue(gain).front();
      queue(gain).pop_front();
      if (try_move(face, gain)) gain = FaceMover::kMostGain;
    }
  }

 private:
  [[nodiscard]] std::deque<std::uint32_t>& queue(int gain) {
    return queues_[static_cast<std::size_t>(gain + FaceMover::kMostGain)];
  }

  bool try_move(std::uint32_t face, int expected_gain) {
    if (mover_.chart(face) != chart_) return false;
    const FaceMover::Choice choice = mover_.smallest_choice(face);
    if (choice.to == kNone || choice.gain != expected_gain || !mover_.keeps_shape(face, choice.to)) return false;
    mover_.move(face, choice.to);
    for (std::uint32_t e = 0; e < 3; ++e)
      if (const std::uint32_t g = mover_.neighbour(face, e); g != kNone) push(g);
    return true;
  }

  FaceMover& mover_;
  std::uint32_t chart_, cap_;
  std::array<std::deque<std::uint32_t>, 2 * FaceMover::kMostGain + 1> queues_;
};

}  // namespace

void rebalance(FaceMover& mover, const SizeLimits& limits, std::uint32_t chart_count) {
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<std::uint32_t> donor_of(chart_count, kNone);
    std::vector<Donor> donors;
    for (std::uint32_t c = 0; c < chart_count; ++c) {
      if (mover.size(c) <= limits.cap) continue;
      donor_of[c] = static_cast<std::uint32_t>(donors.size());
      donors.emplace_back(mover, c, limits.cap);
    }
    if (donors.empty()) return;
    for (std::uint32_t f = 0; f < mover.face_count(); ++f)
      if (mover.chart(f) != kNone && donor_of[mover.chart(f)] != kNone) donors[donor_of[mover.chart(f)]].push(f);
    for (Donor& donor : donors) donor.hand_over();
  }
}

}  // namespace ramcdb::chartify
