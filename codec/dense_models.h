#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "codec/adaptive_symbol.h"
#include "codec/built_in_prior.h"
#include "codec/dense_math.h"
#include "codec/range_coder.h"
#include "ramcdb/error.h"

/// What the dense coder learns while it codes a chart: one adaptive bit per decision and context. Every chart starts
/// from the same state, so that it opens alone.
namespace ramcdb::codec {

/// A bit's beginning, as the built-in prior says it: the probability of a one in 1/8192, and in the lowest three bits
/// how many earlier bits it stands for, one of kPriorBits.
inline constexpr std::array<std::uint16_t, 8> kPriorBits{0, 2, 5, 10, 20, 40, 80, 120};
inline AdaptiveBit built_in_bit(std::uint16_t prior) {
  return {static_cast<std::uint16_t>(prior & 0xfff8), kPriorBits[prior & 7]};
}

/// How many edges a pivot has inside its open corner: unary, by the corner's angle and the faces the pivot has already.
class FanSizeModel {
 public:
  /// Calls `visit` with every bit that has a built-in beginning, in a fixed order.
  template <class Visit>
  void visit_built_in(Visit&& visit) {
    for (auto& row : bits_)
      for (auto& bits : row)
        for (std::size_t i = 0; i < 6; ++i) visit(bits[i]);
  }

  /// \param angle of corner_angle() \param faces of the pivot \param max the largest size that can be meant
  template <class Coder>
  RAMCDB_INLINE std::uint32_t code(Coder& coder, std::uint32_t angle, std::uint32_t faces, bool on_border,
                                   std::size_t max, std::uint32_t size) {
    const std::size_t angle_class = angle * 40 / kWholeTurn;
    auto& bits = bits_[angle_class][on_border ? 9 : std::min<std::size_t>(8, faces)];
    std::uint32_t n = 0;
    while (coder.code(bits[std::min<std::size_t>(15, n)], size > n)) {
      if (++n > max) throw Error(Errc::corrupt, "a chart has more faces than it declares");
    }
    return n;
  }

 private:
  std::array<std::array<std::array<AdaptiveBit, 16>, 10>, 40> bits_;
};

/// How far a coordinate is from its prediction, in one go: sixteen symbols for its sign and size.
///
/// On fine lattices the lowest bits say nothing, and are sent raw. Of what is above them, symbol 0 is 0; symbols 1 to
/// 14 are, with a plus and a minus sign in turn, the sizes 1, 2, 3, 4-5, 6-7, 8-11, 12-15, with raw bits for which one;
/// symbol 15 is all others, with a symbol of their own for sign and bit width.
struct MissModels {
  static constexpr std::size_t kActivities = 16, kDoubts = 12;

  std::array<AdaptiveSymbol, 3 * kDoubts * kActivities> misses;
  std::array<AdaptiveSymbol, 3 * kActivities> large;
  std::array<AdaptiveBit, 32> large_half;  ///< the second-highest bit of a large size, by its bit width

  template <class Visit>
  void visit_built_in(Visit&& visit) {
    for (AdaptiveSymbol& model : misses) visit(model);
    for (AdaptiveSymbol& model : large) visit(model);
  }

  /// \param k 0, 1: first and second tangential axis, 2: the axis along the normal \param fine how many bits are raw
  template <class Coder>
  std::int32_t code(Coder& coder, std::size_t k, std::size_t doubt, std::size_t activity, int fine, std::int32_t miss) {
    const std::int32_t above = miss >> fine;
    const auto low = static_cast<std::uint32_t>(miss) & ((1U << fine) - 1);
    const std::uint32_t size = above < 0 ? 0U - static_cast<std::uint32_t>(above) : static_cast<std::uint32_t>(above);
    std::uint32_t symbol = 0;
    if constexpr (Coder::kEncodes) symbol = size < 16 ? 2 * kSizeClass[size] - (above > 0) : 15;
    symbol = coder.code_symbol(misses[(k * kDoubts + doubt) * kActivities + activity], symbol);
    if (symbol == 15) return code_large(coder, large[k * kActivities + activity], fine, above, low);
    const std::size_t size_class = (symbol + 1) / 2;
    const int raw_bits = kRawBits[size_class] + fine;
    std::uint32_t raw = (size - kLeastSize[size_class]) << fine | low;
    raw = raw_bits > 0 ? coder.code_raw(raw, raw_bits) : 0;
    return joined(symbol % 2 == 0, kLeastSize[size_class] + (raw >> fine), fine, raw & ((1U << fine) - 1));
  }

