#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/target.h"

namespace ramcdb::fuzz {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz target: %s\n", what);
  std::abort();
}

}  // namespace ramcdb::fuzz
