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
  std::uint32_t bucket = kNone;    ///< of the queue; kNone when it is not queued
  std::uint32_t older = kNone, newer = kNone;  ///< neighbours in the bucket
};

/// The front: all loops between the decoded part of a chart and the rest, as rings of nodes with the rest on the left,
/// and the queue of their open corners. The queue has 64 stacks, one for each sixteenth of a quadrant. Nodes keep their
/// number for ever, so numbers break ties.
class DenseFront {
 public:
  static constexpr std::uint32_t kBuckets = 64;

  DenseFront() { newest_.fill(kNone); }

  void reserve(std::size_t nodes) {
    nodes_.reserve(nodes);
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

  /// Queues a node, again if need be, ahead of all others of its bucket, which is below kBuckets.
  void queue(std::uint32_t node, std::uint32_t bucket) {
    unqueue(node);
    FrontNode& n = nodes_[node];
    n.bucket = bucket;
    n.older = newest_[n.bucket];
    n.newer = kNone;
    if (n.older != kNone) nodes_[n.older].newer = node;
    newest_[n.bucket] = node;
    filled_ |= std::uint64_t{1} << n.bucket;
  }

  /// Takes the newest node of the smallest angles from the queue; kNone when the queue, hence the front, is empty.
  std::uint32_t pop() {
    if (filled_ == 0) return kNone;
    const std::uint32_t node = newest_[static_cast<std::size_t>(std::countr_zero(filled_))];
    unqueue(node);
    return node;
  }

 private:
  void unqueue(std::uint32_t node) {
    FrontNode& n = nodes_[node];
    if (n.bucket == kNone) return;
    if (n.older != kNone) nodes_[n.older].newer = n.newer;
    if (n.newer != kNone) {
      nodes_[n.newer].older = n.older;
    } else {
      newest_[n.bucket] = n.older;
      if (n.older == kNone) filled_ &= ~(std::uint64_t{1} << n.bucket);
    }
    n.bucket = kNone;
  }

  std::vector<FrontNode> nodes_;
  std::vector<std::uint32_t> live_;
  std::array<std::uint32_t, kBuckets> newest_;
  std::uint64_t filled_ = 0;
};

}  // namespace ramcdb::codec
