#pragma once

#include <string>

#include "ramcdb/ids.h"

namespace ramcdb::db {

/// A name for a version. A branch moves with every version that is published on it; a tag stays. No branch and tag
/// share a name.
struct Ref {
  std::string name;
  bool is_tag = false;
  VersionId version;

  friend bool operator==(const Ref&, const Ref&) = default;
};

}  // namespace ramcdb::db
