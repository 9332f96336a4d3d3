#include "cli/output.h"

#include <cstdio>

#include "ramcdb/error.h"

namespace ramcdb::cli {

void say(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

void finish_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw Error(Errc::storage, "the output could not be written", "standard output",
                "make room or redirect it elsewhere; the command itself was carried out");
}

}  // namespace ramcdb::cli
