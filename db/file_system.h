#pragma once

#include <cstdint>
#include <filesystem>

namespace ramcdb::db {

/// Bytes that a file occupies on disk (its blocks, not its length); 0 where it does not exist.
[[nodiscard]] std::uint64_t bytes_on_disk(const std::filesystem::path& file);

/// Bytes that may still be written to the file system of `path`.
[[nodiscard]] std::uint64_t free_bytes(const std::filesystem::path& path);

/// Throws disk_full unless `need` bytes are free.
void require_free_bytes(const std::filesystem::path& path, std::uint64_t need);

/// Neither memory maps nor locks can be trusted across machines.
[[nodiscard]] bool is_network_file_system(const std::filesystem::path& path);

/// Makes the names in a folder durable.
void sync_folder(const std::filesystem::path& folder);

}  // namespace ramcdb::db
