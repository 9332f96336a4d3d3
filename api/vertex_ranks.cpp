#include "api/vertex_ranks.h"

#include "chartify/radix_sort.h"

namespace ramcdb::detail {

VertexRanks::VertexRanks(std::span<const std::uint32_t> named) : rank(named.size()) {
  struct Name {
    std::uint32_t vertex, place;
  };
  std::vector<Name> names;
  names.reserve(named.size());
  for (const std::uint32_t v : named) names.push_back({v, static_cast<std::uint32_t>(names.size())});
  chartify::radix_sort(names, &Name::vertex);
  for (const Name& name : names) {
    if (vertices.empty() || vertices.back() != name.vertex) vertices.push_back(name.vertex);
    rank[name.place] = static_cast<std::uint32_t>(vertices.size() - 1);
  }
}

}  // namespace ramcdb::detail
