#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cli/options.h"
#include "cli/region_options.h"
#include "ramcdb/repository.h"

/// What verbs that edit a region by themselves have in common.
namespace ramcdb::cli {

struct BuiltInEdit {
  std::string folder;
  MeshAt which;
  RegionOptions region;
  std::uint64_t memory = 0;  ///< bytes
  CommitOptions commit;
  OutputMode mode;
};

/// REPO, REGION, -m and the options of commits.
void add_region_edit(CLI::App& verb, BuiltInEdit& edit);
/// The same, and --memory.
void add_built_in_edit(CLI::App& verb, BuiltInEdit& edit);
/// Of an edit that moved vertices.
[[nodiscard]] std::string moved_text(const CommitReport& report);

/// Prints the report of an edit; returns the exit code. \param verb what to repeat after a conflict
/// \param text the report for people
[[nodiscard]] int finish_built_in_edit(const CommitReport& report, const OutputMode& mode, std::string_view verb,
                                       std::string (*text)(const CommitReport&) = moved_text);

/// Finite numbers separated by commas or blanks. Throws UsageError unless there are as many as one of `counts` says.
/// \param form what was expected, as the option's help has it
[[nodiscard]] std::vector<double> numbers_of(const std::string& option, const std::string& text,
                                             std::initializer_list<std::size_t> counts, const std::string& form);

}  // namespace ramcdb::cli
