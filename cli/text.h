#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "ramcdb/geometry.h"
#include "ramcdb/ids.h"

/// Numbers, times and foreign text as people read them. No locale anywhere.
namespace ramcdb::cli {

/// 1234567 -> "1,234,567".
[[nodiscard]] std::string grouped(std::uint64_t n);

/// `n` with its noun: "1 chart", "1,234 charts". `plural` defaults to the noun with an s.
[[nodiscard]] std::string counted(std::uint64_t n, std::string_view noun, std::string_view plural = {});

/// A length or position in model units, 9 significant digits: as many as a float needs to come back exactly.
[[nodiscard]] std::string model_units(double value);

/// "x,y,z" as the region options take it.
[[nodiscard]] std::string point_text(const Point& p);

/// Bits per vertex, 0 for a mesh without vertices.
[[nodiscard]] double bits_per_vertex(std::uint64_t bytes, std::uint64_t vertices);

/// A figure with a fixed number of decimals: fixed(1.5, 3) -> "1.500".
[[nodiscard]] std::string fixed(double value, int decimals);

/// "0.42 s", "8.1 s", "3 min 20 s", "2 h 05 min".
[[nodiscard]] std::string duration(double seconds);

/// ISO 8601 in UTC from microseconds since 1970: "2026-07-01T12:34:56Z", with ".123456" before the Z if `precise`.
[[nodiscard]] std::string iso_time(std::int64_t time_us, bool precise);

/// "v17", and "none" for the id 0.
[[nodiscard]] std::string version_text(VersionId id);

/// True for bytes that would move a terminal's cursor or break a line: below 32 and 127.
[[nodiscard]] bool is_control(char c);

/// Foreign text (a message, a name) made fit for one line of a terminal: cut at the first line end, other control
/// characters become '?'.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace ramcdb::cli
