#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

/// How the program ends.
namespace ramcdb::cli {

// Scripts rely on these: never renumber.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kWrongUsage = 2;
inline constexpr int kConflict = 3;
inline constexpr int kDamageFound = 4;
inline constexpr int kInterrupted = 130;  ///< as a shell reports a program that Ctrl-C ended

/// Wrong usage that the parser cannot see, such as a malformed region. The text is the whole line, without `ramcdb: `.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One line on standard error: `ramcdb: TEXT`. Line ends and control characters within become spaces.
void complain(std::string_view text) noexcept;

/// `WHAT (VERB): see `ramcdb VERB --help``, for a mistake on the command line. `verb` may be empty.
[[nodiscard]] std::string usage_text(std::string_view what, std::string_view verb);

/// Complains about the exception in flight and returns the exit code for it. REQUIRES: called in a catch block.
[[nodiscard]] int report_exception(std::string_view verb) noexcept;

}  // namespace ramcdb::cli
