#include "codec/wire_codec.h"

#include <optional>
#include <span>
#include <vector>

#include "tests/fuzz/coder_input.h"

/// A wire of a decoded group has its points and ends, on the lattice, and comes back from a blob of its own.
namespace ramcdb::fuzz {
namespace {

constexpr std::uint32_t kMostPoints = 5000;

LatticePoint point(CoderInput& input) {
  LatticePoint p;
  for (int a = 0; a < 3; ++a)
    p[a] = static_cast<std::int32_t>(input.word() % (2U * kMaxLatticeCoordinate + 1)) - kMaxLatticeCoordinate;
  return p;
}

void put(CoderSeed& seed, LatticePoint p) {
  for (int a = 0; a < 3; ++a) seed.word(static_cast<std::uint32_t>(p[a] + kMaxLatticeCoordinate));
}

Seed seed_of(std::string name, std::span<const Wire> wires) {
  CoderSeed seed;
  put(seed, wires.front().points.front());
  put(seed, wires.front().points.back());
  seed.word(static_cast<std::uint32_t>(wires.front().points.size()) - 2);
  std::vector<codec::WireOfGroup> group;
  for (const Wire& wire : wires) group.push_back({WireId(static_cast<std::uint32_t>(2 * group.size() + 1)), &wire});
  return seed.named(std::move(name), codec::encode_wires(group));
}

}  // namespace

std::vector<Seed> seeds() {
  constexpr std::int32_t kFar = kMaxLatticeCoordinate;
  Wire line{{{0, 7, 0}}}, bend{{{-3, 2, 1}}}, wild{{{-kFar, kFar, kFar}}};
  for (std::int32_t i = 1; i < 40; ++i) {
    line.points.push_back({13 * i, 7 - 4 * i, i});
    bend.points.push_back({i * i, 5 * i - i * i / 3, i % 5});
    if (i % 10 == 0) wild.points.push_back({i % 20 ? kFar : -kFar, -kFar, i});
  }
  Wire closed = bend;
  closed.points.push_back(closed.points.front());
  const std::vector<Wire> all{line, bend, wild, closed};
  return {seed_of("line", {&line, 1}), seed_of("bend", {&bend, 1}), seed_of("wild", {&wild, 1}), seed_of("all", all)};
}

}  // namespace ramcdb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ramcdb;
  fuzz::CoderInput input(data, size);
  const LatticePoint begin = fuzz::point(input), end = fuzz::point(input);
  const std::uint32_t inner = input.word() % fuzz::kMostPoints;
  std::optional<codec::WireGroup> group;
  if (fuzz::refuses([&] { group.emplace(input.blob()); })) return 0;
  for (const WireId id : group->ids()) {
    Wire wire;
    if (fuzz::refuses([&] { wire = group->wire(id, begin, end, inner); })) continue;
    fuzz::require(wire.points.size() == inner + 2, "another number of points");
    fuzz::require(wire.points.front() == begin && wire.points.back() == end, "other ends");
    fuzz::require_valid(wire.points, {});
    const codec::WireOfGroup alone{id, &wire};
    const codec::WireGroup again(codec::encode_wires(std::span(&alone, 1)));
    fuzz::require(again.wire(id, begin, end, inner) == wire, "another wire comes back");
  }
  return 0;
}
