#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>

#include "ramcdb/bytes.h"

/// Room for what does not fit memory: files in a repository's folder that lose their name as soon as they are made, so
/// that they are gone with the process however it ends. The instant between is what sweep_scratch is for.
namespace ramcdb::detail {

/// Takes the names away that killed processes left. What others have open goes on being theirs.
void sweep_scratch(const std::filesystem::path& folder);

/// An open file without a name.
class ScratchHandle {
 public:
  /// Throws storage, disk_full.
  explicit ScratchHandle(const std::filesystem::path& folder);
  ScratchHandle(ScratchHandle&& other) noexcept;
  ScratchHandle& operator=(ScratchHandle&&) = delete;
  ~ScratchHandle();

  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Throws what the operating system's error number says.
  [[noreturn]] void fail(int error) const;

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
};

/// Blobs one behind the other, to be read again by their place.
class ScratchFile {
 public:
  explicit ScratchFile(const std::filesystem::path& folder) : handle_(folder) {}

  [[nodiscard]] std::uint64_t size() const { return end_; }
  [[nodiscard]] const ScratchHandle& handle() const { return handle_; }

  /// Returns where the bytes begin.
  std::uint64_t append(Bytes bytes);
  /// Over bytes that were appended.
  void overwrite(std::uint64_t begin, Bytes bytes);
  void read(std::uint64_t begin, std::span<std::uint8_t> to) const;
  [[nodiscard]] Buffer read(std::uint64_t begin, std::size_t size) const;

 private:
  ScratchHandle handle_;
  std::uint64_t end_ = 0;
};

/// What a scratch file holds by now, for reading here and there: pages of it that the kernel may drop at any time. It
/// goes on when the file is gone.
class ScratchView {
 public:
  explicit ScratchView(const ScratchFile& file);
  ScratchView(ScratchView&& other) noexcept
      : bytes_(std::exchange(other.bytes_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  ScratchView& operator=(ScratchView&&) = delete;
  ~ScratchView();

  template <class T>
  [[nodiscard]] std::span<const T> as() const {
    return {reinterpret_cast<const T*>(bytes_), size_ / sizeof(T)};
  }

 private:
  const std::byte* bytes_ = nullptr;
  std::size_t size_ = 0;
};

/// Memory that lies in a file, which the kernel writes out when it needs the room. All zeros at first.
class ScratchMemory {
 public:
  ScratchMemory(const std::filesystem::path& folder, std::uint64_t size);
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;
  ~ScratchMemory();

  /// `count` values from byte `begin` on, which must be aligned for them.
  template <class T>
  [[nodiscard]] std::span<T> at(std::uint64_t begin, std::size_t count) const {
    return {reinterpret_cast<T*>(bytes_ + begin), count};
  }

 private:
  ScratchHandle handle_;
  std::uint64_t size_;
  std::byte* bytes_ = nullptr;
};

}  // namespace ramcdb::detail
