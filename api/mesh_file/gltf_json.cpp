#include "api/mesh_file/gltf_json.h"

#include <fmt/format.h>

namespace ramcdb::mesh_file::gltf {
namespace {

/// Position behind the string that begins at `at`, which holds its quotation mark; the text's end when it has no end.
std::size_t behind_string(std::string_view json, std::size_t at) {
  while (true) {
    at = json.find_first_of("\"\\", at + 1);
    if (at == json.npos) return json.size();
    if (json[at] == '"') return at + 1;
    ++at;  // what a backslash stands before
  }
}

}  // namespace

void check_json_size(const FileBytes& file, std::string_view json, std::size_t offset) {
  std::size_t depth = 0, values = 0;
  for (std::size_t at = 0; at < json.size();) {
    switch (json[at]) {
      case '"':
        at = behind_string(json, at);
        continue;
      case '[':
      case '{':
        if (++depth > kDeepestJson)
          throw bad_byte(file, offset + at, fmt::format("JSON that nests deeper than {}", kDeepestJson));
        ++values;
        break;
      case ']':
      case '}':
        if (depth) --depth;  // a parser finds the one too many
        break;
      case ',':
        ++values;
        break;
      default:
        break;
    }
    if (values > kMostJsonValues)
      throw Error(Errc::limit_exceeded, fmt::format("JSON with more than {} values", kMostJsonValues), file.name(),
                  "keep numbers in binary buffers, or split the file");
    ++at;
  }
}

}  // namespace ramcdb::mesh_file::gltf
