#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "db/store.h"
#include "ramcdb/repository.h"

namespace ramcdb::test {

/// All blobs of a mesh's charts and wires, in id order.
inline std::vector<Buffer> blobs_of(const Repository& repository, const std::string& mesh) {
  const auto store = db::Store::open(repository.folder(), db::Access::read);
  const VersionId head = store->resolve("HEAD");
  const auto roots = store->roots(head);
  const auto root = std::find_if(roots.begin(), roots.end(), [&](const auto& r) { return r.name == mesh; });
  const MeshInfo info = repository.snapshot(mesh).info();
  const auto reader = store->reader();
  std::vector<Buffer> blobs;
  for (std::uint32_t id = 1; id <= info.charts; ++id)
    blobs.push_back(reader->get({db::Kind::chart, root->mesh, id, root->root_version, 0}));
  for (std::uint32_t id = 1; id <= info.wires; ++id)
    blobs.push_back(reader->find({db::Kind::wire, root->mesh, id, root->root_version, 0}).value_or(Buffer{}));
  return blobs;
}

/// How many blobs of a kind a version wrote for the charts (or wires) 1 .. `ids` of the repository's first mesh, all
/// layers included.
inline std::size_t count_blobs(const Repository& repository, VersionId version, db::Kind kind, std::uint64_t ids) {
  constexpr std::uint16_t kMostLayers = 9;
  const auto store = db::Store::open(repository.folder(), db::Access::read);
  const auto roots = store->roots(version);
  const auto reader = store->reader();
  std::size_t count = 0;
  for (std::uint32_t id = 1; id <= ids; ++id)
    for (std::uint16_t layer = 0; layer <= (kind == db::Kind::attribute ? kMostLayers : 0); ++layer)
      count += reader->find({kind, roots.front().mesh, id, version, layer}).has_value();
  return count;
}

}  // namespace ramcdb::test