 private:
  static constexpr std::array<std::uint8_t, 16> kSizeClass{0, 1, 2, 3, 4, 4, 5, 5, 6, 6, 6, 6, 7, 7, 7, 7};
  static constexpr std::array<std::uint8_t, 8> kLeastSize{0, 1, 2, 3, 4, 6, 8, 12};
  static constexpr std::array<std::uint8_t, 8> kRawBits{0, 0, 0, 0, 1, 1, 2, 2};

  static std::int32_t joined(bool negative, std::uint32_t size, int fine, std::uint32_t low) {
    return static_cast<std::int32_t>((negative ? 0U - size : size) << fine | low);
  }

  /// A size of 16 and more: with its bit width less 5, up to 6, the symbols are plus and minus in turn, 14 and 15 are
  /// for all above, which is sent raw; then the bits below the highest.
  template <class Coder>
  std::int32_t code_large(Coder& coder, AdaptiveSymbol& model, int fine, std::int32_t above, std::uint32_t low) {
    const std::uint32_t size = above < 0 ? 0U - static_cast<std::uint32_t>(above) : static_cast<std::uint32_t>(above);
    std::uint32_t width = Coder::kEncodes ? static_cast<std::uint32_t>(std::bit_width(size)) - 5 : 0;
    const std::uint32_t symbol = coder.code_symbol(model, 2 * std::min(width, 7U) + (above < 0));
    width = symbol < 14 ? symbol / 2 : 7 + coder.code_raw(width - 7, 5);
    if (width > 26) throw Error(Errc::corrupt, "a chart has a vertex beyond any lattice");
    const int below = static_cast<int>(width) + 3;  // bits below the two highest
    std::uint32_t found = 2U | coder.code(large_half[width], (size >> below) & 1);
    found = found << below | coder.code_raw(size & ((1U << below) - 1), below);
    return joined(symbol % 2 != 0, found, fine, coder.code_raw(low, fine));
  }
};

/// All of a chart's models.
struct DenseModels {
  FanSizeModel fan_size;
  std::array<std::array<AdaptiveBit, 16>, 4> join;  ///< by edges left at the pivot, by size of the front
  AdaptiveUnsigned join_rank;
  std::array<AdaptiveSigned, 3> seed;      ///< corners of a closed component, by axis
  std::array<AdaptiveSigned, 3> isolated;  ///< vertices without faces, by axis
  /// Whether a coordinate is the i-th candidate, by axis and where the two before were found.
  std::array<std::array<std::array<std::array<AdaptiveBit, 4>, 5>, 5>, 3> aligned;
  MissModels miss;

  /// Begins with what is built in: for fine lattices, whose misses have many bits, and for others.
  static const DenseModels& built_in(bool is_fine) {
    static const std::array<DenseModels, 2> both{DenseModels(kBuiltInBits[0], kBuiltInSymbols[0]),
                                                 DenseModels(kBuiltInBits[1], kBuiltInSymbols[1])};
    return both[is_fine];
  }

  /// Calls `visit` with every bit, then every symbol that has a built-in beginning, in a fixed order.
  template <class Visit>
  void visit_built_in(Visit&& visit) {
    fan_size.visit_built_in(visit);
    for (auto& bits : join)
      for (AdaptiveBit& bit : bits) visit(bit);
    miss.visit_built_in(visit);
  }

 private:
  struct Beginnings {
    const std::uint16_t* bit;
    const AdaptiveSymbol::Lanes* symbol;
    void operator()(AdaptiveBit& model) { model = built_in_bit(*bit++); }
    void operator()(AdaptiveSymbol& model) { model = AdaptiveSymbol(*symbol++); }
  };

  template <class Bits, class Symbols>
  DenseModels(const Bits& bits, const Symbols& symbols) {
    visit_built_in(Beginnings{bits.data(), symbols.data()});
  }
};

}  // namespace ramcdb::codec
