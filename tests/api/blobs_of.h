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

}  // namespace ramcdb::test
