#include "db/pins.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <optional>
#include <utility>

#include "db/file_lock.h"
#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

class NoPin : public Pin {};

class FilePin : public Pin {
 public:
  FilePin(std::filesystem::path file, FileLock lock) : file_(std::move(file)), lock_(std::move(lock)) {}
  ~FilePin() override {
    // A forked child holds the lock with its parent, whose pin this is.
    if (::getpid() != process_) return;
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }

 private:
  std::filesystem::path file_;
  FileLock lock_;
  pid_t process_ = ::getpid();
};

std::optional<VersionId> version_in(const std::string& name) {
  std::uint32_t version = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), version);
  if (error != std::errc() || end == name.data() + name.size() || *end != '-') return std::nullopt;
  return VersionId(version);
}

}  // namespace

std::unique_ptr<Pin> take_pin(const std::filesystem::path& folder, VersionId version, std::string_view holder) {
  static std::atomic<std::uint64_t> count{0};
  if (!version || ::access(folder.c_str(), W_OK) != 0) return std::make_unique<NoPin>();
  for (;;) {
    const auto file = folder / fmt::format("{}-{}-{}", version.value, ::getpid(), ++count);
    auto lock = FileLock::try_take(file);
    if (!lock) continue;  // a sweep looks at it
    lock->write_note(fmt::format("{}\n", holder));
    return std::make_unique<FilePin>(file, std::move(*lock));
  }
}

std::vector<VersionId> sweep_pins(const std::filesystem::path& folder) {
  std::vector<VersionId> pinned;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const auto version = version_in(entry.path().filename().string());
    if (!version) continue;
    if (is_locked(entry.path()))
      pinned.push_back(*version);
    else
      std::filesystem::remove(entry.path(), ignored);
  }
  std::sort(pinned.begin(), pinned.end());
  pinned.erase(std::unique(pinned.begin(), pinned.end()), pinned.end());
  return pinned;
}

}  // namespace ramcdb::db
