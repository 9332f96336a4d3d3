#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ramcdb/attributes.h"

namespace ramcdb::mesh_file {

/// A file that appears whole, when commit() is called, or not at all. Written through a buffer; throws disk_full and
/// storage.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& file);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void text(std::string_view words) {
    if (words.size() > buffer_.size() - used_) make_room(words.size());
    std::memcpy(buffer_.data() + used_, words.data(), words.size());
    used_ += words.size();
  }
  template <class T>
  void binary(T value) {
    if (sizeof(T) > buffer_.size() - used_) make_room(sizeof(T));
    std::memcpy(buffer_.data() + used_, &value, sizeof(T));
    used_ += sizeof(T);
  }
  /// The shortest text that reads back as the same number of this type.
  void number(double value, NumberType type);
  /// As `number` of a float, never as a whole number: 1.0.
  void fraction(double value, NumberType type);
  void whole(std::uint64_t value);

  void commit();

 private:
  static constexpr std::size_t kBlock = 1 << 20;

  void flush();
  void make_room(std::size_t bytes);
  [[noreturn]] void fail() const;

  std::string file_, temporary_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;  ///< of the buffer
  int descriptor_ = -1;
  std::uint64_t written_ = 0;
  bool committed_ = false;
};

}  // namespace ramcdb::mesh_file
