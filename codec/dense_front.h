#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "codec/dense_surface.h"

namespace ramcdb::codec {

/// A place on the front: a vertex as one loop of the front passes it, and the edge from there to the next place.
struct FrontNode {
  std::uint32_t vertex = 0;
  std::uint32_t prev = 0, next = 0;
  std::uint32_t opposite = kNone;  ///< third vertex of the decoded face behind the edge; kNone on the chart's border
  std::uint32_t live = kNone;      ///< where live() lists it; kNone when it is not on the front any more
  std::uint32_t angle = 0;         ///< of the open corner, when it was queued last
};

/// The front: all loops between the decoded part of a chart and the rest, as rings of nodes with the rest on the left,
/// and the queue of their open corners. The queue has 64 stacks, one for each sixteenth of a quadrant. Nodes keep their
/// number for ever, so numbers break ties.
class DenseFront {
 public:
  static constexpr std::uint32_t kBuckets = 64;

  DenseFront() {
    for (std::uint32_t bucket = 0; bucket < kBuckets; ++bucket) queue_.push_back({bucket, bucket});
  }

  void reserve(std::size_t nodes) {
    nodes_.reserve(nodes);
    queue_.reserve(kBuckets + nodes);
    live_.reserve(nodes);
  }

  [[nodiscard]] const FrontNode& operator[](std::uint32_t node) const { return nodes_[node]; }
  [[nodiscard]] std::uint32_t node_count() const { return static_cast<std::uint32_t>(nodes_.size()); }
  /// All nodes on the front, in an order that equal calls make equal.
  [[nodiscard]] const std::vector<std::uint32_t>& live() const { return live_; }

  /// Makes a node that knows its neighbours; they learn of it by link().
  std::uint32_t add(std::uint32_t vertex, std::uint32_t opposite) {
    const std::uint32_t node = node_count();
    FrontNode fresh;
    fresh.vertex = vertex;
    fresh.opposite = opposite;
    fresh.live = static_cast<std::uint32_t>(live_.size());
    nodes_.push_back(fresh);
    queue_.push_back({kBuckets + node, kBuckets + node});
    live_.push_back(node);
    return node;
  }

  void link(std::uint32_t from, std::uint32_t to) {
    nodes_[from].next = to;
    nodes_[to].prev = from;
  }
  void set_opposite(std::uint32_t node, std::uint32_t vertex) { nodes_[node].opposite = vertex; }

  void remove(std::uint32_t node) {
    unqueue(node);
    const std::uint32_t hole = nodes_[node].live;
    live_[hole] = live_.back();
    nodes_[live_[hole]].live = hole;
    live_.pop_back();
    nodes_[node].live = kNone;
  }

  /// Queues a node, again if need be, ahead of all others whose angles are in the same bucket.
  void queue(std::uint32_t node, std::uint32_t angle) {
    constexpr std::uint32_t kBucketWidth = kWholeTurn / kBuckets;
    unqueue(node);
    nodes_[node].angle = angle;
    const std::uint32_t bucket = angle / kBucketWidth;
    const std::uint32_t place = kBuckets + node, older = queue_[bucket].older;
    queue_[place] = {older, bucket};
    queue_[older].newer = place;
    queue_[bucket].older = place;
    filled_ |= std::uint64_t{1} << bucket;
  }

  /// Takes the newest node of the smallest angles from the queue; kNone when the queue, hence the front, is empty.
  std::uint32_t pop() {
    while (filled_ != 0) {
      const auto bucket = static_cast<std::size_t>(std::countr_zero(filled_));
      const std::uint32_t place = queue_[bucket].older;
      if (place != bucket) {
        unqueue(place - kBuckets);
        return place - kBuckets;
      }
      filled_ &= filled_ - 1;
    }
    return kNone;
  }

 private:
  void unqueue(std::uint32_t node) {
    const std::uint32_t place = kBuckets + node;
    const Queued at = queue_[place];
    queue_[at.older].newer = at.newer;
    queue_[at.newer].older = at.older;
    queue_[place] = {place, place};
  }

  /// Neighbours in a ring.
  struct Queued {
    std::uint32_t older, newer;
  };

  std::vector<FrontNode> nodes_;
  std::vector<std::uint32_t> live_;
  /// Rings of buckets, whose numbers come first, and the nodes in them; a node that is not queued is a ring of its own.
  std::vector<Queued> queue_;
  std::uint64_t filled_ = 0;  ///< buckets that may have nodes
};

}  // namespace ramcdb::codec
