#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

namespace ramcdb::codec {

/// Room for things that are all written before they are read.
template <class T>
class RawArray {
  static_assert(std::is_trivially_default_constructible_v<T>);

 public:
  RawArray() = default;
  explicit RawArray(std::size_t size) : things_(std::make_unique_for_overwrite<T[]>(size)), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T* data() { return things_.get(); }
  [[nodiscard]] const T* data() const { return things_.get(); }
  [[nodiscard]] T* begin() { return data(); }
  [[nodiscard]] T* end() { return data() + size_; }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size_; }
  [[nodiscard]] T& operator[](std::size_t i) { return things_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return things_[i]; }

 private:
  std::unique_ptr<T[]> things_;
  std::size_t size_ = 0;
};

}  // namespace ramcdb::codec
