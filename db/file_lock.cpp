#include "db/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>

#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

constexpr std::chrono::milliseconds kFirstPause{1}, kLongestPause{50};

bool is_same_file(int fd, const std::filesystem::path& file) {
  struct stat held {
  }, named{};
  return ::fstat(fd, &held) == 0 && ::stat(file.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
         held.st_ino == named.st_ino;
}

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line.empty() ? "somebody" : line;
}

}  // namespace

FileLock::FileLock(FileLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

FileLock::~FileLock() {
  if (fd_ >= 0) ::close(fd_);
}

std::optional<FileLock> FileLock::try_take(const std::filesystem::path& file) {
  for (;;) {
    FileLock lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (lock.fd_ < 0) throw Error(Errc::storage, std::strerror(errno), file.string(), "the folder must be writable");
    if (::flock(lock.fd_, LOCK_EX | LOCK_NB) != 0) return std::nullopt;
    if (is_same_file(lock.fd_, file)) return lock;  // else it was swept between open and lock
  }
}

FileLock FileLock::take(const std::filesystem::path& file, double wait_seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(wait_seconds);
  for (auto pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    if (auto lock = try_take(file)) return std::move(*lock);
    if (std::chrono::steady_clock::now() >= end)
      throw Error(Errc::storage, fmt::format("{} is writing to the repository", first_line(file)), file.string(),
                  fmt::format("waited {:.0f} s; try again later", wait_seconds));
    std::this_thread::sleep_for(pause);
  }
}

void FileLock::write_note(const std::string& note) const {
  // A note that cannot be written is no reason to stop.
  if (::ftruncate(fd_, 0) == 0) [[maybe_unused]]
    const ssize_t written = ::pwrite(fd_, note.data(), note.size(), 0);
}

bool is_locked(const std::filesystem::path& file) {
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool locked = ::flock(fd, LOCK_SH | LOCK_NB) != 0;
  ::close(fd);
  return locked;
}

}  // namespace ramcdb::db
