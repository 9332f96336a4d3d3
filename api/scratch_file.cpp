#include "api/scratch_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

constexpr const char* kScratchName = "scratch-";

}  // namespace

void sweep_scratch(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::vector<std::filesystem::path> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().filename().string().starts_with(kScratchName)) left.push_back(entry.path());
  for (const std::filesystem::path& file : left) std::filesystem::remove(file, ignored);
}

ScratchHandle::ScratchHandle(const std::filesystem::path& folder) : folder_(folder) {
  std::string name = (folder / (std::string(kScratchName) + "XXXXXX")).string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail(errno);
  ::unlink(name.c_str());
}

ScratchHandle::ScratchHandle(ScratchHandle&& other) noexcept
    : folder_(std::move(other.folder_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

ScratchHandle::~ScratchHandle() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ScratchHandle::fail(int error) const {
  const bool is_full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw Error(is_full ? Errc::disk_full : Errc::storage,
              "no temporary file can be written: " + std::generic_category().message(error), folder_.string(),
              is_full ? "make room on the disk of the repository" : "");
}

std::uint64_t ScratchFile::append(Bytes bytes) {
  const std::uint64_t begin = end_;
  overwrite(begin, bytes);
  end_ += bytes.size();
  return begin;
}

void ScratchFile::overwrite(std::uint64_t begin, Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(handle_.descriptor(), bytes.data(), bytes.size(), static_cast<off_t>(begin));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) handle_.fail(errno);
    begin += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void ScratchFile::read(std::uint64_t begin, std::span<std::uint8_t> to) const {
  while (!to.empty()) {
    const ssize_t got = ::pread(handle_.descriptor(), to.data(), to.size(), static_cast<off_t>(begin));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) handle_.fail(got < 0 ? errno : EIO);
    begin += static_cast<std::uint64_t>(got);
    to = to.subspan(static_cast<std::size_t>(got));
  }
}

Buffer ScratchFile::read(std::uint64_t begin, std::size_t size) const {
  Buffer bytes(size);
  read(begin, bytes);
  return bytes;
}

ScratchView::ScratchView(const ScratchFile& file) : size_(file.size()) {
  if (size_ == 0) return;
  void* mapped = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, file.handle().descriptor(), 0);
  if (mapped == MAP_FAILED) file.handle().fail(errno);
  bytes_ = static_cast<const std::byte*>(mapped);
}

ScratchView::~ScratchView() {
  if (bytes_ != nullptr) ::munmap(const_cast<std::byte*>(bytes_), size_);
}

ScratchMemory::ScratchMemory(const std::filesystem::path& folder, std::uint64_t size) : handle_(folder), size_(size) {
  if (size == 0) return;
  // Room that turned out not to be there when it is first touched would be a SIGBUS.
  int error = 0;
  do error = ::posix_fallocate(handle_.descriptor(), 0, static_cast<off_t>(size));
  while (error == EINTR);
  if (error != 0) handle_.fail(error);
  void* mapped = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, handle_.descriptor(), 0);
  if (mapped == MAP_FAILED) handle_.fail(errno);
  bytes_ = static_cast<std::byte*>(mapped);
}

ScratchMemory::~ScratchMemory() {
  if (bytes_ != nullptr) ::munmap(bytes_, size_);
}

}  // namespace ramcdb::detail
