#include "chartify/face_moves.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <utility>

#include "chartify/turns.h"

namespace ramcdb::chartify {
namespace {

constexpr int kMoveRounds = 3;
constexpr int kLeastGain = -1;         // of the first move of a climb
constexpr std::size_t kPatience = 30;  // moves without a new best

/// Two charts, and the faces of either that are beside the other.
struct Border {
  std::uint32_t left, right;         ///< the lower one left
  std::vector<std::uint32_t> faces;  ///< ascending
};

/// In the order of their first faces.
std::vector<Border> borders_between_charts(const FaceMover& mover, unsigned threads) {
  struct Entry {
    std::uint32_t left, right, face;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  std::mutex mutex;
  parallel_ranges(mover.face_count(), threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Entry> found;
    for (auto f = static_cast<std::uint32_t>(begin); f < end; ++f)
      for (std::uint32_t e = 0; e < 3; ++e) {
        const std::uint32_t g = mover.neighbour(f, e), chart = mover.chart(f);
        if (g == kNone || chart == kNone) continue;
        const std::uint32_t other = mover.chart(g);
        if (other != kNone && other != chart) found.push_back({std::min(chart, other), std::max(chart, other), f});
      }
    const std::lock_guard lock(mutex);
    entries.insert(entries.end(), found.begin(), found.end());
  });
  std::sort(entries.begin(), entries.end());
  std::vector<Border> borders;
  for (const Entry& entry : entries) {
    if (borders.empty() || std::pair(borders.back().left, borders.back().right) != std::pair(entry.left, entry.right))
      borders.push_back({entry.left, entry.right, {}});
    borders.back().faces.push_back(entry.face);  // twice where two edges are: the second time it is no news
  }
  std::ranges::stable_sort(borders, {}, [](const Border& border) { return border.faces.front(); });
  return borders;
}

/// The last round in which a face was moved.
using Touched = std::vector<std::uint8_t>;

/// Climbs along one border after the other. Several may climb at a time along borders without a common chart.
class Climber {
 public:
  Climber(FaceMover& mover, Touched& touched_in) : mover_(mover), touched_in_(touched_in) {}

  /// One climb from every face.
  void climb_along(const Border& border, std::uint8_t round) {
    left_ = border.left;
    right_ = border.right;
    round_ = round;
    for (const std::uint32_t f : border.faces)
      if (const std::optional<int> gain = gain_of(f); gain && *gain >= kLeastGain) gained_ += climb(f);
  }

  /// The edges that borders got shorter by since the last time.
  [[nodiscard]] std::int64_t take_gained() { return std::exchange(gained_, 0); }

 private:
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

  [[nodiscard]] std::uint32_t other_side(std::uint32_t chart) const { return chart == left_ ? right_ : left_; }

  /// Of moving a face across the border; nothing where it may not move, or was moved in this round.
  [[nodiscard]] std::optional<int> gain_of(std::uint32_t face) const {
    const std::uint32_t chart = mover_.chart(face);
    if ((chart != left_ && chart != right_) || touched_in_[face] == round_) return {};
    return mover_.gain(face, other_side(chart));
  }

  void push(std::uint32_t face) {
    if (const std::optional<int> gain = gain_of(face)) bucket(*gain).push_back(face);
  }

  /// Takes the best candidate that is still what it was when it was pushed.
  bool move_next(Score& score) {
    for (int gain = FaceMover::kMostGain; gain >= -FaceMover::kMostGain;) {
      if (bucket(gain).empty()) {
        --gain;
        continue;
      }
      const std::uint32_t face = bucket(gain).back(), to = other_side(mover_.chart(face));
      bucket(gain).pop_back();
      if (gain_of(face) != gain || !mover_.keeps_sizes(face, to) || !mover_.keeps_shape(face, to)) continue;
      apply(face, to, gain, score);
      return true;
    }
    return false;
  }

  void apply(std::uint32_t face, std::uint32_t to, int gain, Score& score) {
    const std::uint32_t from = mover_.chart(face);
    score.gain += gain;
    score.squares += 2 * (std::int64_t{mover_.size(to)} - std::int64_t{mover_.size(from)} + 1);
    mover_.move(face, to);
    touched_in_[face] = round_;
    moves_.push_back({face, from});
    for (std::uint32_t e = 0; e < 3; ++e)
      if (const std::uint32_t g = mover_.neighbour(face, e); g != kNone) push(g);
  }

  [[nodiscard]] std::vector<std::uint32_t>& bucket(int gain) {
    return buckets_[static_cast<std::size_t>(gain + FaceMover::kMostGain)];
  }

  FaceMover& mover_;
  Touched& touched_in_;
  std::uint32_t left_ = 0, right_ = 0;
  std::uint8_t round_ = 0;
  std::int64_t gained_ = 0;
  std::vector<Move> moves_;
  std::array<std::vector<std::uint32_t>, 2 * FaceMover::kMostGain + 1> buckets_;
};

}  // namespace

void move_faces(FaceMover& mover, unsigned threads, const Progress& progress) {
  Touched touched_in(mover.face_count(), 0);
  std::vector<Climber> climbers(std::max(threads, 1U), Climber(mover, touched_in));
  for (std::uint8_t round = 1; round <= kMoveRounds; ++round) {
    report(progress, (round - 1.0) / kMoveRounds);
    work_in_turns(borders_between_charts(mover, threads), mover.chart_count(), climbers,
                  [&](Climber& climber, const Border& border) { climber.climb_along(border, round); });
    std::int64_t gained = 0;
    for (Climber& climber : climbers) gained += climber.take_gained();
    if (gained == 0) return;
  }
}

}  // namespace ramcdb::chartify
