#include "api/shared_vertices.h"

#include <algorithm>
#include <functional>

#include "api/external_sort.h"
#include "chartify/radix_sort.h"

namespace ramcdb::detail {

void sort_vertices(std::vector<std::uint32_t>& vertices) {
  if (!std::is_sorted(vertices.begin(), vertices.end())) chartify::radix_sort(vertices, std::identity{});
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}

void SharedVertexFinder::add_group(std::vector<std::uint32_t> vertices) {
  sort_vertices(vertices);
  vertices_.add(std::span<const std::uint32_t>(vertices));
  ends_.push_back(vertices_.size());
}

SharedVertices SharedVertexFinder::find() {
  constexpr std::size_t kMostHeld = 1 << 16;
  const std::size_t each = static_cast<std::size_t>(work_.memory) / (8 * sizeof(std::uint32_t) * (ends_.size() + 1));
  std::vector<RecordCursor<std::uint32_t>> cursors;
  for (std::size_t g = 0; g < ends_.size(); ++g)
    cursors.emplace_back(vertices_, g == 0 ? 0 : ends_[g - 1], ends_[g], std::min(each, kMostHeld));
  SharedVertices shared{{}, {0}, {}};
  std::vector<std::uint32_t> groups;
  std::uint32_t vertex = 0;
  const auto end_vertex = [&] {
    if (groups.size() > 1) {
      shared.vertices.push_back(vertex);
      shared.groups.insert(shared.groups.end(), groups.begin(), groups.end());
      shared.first.push_back(static_cast<std::uint32_t>(shared.groups.size()));
    }
    groups.clear();
  };
  merge_runs(cursors, [&, seen = std::uint64_t{0}](std::uint32_t next, std::size_t group) mutable {
    if (seen++ % kMostHeld == 0)
      work_.report(stage_, 0.9 + 0.1 * static_cast<double>(seen) / static_cast<double>(vertices_.size()));
    if (next != vertex) end_vertex();
    vertex = next;
    groups.push_back(static_cast<std::uint32_t>(group));
  });
  end_vertex();
  return shared;
}

}  // namespace ramcdb::detail
