#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include <fast_float/fast_float.h>

#include "ramcdb/error.h"
#include "ramcdb/region.h"

namespace ramcdb {
namespace {

[[noreturn]] void wrong(std::string_view text, std::string_view form) {
  throw Error(Errc::invalid_argument, fmt::format("cannot read the region '{}'", text), {},
              fmt::format("write it as {}", form));
}

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(at, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

/// Just `count` finite numbers, separated by commas or blanks.
std::vector<double> numbers(std::string_view text, std::size_t count, std::string_view form) {
  std::string commas(text);
  for (char& c : commas)
    if (c == ' ') c = ',';
  std::vector<double> values;
  for (const std::string_view part : split(commas, ',')) {
    double value = 0;
    const auto [end, error] = fast_float::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(value)) wrong(text, form);
    values.push_back(value);
  }
  if (values.size() != count) wrong(text, form);
  return values;
}

std::uint32_t chart_number(std::string_view part, std::string_view text, std::string_view form) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc() || end != part.data() + part.size() || value == 0) wrong(text, form);
  return value;
}

}  // namespace

InBox parse_box(std::string_view text) {
  constexpr std::string_view form = "X0,Y0,Z0,X1,Y1,Z1 with X0 <= X1, Y0 <= Y1, Z0 <= Z1";
  const auto n = numbers(text, 6, form);
  for (std::size_t a = 0; a < 3; ++a)
    if (n[a] > n[a + 3]) wrong(text, form);
  return {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
}

InSphere parse_sphere(std::string_view text) {
  constexpr std::string_view form = "X,Y,Z,R with R >= 0";
  const auto n = numbers(text, 4, form);
  if (n[3] < 0) wrong(text, form);
  return {{n[0], n[1], n[2]}, n[3]};
}

NearestTo parse_nearest(std::string_view text) {
  const auto n = numbers(text, 3, "X,Y,Z");
  return {{n[0], n[1], n[2]}};
}

InFrustum parse_frustum(std::string_view text) {
  const auto n = numbers(text, 16, "16 numbers, a row-major clip matrix");
  InFrustum frustum;
  std::copy(n.begin(), n.end(), frustum.clip.begin());
  return frustum;
}

OfCharts parse_charts(std::string_view text) {
  constexpr std::string_view form = "chart numbers such as 5,9-12";
  constexpr std::uint32_t kMost = 100'000'000;
  OfCharts charts;
  for (const std::string_view part : split(text, ',')) {
    const std::size_t dash = part.find('-');
    const std::uint32_t first = chart_number(part.substr(0, dash), text, form);
    const std::uint32_t last = dash == std::string_view::npos ? first : chart_number(part.substr(dash + 1), text, form);
    if (last < first || last - first >= kMost) wrong(text, form);
    for (std::uint32_t id = first; id <= last; ++id) {
      charts.charts.emplace_back(id);
      if (id == ~std::uint32_t{0}) break;
    }
  }
  return charts;
}

}  // namespace ramcdb
