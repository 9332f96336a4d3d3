#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace ramcdb::db {

/// An exclusive kernel lock on a file, made when it does not exist. It ends with the object or with its process,
/// whichever comes first, and holds between threads of one process as it does between processes.
class FileLock {
 public:
  /// Nothing while somebody else holds the lock. Throws storage when the file cannot be made or opened.
  [[nodiscard]] static std::optional<FileLock> try_take(const std::filesystem::path& file);
  /// Tries again until the time is over; then throws storage, naming who holds the lock.
  [[nodiscard]] static FileLock take(const std::filesystem::path& file, double wait_seconds);

  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

  /// Replaces what stands in the file: for people who look, and for take()'s message.
  void write_note(const std::string& note) const;

 private:
  explicit FileLock(int fd) : fd_(fd) {}
  int fd_ = -1;
};

/// Whether somebody holds a lock on the file. Leaves it as it is.
[[nodiscard]] bool is_locked(const std::filesystem::path& file);

}  // namespace ramcdb::db
