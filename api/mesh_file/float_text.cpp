#include "api/mesh_file/float_text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace ramcdb::mesh_file {
namespace {

/// From here on numbers round to infinity: half a step above the largest float32, 2^128 - 2^103.
constexpr double kTooLarge = 0x1.ffffffp127;

/// Exponents of the last digit that a float32 of nine or fewer digits can have, and more.
constexpr int kLeastExponent = -64, kMostExponent = 40;

constexpr auto kPowersOfTen = [] {
  std::array<double, kMostExponent - kLeastExponent + 1> powers{};
  double power = 1;
  for (int e = 0; e <= kMostExponent; ++e, power *= 10) powers[static_cast<std::size_t>(e - kLeastExponent)] = power;
  power = 1;
  for (int e = 0; e >= kLeastExponent; --e, power *= 10)
    powers[static_cast<std::size_t>(e - kLeastExponent)] = 1 / power;
  return powers;
}();

/// What one step of the last digit of a decimal number is worth; 0 when that is too small for float32.
double unit_of_last_digit(std::string_view text) {
  int exponent = 0;
  bool fraction = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '.') {
      fraction = true;
    } else if (c == 'e' || c == 'E') {
      int written = 0;
      const std::size_t plus = i + 1 < text.size() && text[i + 1] == '+';
      if (std::from_chars(text.data() + i + 1 + plus, text.data() + text.size(), written).ec != std::errc()) return 0;
      exponent = written < kLeastExponent ? kLeastExponent - 1 : written + exponent;
      break;
    } else if (fraction && exponent > kLeastExponent - 1) {
      --exponent;
    }
  }
  if (exponent < kLeastExponent || exponent > kMostExponent) return 0;
  return kPowersOfTen[static_cast<std::size_t>(exponent - kLeastExponent)];
}

}  // namespace

bool float_holds(std::string_view text, double value) {
  if (std::abs(value) >= kTooLarge) return false;
  const double off = std::abs(nearest_float(value) - value);
  if (off == 0) return true;
  // Of thirteen digits and more only the very number counts: else a double next to a float32 would be rounded to it.
  const double unit = unit_of_last_digit(text), size = std::abs(value);
  return unit > size * 0x1p-40 && off <= 0.5 * unit + size * 0x1p-51;  // what the double itself is off
}

}  // namespace ramcdb::mesh_file
