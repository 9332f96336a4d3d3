#include "db/ref_name.h"

#include <fmt/format.h>

#include <algorithm>

#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

bool is_number(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool has_odd_character(std::string_view name) {
  return std::any_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte <= ' ' || byte == 127 || std::string_view("~^:?*[\\").find(c) != std::string_view::npos;
  });
}

/// What is wrong with a name; empty when nothing is.
std::string_view fault_of(std::string_view name) {
  const auto has = [&](std::string_view part) { return name.find(part) != std::string_view::npos; };
  if (name.empty()) return "it is empty";
  if (name.size() > kMostRefNameBytes) return "it is longer than 200 bytes";
  if (has_odd_character(name)) return "it holds a space, a control character or one of ~^:?*[\\";
  if (name.front() == '-' || name.front() == '.' || name.front() == '/') return "it begins with -, . or /";
  if (name.back() == '.' || name.back() == '/' || name.ends_with(".lock")) return "it ends with ., / or .lock";
  if (has("..") || has("@{") || has("//") || has("/.")) return "it holds .., @{, // or /.";
  if (name == "HEAD" || name == "@") return "it stands for the tip of main";
  if (is_number(name) || (name.front() == 'v' && is_number(name.substr(1)))) return "it reads as a version's number";
  return {};
}

/// For a message: what could break a line becomes '?', and no novel.
std::string shown(std::string_view name) {
  std::string text(name.substr(0, 60));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 127) c = '?';
  return name.size() > text.size() ? text + "..." : text;
}

}  // namespace

void require_ref_name(std::string_view name) {
  if (const std::string_view fault = fault_of(name); !fault.empty())
    throw Error(Errc::invalid_argument, fmt::format("'{}' is no name for a branch or a tag", shown(name)), fault,
                "choose a name such as left-horn or review/2");
}

}  // namespace ramcdb::db
