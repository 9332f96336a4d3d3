#include <fmt/format.h>

#include <algorithm>

#include "db/ref_name.h"
#include "db/store_impl.h"
#include "db/store_state.h"
#include "db/version_graph.h"
#include "ramcdb/error.h"

/// How names change: Store's create_branch to delete_tag. Each is one change_names() under the writer lock.
namespace ramcdb::db {
namespace {

constexpr std::string_view kMain = "main";

ParentsOf parents_in(Catalogue& catalogue) {
  return [&catalogue](VersionId v) { return catalogue.parents(v); };
}

/// 3, 5-9.
std::string version_list(const std::vector<VersionId>& versions) {
  std::string text;
  for (std::size_t i = 0, end; i < versions.size(); i = end) {
    for (end = i + 1; end < versions.size() && versions[end].value == versions[end - 1].value + 1;) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", versions[i].value);
    if (end - i > 1) text += fmt::format("-{}", versions[end - 1].value);
  }
  return text;
}

/// The name as it stands there. Throws not_found, or invalid_argument where it is of the other kind.
Ref existing(Catalogue& catalogue, std::string_view name, bool is_tag) {
  const std::vector<Ref> refs = catalogue.refs().all();  // a damaged one can be deleted and set, too
  const auto found = std::find_if(refs.begin(), refs.end(), [&](const Ref& r) { return r.name == name; });
  std::string names;
  for (const Ref& r : refs)
    if (r.is_tag == is_tag) names += (names.empty() ? "" : ", ") + r.name;
  const char* kind = is_tag ? "tag" : "branch";
  if (found == refs.end())
    throw Error(Errc::not_found, fmt::format("there is no {} '{}'", kind, name), {},
                names.empty() ? "there is none yet" : "there are " + names);
  if (found->is_tag != is_tag)
    throw Error(Errc::invalid_argument, fmt::format("{} is no {}", name, kind), {},
                is_tag ? "it is a branch: `ramcdb branch`" : "it is a tag: `ramcdb tag`");
  return *found;
}

std::optional<Ref> any_of_name(Catalogue& catalogue, std::string_view name) {
  for (Ref& ref : catalogue.refs().all())
    if (ref.name == name) return std::move(ref);
  return std::nullopt;
}

/// Versions that `version` leads to and no name but `except` does: what loses its name when that one goes.
std::vector<VersionId> named_only_by(Catalogue& catalogue, const Ref& except, VersionId instead = {}) {
  std::vector<VersionId> others;
  if (instead) others.push_back(instead);
  for (const Ref& ref : catalogue.refs().all())
    if (ref.name != except.name) others.push_back(ref.version);
  return only_in(parents_in(catalogue), except.version, others);
}

/// Sets a name that must be new, or with `force` may be there as one of the same kind. Returns the versions that are
/// left without a name.
std::vector<VersionId> set_ref(Catalogue& catalogue, const Ref& ref, bool force, std::optional<VersionId> expected) {
  const auto before = any_of_name(catalogue, ref.name);
  if (expected && *expected != (before ? before->version : VersionId()))
    throw Error(Errc::conflict, fmt::format("{} moved to version {}", ref.name, before ? before->version.value : 0),
                fmt::format("expected version {}", expected->value), "look at `ramcdb log` and decide again");
  if (before && before->is_tag != ref.is_tag)
    throw Error(Errc::invalid_argument,
                fmt::format("{} is the name of a {} already", ref.name, before->is_tag ? "tag" : "branch"),
                fmt::format("version {}", before->version.value), "choose another name");
  if (before && !force && !expected)
    throw Error(Errc::invalid_argument,
                fmt::format("there is a {} {} already", ref.is_tag ? "tag" : "branch", ref.name),
                fmt::format("version {}", before->version.value),
                ref.is_tag ? "choose another name, or --force to have it name another version"
                           : "choose another name, or --force to move it");
  std::vector<VersionId> nameless;
  if (before) nameless = named_only_by(catalogue, *before, ref.version);
  catalogue.refs().set(ref);
  return nameless;
}

}  // namespace

void StoreImpl::require_version(Catalogue& catalogue, VersionId version) {
  if (!version) throw Error(Errc::not_found, "nothing is published yet", {}, "import a mesh first");
  if (!catalogue.version(version))
    throw Error(Errc::not_found, fmt::format("there is no version {}", version.value), {}, "see `ramcdb log`");
  if (version > VersionId(read_state(*environment_.read()).seq))
    throw Error(Errc::corrupt, fmt::format("version {} has lost its blobs", version.value), {},
                "restore both files from the same backup");
}

std::vector<VersionId> StoreImpl::create_branch(std::string_view name, VersionId at, bool force,
                                                std::optional<VersionId> expected) {
  require_ref_name(name);
  return change_names([&](Catalogue& c) {
    require_version(c, at);
    return set_ref(c, {std::string(name), false, at}, force, expected);
  });
}

std::vector<VersionId> StoreImpl::create_tag(std::string_view name, VersionId at, bool force) {
  require_ref_name(name);
  if (name == kMain) throw Error(Errc::invalid_argument, "main is always a branch", {}, "choose another name");
  return change_names([&](Catalogue& c) {
    require_version(c, at);
    return set_ref(c, {std::string(name), true, at}, force, {});
  });
}

void StoreImpl::rename_branch(std::string_view from, std::string_view to) {
  require_ref_name(to);
  if (from == kMain) throw Error(Errc::invalid_argument, "main keeps its name: HEAD is its tip");
  (void)change_names([&](Catalogue& c) {
    Ref ref = existing(c, from, false);
    if (const auto taken = any_of_name(c, to))
      throw Error(Errc::invalid_argument, fmt::format("there is a {} {} already", taken->is_tag ? "tag" : "branch", to),
                  fmt::format("version {}", taken->version.value), "choose another name");
    c.refs().remove(from);
    ref.name = to;
    c.refs().set(ref);
    return true;
  });
}

std::vector<VersionId> StoreImpl::delete_branch(std::string_view name, bool force) {
  if (name == kMain) throw Error(Errc::invalid_argument, "main cannot be deleted: HEAD is its tip");
  return change_names([&](Catalogue& c) {
    const Ref ref = existing(c, name, false);
    std::vector<VersionId> nameless = named_only_by(c, ref);
    if (!nameless.empty() && !force)
      throw Error(Errc::invalid_argument,
                  fmt::format("without branch {} {} {} would be without a name", name,
                              nameless.size() == 1 ? "version" : "versions", version_list(nameless)),
                  {}, "merge or tag it first, or --force");
    c.refs().remove(name);
    return nameless;
  });
}

std::vector<VersionId> StoreImpl::delete_tag(std::string_view name) {
  return change_names([&](Catalogue& c) {
    const Ref ref = existing(c, name, true);
    std::vector<VersionId> nameless = named_only_by(c, ref);
    c.refs().remove(name);
    return nameless;
  });
}

std::vector<Ref> StoreImpl::refs() {
  return with_catalogue([](Catalogue& c) { return c.refs().all(); });
}

VersionId StoreImpl::tip(std::string_view branch) {
  return with_catalogue([&](Catalogue& c) { return c.refs().tip(branch); });
}

VersionId StoreImpl::merge_base(VersionId a, VersionId b) {
  return with_catalogue([&](Catalogue& c) { return db::merge_base(parents_in(c), a, b); });
}

bool StoreImpl::is_ancestor(VersionId old, VersionId version) {
  return with_catalogue([&](Catalogue& c) { return db::is_ancestor(parents_in(c), old, version); });
}

std::vector<VersionId> StoreImpl::only_in(VersionId from, const std::vector<VersionId>& others) {
  return with_catalogue([&](Catalogue& c) { return db::only_in(parents_in(c), from, others); });
}

}  // namespace ramcdb::db
