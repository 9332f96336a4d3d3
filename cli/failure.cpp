#include "cli/failure.h"

#include <cstdio>
#include <exception>
#include <new>

#include "cli/text.h"
#include "ramcdb/error.h"

namespace ramcdb::cli {
namespace {

int exit_code(Errc code) {
  switch (code) {
    case Errc::corrupt:
      return kDamageFound;
    case Errc::conflict:
      return kConflict;
    case Errc::cancelled:
      return kInterrupted;
    case Errc::invalid_argument:
    case Errc::not_found:
    case Errc::unsupported_version:
    case Errc::limit_exceeded:
    case Errc::storage:
    case Errc::disk_full:
      break;
  }
  return kFailed;
}

}  // namespace

void complain(std::string_view text) noexcept {
  // Written piece by piece with no allocation of its own, since memory may be what is missing.
  std::fputs("ramcdb: ", stderr);
  for (const char c : text) std::fputc(is_control(c) ? ' ' : c, stderr);
  std::fputc('\n', stderr);
}

std::string usage_text(std::string_view what, std::string_view verb) {
  std::string text(what);
  if (verb.empty()) return text + ": see `ramcdb --help`";
  return text.append(" (").append(verb).append("): see `ramcdb ").append(verb).append(" --help`");
}

int report_exception(std::string_view verb) noexcept {
  try {
    throw;
  } catch (const UsageError& e) {
    complain(e.what());
    return kWrongUsage;
  } catch (const Error& e) {
    complain(e.what());
    return exit_code(e.code());
  } catch (const std::bad_alloc&) {
    complain("out of memory: take a smaller region, fewer threads (-j 1) or a machine with more memory");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "ramcdb: %.*s failed (", static_cast<int>(verb.size()), verb.data());
    for (const char* c = e.what(); *c != '\0'; ++c) std::fputc(is_control(*c) ? ' ' : *c, stderr);
    std::fputs("): this is not a failure that ramcdb knows, please report it\n", stderr);
  } catch (...) {
    complain("failed (unknown exception): please report it");
  }
  return kFailed;
}

}  // namespace ramcdb::cli
