#pragma once

#include <cstddef>

namespace ramcdb::codec::testing {

/// How much memory the program took from `new` at most, above what it held when the watch began. One at a time.
class MemoryWatch {
 public:
  MemoryWatch();
  [[nodiscard]] std::size_t peak() const;

 private:
  std::size_t held_;
};

}  // namespace ramcdb::codec::testing
