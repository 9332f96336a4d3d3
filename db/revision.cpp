#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "db/store_impl.h"
#include "ramcdb/error.h"

/// What users call a version:
///
///     revision = name ("~" [count])*          name = "" | "HEAD" | number | "v" number | branch | tag
namespace ramcdb::db {
namespace {

std::optional<std::uint32_t> number_in(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string known_names(Catalogue& catalogue) {
  std::string names;
  for (const Ref& ref : catalogue.refs().all()) names += (names.empty() ? "" : ", ") + ref.name;
  const VersionId newest = catalogue.newest();
  if (!newest) return "nothing is published yet";
  return fmt::format("there are versions up to {} and {}", newest.value, names);
}

VersionId first_parent(Catalogue& catalogue, VersionId version, std::string_view revision) {
  const auto info = version ? catalogue.version(version) : std::nullopt;
  if (!info || info->parents.empty())
    throw Error(Errc::not_found, fmt::format("'{}' goes back beyond the first version", revision), {},
                known_names(catalogue));
  return info->parents.front();
}

[[noreturn]] void refuse_lost(VersionId version) {
  throw Error(Errc::corrupt, fmt::format("version {} has lost its blobs", version.value), {},
              "restore both files from the same backup");
}

/// Where blobs were lost a branch goes on with its newest version that is whole; a tag stands for one version only.
VersionId version_of(Catalogue& catalogue, const Ref& ref, std::string_view revision,
                     const std::function<bool(VersionId)>& has_blobs) {
  VersionId version = ref.version;
  while (!has_blobs(version)) {
    if (ref.is_tag) refuse_lost(version);
    version = first_parent(catalogue, version, revision);
  }
  return version;
}

VersionId named_version(Catalogue& catalogue, std::string_view name, std::string_view revision,
                        const std::function<bool(VersionId)>& has_blobs) {
  if (name.empty() || name == "HEAD") name = "main";
  if (const auto ref = catalogue.refs().find(name)) return version_of(catalogue, *ref, revision, has_blobs);
  const auto number = number_in(name.starts_with('v') ? name.substr(1) : name);
  if (number && catalogue.version(VersionId(*number))) {
    if (has_blobs(VersionId(*number))) return VersionId(*number);
    refuse_lost(VersionId(*number));
  }
  if (name == "main") return VersionId();
  throw Error(Errc::not_found, fmt::format("there is no revision '{}'", revision), {}, known_names(catalogue));
}

}  // namespace

VersionId resolve_revision(Catalogue& catalogue, std::string_view revision,
                           const std::function<bool(VersionId)>& has_blobs) {
  const std::size_t tilde = std::min(revision.find('~'), revision.size());
  VersionId version = named_version(catalogue, revision.substr(0, tilde), revision, has_blobs);
  for (std::string_view rest = revision.substr(tilde); !rest.empty();) {
    const std::size_t next = std::min(rest.find('~', 1), rest.size());
    const std::string_view count = rest.substr(1, next - 1);
    const auto steps = count.empty() ? std::optional<std::uint32_t>(1) : number_in(count);
    if (!steps)
      throw Error(Errc::invalid_argument, fmt::format("'{}' is no revision", revision), {},
                  "write a number, a branch or a tag, and ~N for N versions before it");
    for (std::uint32_t i = 0; i < *steps; ++i) version = first_parent(catalogue, version, revision);
    rest.remove_prefix(next);
  }
  return version;
}

}  // namespace ramcdb::db
