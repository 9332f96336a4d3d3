#include "cli/text.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

namespace ramcdb::cli {

std::string grouped(std::uint64_t n) {
  std::string digits = std::to_string(n);
  for (std::size_t from_end = 3; from_end < digits.size(); from_end += 4)
    digits.insert(digits.size() - from_end, 1, ',');
  return digits;
}

std::string counted(std::uint64_t n, std::string_view noun, std::string_view plural) {
  std::string text = grouped(n) + ' ';
  if (n == 1) return text.append(noun);
  return plural.empty() ? text.append(noun).append("s") : text.append(plural);
}

std::string model_units(double value) { return fmt::format("{:.9g}", value); }

std::string point_text(const Point& p) { return fmt::format("{:.9g},{:.9g},{:.9g}", p.x, p.y, p.z); }

double bits_per_vertex(std::uint64_t bytes, std::uint64_t vertices) {
  return vertices == 0 ? 0 : 8.0 * static_cast<double>(bytes) / static_cast<double>(vertices);
}

std::string fixed(double value, int decimals) { return fmt::format("{:.{}f}", value, decimals); }

std::string duration(double seconds) {
  if (seconds < 1) return fmt::format("{:.2f} s", seconds);
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string iso_time(std::int64_t time_us, bool precise) {
  using namespace std::chrono;
  const sys_time<microseconds> time{microseconds(time_us)};
  const sys_days day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(time - day);
  const std::string fraction = precise ? fmt::format(".{:06}", clock.subseconds().count()) : "";
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}{}Z", int(date.year()), unsigned(date.month()),
                     unsigned(date.day()), clock.hours().count(), clock.minutes().count(), clock.seconds().count(),
                     fraction);
}

std::string version_text(VersionId id) { return id ? fmt::format("v{}", id.value) : "none"; }

bool is_control(char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }

std::string one_line(std::string_view text) {
  std::string line(text.substr(0, text.find_first_of("\r\n")));
  for (char& c : line)
    if (is_control(c)) c = '?';
  return line;
}

}  // namespace ramcdb::cli
