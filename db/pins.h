#pragma once

#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "db/store.h"

/// Who reads which version: a file per pin, `VERSION-PROCESS-COUNT`, with a kernel lock that ends with its process, so
/// that no clock decides whether a pin still holds. Readers need no write access to either store.
namespace ramcdb::db {

/// Where the folder cannot be written (an archive on a read-only medium) nobody prunes either, and the pin is empty.
[[nodiscard]] std::unique_ptr<Pin> take_pin(const std::filesystem::path& folder, VersionId version,
                                            std::string_view holder);

/// The versions that are pinned, ascending; removes the files of processes that are gone. REQUIRES: the writer lock.
std::vector<VersionId> sweep_pins(const std::filesystem::path& folder);

}  // namespace ramcdb::db
