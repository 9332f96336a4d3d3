#pragma once

#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "api/mesh_file/mesh_file.h"

namespace ramcdb::mesh_file {

/// A file that appears whole, when commit() is called, or not at all.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& file);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void text(std::string_view words) {
    buffer_.append(words);
    if (buffer_.size() >= kBlock) flush();
  }
  template <class T>
  void binary(T value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    text({bytes.data(), bytes.size()});
  }
  /// The shortest text that reads back as the same number of this type.
  void number(double value, Scalar scalar) {
    std::array<char, 40> digits;
    const auto end = scalar == Scalar::float32
                         ? std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(value)).ptr
                         : std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text({digits.data(), static_cast<std::size_t>(end - digits.data())});
  }
  void whole(std::int64_t value) {
    std::array<char, 24> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text({digits.data(), static_cast<std::size_t>(end - digits.data())});
  }

  void commit();

 private:
  static constexpr std::size_t kBlock = 1 << 20;

  void flush();
  [[noreturn]] void fail() const;

  std::string file_, temporary_, buffer_;
  int descriptor_ = -1;
  std::uint64_t written_ = 0;
  bool committed_ = false;
};

}  // namespace ramcdb::mesh_file
