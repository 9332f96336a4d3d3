#include "codec/wire_codec.h"
#include "tests/fuzz/coder_input.h"

/// A wire that is decoded has its points and ends, on the lattice, and comes back from its own blob.
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

Seed seed_of(std::string name, const Wire& wire) {
  CoderSeed seed;
  put(seed, wire.points.front());
  put(seed, wire.points.back());
  seed.word(static_cast<std::uint32_t>(wire.points.size()) - 2);
  return seed.named(std::move(name), codec::encode_wire(wire));
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
  return {seed_of("line", line), seed_of("bend", bend), seed_of("wild", wild), seed_of("closed", closed)};
}

}  // namespace ramcdb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ramcdb;
  fuzz::CoderInput input(data, size);
  const LatticePoint begin = fuzz::point(input), end = fuzz::point(input);
  const std::uint32_t inner = input.word() % fuzz::kMostPoints;
  Wire wire;
  if (fuzz::refuses([&] { wire = codec::decode_wire(input.blob(), begin, end, inner); })) return 0;
  fuzz::require(wire.points.size() == inner + 2, "another number of points");
  fuzz::require(wire.points.front() == begin && wire.points.back() == end, "other ends");
  fuzz::require_valid(wire.points, {});
  fuzz::require(codec::decode_wire(codec::encode_wire(wire), begin, end, inner) == wire, "another wire comes back");
  return 0;
}
