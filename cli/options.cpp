#include "cli/options.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <thread>

namespace ramcdb::cli {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

std::string refuse_empty(const std::string& text) { return text.empty() ? "must not be empty" : ""; }

/// 512M -> 536870912; says what is wrong with others.
std::string to_bytes(std::string& text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [unit, error] = std::from_chars(text.data(), end, number);
  static constexpr std::string_view kUnits = "KMGT";
  const std::size_t known = unit == end ? 0 : kUnits.find(*unit) + 1;  // npos + 1 = 0
  const int shift = 10 * static_cast<int>(known);
  if (error != std::errc() || number == 0 || (unit != end && (known == 0 || unit + 1 != end)) ||
      number > (~std::uint64_t{0} >> shift))
    return "must be a size such as 512M or 4G";
  text = std::to_string(number << shift);
  return "";
}

}  // namespace

std::string default_author() {
  if (std::string author = environment("RAMCDB_AUTHOR"); !author.empty()) return author;
  const std::string user = environment("USER");
  if (user.empty()) return "unknown";
  std::array<char, 256> host = {};
  if (gethostname(host.data(), host.size() - 1) != 0 || host[0] == '\0') return user;
  return user + '@' + host.data();
}

void add_output_mode(CLI::App& verb, OutputMode& mode) {
  verb.add_flag("--json", mode.json, "Print one JSON object and nothing else");
  verb.add_flag("-q,--quiet", mode.quiet, "No progress and no report of what was done");
}

void add_repository(CLI::App& verb, std::string& folder) {
  verb.add_option("REPO", folder, "The repository, a folder")->required();
}

void add_checked_out_file(CLI::App& verb, std::string& file) {
  verb.add_option("FILE", file, "A checked-out file; its sidecar FILE.ramcdb.json must lie beside it")->required();
}

void add_mesh(CLI::App& verb, MeshAt& which) {
  verb.add_option("--mesh", which.mesh, "The mesh; may be left out where the repository holds one")->type_name("NAME");
}

void add_at(CLI::App& verb, MeshAt& which) {
  verb.add_option("--at", which.at,
                  "The version: 17, v17, a branch, a tag, HEAD, each with ~N (default: the tip of main)")
      ->type_name("REV");
}

void add_threads(CLI::App& verb, unsigned& threads) {
  threads = std::max(1U, std::thread::hardware_concurrency());
  verb.add_option("-j,--threads", threads, "Threads; they change the time, never the result (default: all cores)")
      ->type_name("N")
      ->check(CLI::Range(1U, 1024U));
}

void add_memory(CLI::App& verb, std::uint64_t& bytes, const std::string& what) {
  bytes = std::uint64_t{1} << 30;
  verb.add_option("--memory", bytes, what + " (default: 1G)")
      ->type_name("SIZE")
      ->transform(CLI::Validator(to_bytes, ""));
}

void add_message(CLI::App& verb, std::string& message, bool required) {
  verb.add_option("-m,--message", message, "What the version is about")
      ->type_name("MSG")
      ->required(required)
      ->check(CLI::Validator(refuse_empty, ""));
}

void add_author(CLI::App& verb, std::string& author) {
  author = default_author();
  verb.add_option("--author", author, "Who made it (default: $RAMCDB_AUTHOR, else user@host)")
      ->type_name("NAME")
      ->check(CLI::Validator(refuse_empty, ""));
}

void add_example(CLI::App& verb, const std::string& command, const std::string& notes) {
  verb.footer(notes + (notes.empty() ? "" : "\n\n") + "Example:\n  " + command);
}

}  // namespace ramcdb::cli
