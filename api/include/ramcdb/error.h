#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace ramcdb {

/// Why an operation ended. The command line maps these to exit codes.
enum class Errc {
  invalid_argument,     ///< the caller's input is wrong: options, a mesh file, a region
  not_found,            ///< a file, mesh, version or chart that does not exist
  corrupt,              ///< stored bytes are damaged or hostile
  unsupported_version,  ///< written by a newer format version
  limit_exceeded,       ///< a documented limit: lattice width, counts, memory
  storage,              ///< the operating system or a store refused
  disk_full,            ///< no room: nothing was changed
  conflict,             ///< somebody else's newer version is in the way
  cancelled,            ///< the caller asked to stop
};

/// The one exception type of the library. Its text reads `WHAT (WHERE): HOW TO GO ON`, on one line; parts that are
/// empty are left out.
class Error : public std::runtime_error {
 public:
  Error(Errc code, std::string_view what, std::string_view where = {}, std::string_view how_to_go_on = {})
      : std::runtime_error(compose(what, where, how_to_go_on)), code_(code) {}

  [[nodiscard]] Errc code() const noexcept { return code_; }

 private:
  static std::string compose(std::string_view what, std::string_view where, std::string_view how) {
    std::string text(what);
    if (!where.empty()) text.append(" (").append(where).append(")");
    if (!how.empty()) text.append(": ").append(how);
    return text;
  }

  Errc code_;
};

}  // namespace ramcdb
