#include "chartify/face_moves.h"

#include <array>
#include <bit>

namespace ramcdb::chartify {
namespace {

constexpr int kMoveRounds = 3;
constexpr int kLeastGain = -1;         // of the first move of a climb
constexpr std::size_t kPatience = 30;  // moves without a new best

class Climber {
 public:
  explicit Climber(FaceMover& mover)
      : mover_(mover), at_border_(mover.face_count() / kWordBits + 1), touched_in_(mover.face_count(), 0) {
    for (std::uint32_t f = 0; f < mover_.face_count(); ++f)
      if (mover_.is_at_border(f)) mark(f);
  }

  /// One climb from every border face. Returns the edges that the borders got shorter by.
  std::int64_t run_round() {
    ++round_;
    std::int64_t gained = 0;
    for (std::uint32_t f = next_at_border(0); f < mover_.face_count(); f = next_at_border(f + 1)) {
      if (mover_.chart(f) == kNone || touched_in_[f] == round_) continue;
      const FaceMover::Choice choice = mover_.best_choice(f);
      if (choice.to != kNone && choice.gain >= kLeastGain) gained += climb(f);
    }
    return gained;
  }

 private:
  static constexpr std::uint32_t kWordBits = 64;

  void mark(std::uint32_t face) { at_border_[face / kWordBits] |= std::uint64_t{1} << face % kWordBits; }

  /// The first face from this one on that may be at a border; the number of faces where there is none.
  [[nodiscard]] std::uint32_t next_at_border(std::uint32_t face) const {
    std::uint32_t word = face / kWordBits;
    std::uint64_t bits = at_border_[word] >> face % kWordBits << face % kWordBits;
    while (bits == 0 && ++word < at_border_.size()) bits = at_border_[word];
    return bits == 0 ? mover_.face_count() : kWordBits * word + static_cast<std::uint32_t>(std::countr_zero(bits));
  }

  struct Move {
    std::uint32_t face, from;
  };
  /// What a climb has reached; larger gain is better, then more even sizes.
  struct Score {
    std::int64_t gain = 0, squares = 0;
    [[nodiscard]] bool better_than(const Score& other) const {
      return gain > other.gain || (gain == other.gain && squares < other.squares);
    }
  };

  std::int64_t climb(std::uint32_t start) {
    moves_.clear();
    for (auto& bucket : buckets_) bucket.clear();
    Score score, best;
    std::size_t best_length = 0;
    push(start);
    while (moves_.size() < best_length + kPatience && move_next(score)) {
      if (!score.better_than(best)) continue;
      best = score;
      best_length = moves_.size();
    }
    for (; moves_.size() > best_length; moves_.pop_back()) mover_.move(moves_.back().face, moves_.back().from);
    return best.gain;
  }

  void push(std::uint32_t face) {
    if (mover_.chart(face) == kNone || touched_in_[face] == round_) return;
    const FaceMover::Choice choice = mover_.best_choice(face);
    if (choice.to != kNone) bucket(choice.gain).push_back(face);
  }

  /// Takes the best candidate that is still what it was when it was pushed.
  bool move_next(Score& score) {
    for (int gain = FaceMover::kMostGain; gain >= -FaceMover::kMostGain;) {
      if (bucket(gain).empty()) {
        --gain;
        continue;
      }
      const std::uint32_t face = bucket(gain).back();
      bucket(gain).pop_back();
      if (touched_in_[face] == round_) continue;
      const FaceMover::Choice choice = mover_.best_choice(face);
      if (choice.to == kNone || choice.gain != gain || !mover_.keeps_sizes(face, choice.to) ||
          !mover_.keeps_shape(face, choice.to))
        continue;
      apply(face, choice, score);
      return true;
    }
    return false;
  }

  void apply(std::uint32_t face, const FaceMover::Choice& choice, Score& score) {
    const std::uint32_t from = mover_.chart(face);
    score.gain += choice.gain;
    score.squares += 2 * (std::int64_t{mover_.size(choice.to)} - std::int64_t{mover_.size(from)} + 1);
    mover_.move(face, choice.to);
    touched_in_[face] = round_;
    moves_.push_back({face, from});
    for (std::uint32_t e = 0; e < 3; ++e)
      if (const std::uint32_t g = mover_.neighbour(face, e); g != kNone) {
        mark(g);
        push(g);
      }
  }

  [[nodiscard]] std::vector<std::uint32_t>& bucket(int gain) {
    return buckets_[static_cast<std::size_t>(gain + FaceMover::kMostGain)];
  }

  FaceMover& mover_;
  std::vector<std::uint64_t> at_border_;  ///< a bit per face: set for all at borders, and for some that were
  std::vector<std::uint8_t> touched_in_;  ///< the last round in which a face was moved
  std::uint8_t round_ = 0;
  std::vector<Move> moves_;
  std::array<std::vector<std::uint32_t>, 2 * FaceMover::kMostGain + 1> buckets_;
};

}  // namespace

void move_faces(FaceMover& mover) {
  Climber climber(mover);
  for (int round = 0; round < kMoveRounds; ++round)
    if (climber.run_round() == 0) return;
}

}  // namespace ramcdb::chartify
