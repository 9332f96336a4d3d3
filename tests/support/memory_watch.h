#pragma once

#include <cstddef>

namespace ramcdb::test {

/// How much memory the program took from `new` at most, above what it held when the watch began, and all it took, given
/// back or not. One at a time.
class MemoryWatch {
 public:
  MemoryWatch();
  [[nodiscard]] std::size_t peak() const;
  [[nodiscard]] std::size_t taken() const;

 private:
  std::size_t held_, taken_;
};

}  // namespace ramcdb::test
