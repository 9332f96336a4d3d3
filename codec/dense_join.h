#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "codec/dense_front.h"
#include "codec/dense_models.h"

namespace ramcdb::codec {

/// Names a node of the front by its rank among those near an expected place.
///
/// A front of up to 512 nodes is ranked as a whole. On longer ones only nodes in the cells of a grid around the place
/// are ranked, and at most 256 of them, so that a join takes bounded time however long the front; a node that is not
/// among them is named by its number in DenseFront::live().
class JoinSearch {
 public:
  /// \param cell_shift grid cells are 2^cell_shift wide
  JoinSearch(const DenseSurface& surface, const DenseFront& front, int cell_shift)
      : surface_(surface), front_(front), cell_shift_(cell_shift) {}

  /// Ranks the nodes near `place`, nearest first, equally near ones by number. Nodes whose vertex is one of `excluded`
  /// cannot be meant. Valid until the front changes.
  void rank_near(LatticePoint place, const std::array<std::uint32_t, 3>& excluded);

  /// Codes one of the nodes, ranked or not.
  template <class Coder>
  std::uint32_t code(Coder& coder, AdaptiveUnsigned& model, std::uint32_t node) {
    const std::size_t escape = ranked_.size();
    std::size_t rank = Coder::kEncodes ? rank_of(node) : 0;
    rank = model.code(coder, static_cast<std::uint32_t>(rank));
    if (rank < escape) return Coder::kEncodes ? node : node_at(rank);

    const auto& live = front_.live();
    const std::uint32_t place =
        coder.code_raw(Coder::kEncodes ? front_[node].live : 0, static_cast<int>(std::bit_width(live.size())));
    if (rank > escape || place >= live.size() || is_excluded(live[place]))
      throw Error(Errc::corrupt, "a chart joins its front to nothing");
    return live[place];
  }

  /// To be told of every node that enters or leaves the front.
  void entered(std::uint32_t node) {
    if (!heads_.empty()) insert(node);
  }
  void left(std::uint32_t node) {
    if (!heads_.empty()) erase(node);
  }

 private:
  static constexpr std::size_t kRankAll = 512;
  static constexpr std::size_t kEnough = 24;
  static constexpr int kRings = 3;
  static constexpr int kMaxExamined = 256;

  using Ranked = std::pair<std::uint64_t, std::uint32_t>;  ///< squared distance, node

  [[nodiscard]] std::size_t rank_of(std::uint32_t node) const;
  [[nodiscard]] std::uint32_t node_at(std::size_t rank);
  [[nodiscard]] bool is_excluded(std::uint32_t node) const;
  [[nodiscard]] Ranked ranked(std::uint32_t node) const;
  [[nodiscard]] LatticePoint cell_of(LatticePoint p) const;
  [[nodiscard]] std::size_t slot_of(LatticePoint cell) const;

  void collect_from_grid();
  bool collect_cell(LatticePoint cell);
  void build_grid();
  void insert(std::uint32_t node);
  void erase(std::uint32_t node);

  const DenseSurface& surface_;
  const DenseFront& front_;
  int cell_shift_;
  LatticePoint place_;
  std::array<std::uint32_t, 3> excluded_{};
  std::vector<Ranked> ranked_;
  int examined_ = 0;

  /// A hash grid; empty until the first join on a long front. Chains link nodes, newest first.
  std::vector<std::uint32_t> heads_, after_, before_;
};

}  // namespace ramcdb::codec
