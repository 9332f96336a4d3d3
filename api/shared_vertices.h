#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "api/large_work.h"
#include "api/scratch_records.h"

namespace ramcdb::detail {

/// Which vertices of a mesh lie in several groups of faces, and in which.
struct SharedVertices {
  std::vector<std::uint32_t> vertices;  ///< ascending
  std::vector<std::uint32_t> first;     ///< per vertex, and one more: where its groups begin
  std::vector<std::uint32_t> groups;    ///< ascending within a vertex

  [[nodiscard]] std::span<const std::uint32_t> groups_of(std::size_t shared) const {
    return std::span(groups).subspan(first[shared], first[shared + 1] - first[shared]);
  }
};

/// Finds them by merging the groups' vertices, which wait in a temporary file.
class SharedVertexFinder {
 public:
  /// \param stage of the work, for its progress
  SharedVertexFinder(const LargeWork& work, const char* stage) : work_(work), stage_(stage), vertices_(work.folder) {}

  /// The next group, 0, 1, ...; its vertices in any order, any number of times.
  void add_group(std::vector<std::uint32_t> vertices);
  [[nodiscard]] SharedVertices find();

 private:
  const LargeWork& work_;
  const char* stage_;
  ScratchRecords<std::uint32_t> vertices_;
  std::vector<std::uint64_t> ends_;
};

/// Calls visit(position in `vertices`, position in `shared.vertices`) for those that are in both, ascending.
template <class Visit>
void for_each_shared(std::span<const std::uint32_t> vertices, const SharedVertices& shared, Visit&& visit) {
  std::size_t s = 0;
  if (!vertices.empty())
    s = static_cast<std::size_t>(std::lower_bound(shared.vertices.begin(), shared.vertices.end(), vertices.front()) -
                                 shared.vertices.begin());
  for (std::size_t v = 0; v < vertices.size() && s < shared.vertices.size();) {
    if (vertices[v] < shared.vertices[s])
      ++v;
    else if (shared.vertices[s] < vertices[v])
      ++s;
    else
      visit(v++, s++);
  }
}

/// Ascending, each once.
void sort_vertices(std::vector<std::uint32_t>& vertices);

}  // namespace ramcdb::detail
