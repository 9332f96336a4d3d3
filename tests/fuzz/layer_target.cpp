#include "codec/layer_codec.h"
#include "codec/octahedron.h"
#include "tests/fuzz/coder_input.h"

/// A layer that is decoded has a number below 2^bits each, and comes back from its own blob.
namespace ramcdb::fuzz {
namespace {

codec::LayerShape shape(CoderInput& input) {
  codec::LayerShape shape;
  shape.of = static_cast<AttributeOf>(1 + input.byte() % 3);
  shape.components = static_cast<std::uint8_t>(1 + input.byte() % 16);
  shape.bits = static_cast<std::uint8_t>(1 + input.byte() % 64);
  const std::uint8_t kind = input.byte() % 3;
  if (kind == 1 && shape.components >= 3) shape.kind = codec::ValueKind::color;
  if (kind == 2) shape = {shape.of, 2, codec::kDirectionBits, codec::ValueKind::direction};
  return shape;
}

std::uint64_t number_of(std::size_t i, unsigned k, const codec::LayerShape& shape) {
  if (shape.kind == codec::ValueKind::direction) return (i * i * 77 + k * i) % codec::kOctahedronUnit;
  return (i * i * 77 + k * i) & (~std::uint64_t{0} >> (64 - shape.bits));
}

Seed seed_of(std::size_t number, const codec::LayerShape& shape, bool absent) {
  const Chart& chart = chart_of(static_cast<std::uint8_t>(number));
  const auto [of, components, bits, kind] = shape;
  codec::LayerValues values;
  const std::size_t count = codec::value_count(chart, of);
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_absent = absent && i % 3 == 1;
    if (absent) values.absent.push_back(is_absent);
    for (unsigned k = 0; k < components; ++k) values.numbers.push_back(is_absent ? 0 : number_of(i, k, shape));
  }
  if (absent && count < 2) values.absent.clear();
  return CoderSeed()
      .byte(number)
      .byte(static_cast<std::size_t>(of) - 1)
      .byte(components - 1U)
      .byte(bits - 1U)
      .byte(static_cast<std::size_t>(kind))
      .named("layer-" + std::to_string(number) + "-" + std::to_string(components) + "-" + std::to_string(bits),
             codec::encode_layer(values, shape, chart, codec::LayerOrder(chart)));
}

const codec::LayerOrder& order_of(const Chart& chart) {
  static const std::vector<codec::LayerOrder> all(charts().begin(), charts().end());
  return all[static_cast<std::size_t>(&chart - charts().data())];
}

}  // namespace

std::vector<Seed> seeds() {
  std::vector<Seed> all;
  for (std::size_t number = 0; number < charts().size(); ++number) {
    using codec::ValueKind;
    all.push_back(seed_of(number, {AttributeOf::vertex, 3, 8, ValueKind::color}, false));
    all.push_back(seed_of(number, {AttributeOf::corner, 2, 32, ValueKind::numbers}, true));
    all.push_back(seed_of(number, {AttributeOf::face, 1, 64, ValueKind::numbers}, number % 2 == 0));
    all.push_back(seed_of(number, {AttributeOf::corner, 2, codec::kDirectionBits, ValueKind::direction}, true));
  }
  return all;
}

}  // namespace ramcdb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ramcdb;
  fuzz::CoderInput input(data, size);
  const Chart& chart = fuzz::chart_of(input.byte());
  const codec::LayerOrder& order = fuzz::order_of(chart);
  const codec::LayerShape shape = fuzz::shape(input);
  codec::LayerValues values;
  if (fuzz::refuses([&] { values = codec::decode_layer(input.blob(), shape, chart, order); })) return 0;
  const std::size_t count = codec::value_count(chart, shape.of);
  fuzz::require(values.numbers.size() == count * shape.components, "another number of numbers");
  fuzz::require(values.absent.empty() || values.absent.size() == count, "another number of values");
  for (const std::uint64_t number : values.numbers)
    fuzz::require(shape.bits == 64 || number >> shape.bits == 0, "a number of more bits");
  const auto again = codec::encode_layer(values, shape, chart, order);
  fuzz::require(codec::decode_layer(again, shape, chart, order) == values, "other values come back");
  return 0;
}
