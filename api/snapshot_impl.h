#pragma once

#include <memory>

#include "api/layers.h"
#include "api/mesh_record.h"
#include "api/page_index.h"
#include "codec/tables.h"
#include "db/store.h"
#include "ramcdb/snapshot.h"

namespace ramcdb {

/// One mesh at one version: its record, its page index, its coder tables, and the pin that keeps the version.
class Snapshot::Impl {
 public:
  /// Throws not_found when the version does not hold the mesh.
  Impl(std::shared_ptr<db::Store> store, VersionId version, const db::MeshRoot& root);

  [[nodiscard]] const std::shared_ptr<db::Store>& store_handle() const { return store_; }
  [[nodiscard]] db::Store& store() const { return *store_; }
  [[nodiscard]] VersionId version() const { return version_; }
  [[nodiscard]] const db::MeshRoot& root() const { return pages_.root(); }
  [[nodiscard]] const detail::MeshRecord& record() const { return record_; }
  [[nodiscard]] std::uint64_t record_bytes() const { return record_bytes_; }
  [[nodiscard]] MeshBytes bytes() const;
  [[nodiscard]] const detail::PageIndex& pages() const { return pages_; }
  [[nodiscard]] const detail::LayerTable& layers() const { return layers_; }
  /// The tables that a chart names. Throws unsupported_version for others than the mesh's own and the built-in ones.
  [[nodiscard]] const codec::CoderTables& tables(TableId table) const;
  /// Bytes of the blob of the mesh's own tables, checksum included; 0 without.
  [[nodiscard]] std::uint64_t table_bytes() const { return table_bytes_; }

 private:
  std::shared_ptr<db::Store> store_;
  VersionId version_;
  std::unique_ptr<db::Pin> pin_;
  std::uint64_t record_bytes_ = 0, table_bytes_ = 0;
  detail::MeshRecord record_;
  detail::LayerTable layers_;
  detail::PageIndex pages_;
  codec::CoderTables built_in_tables_, own_tables_;
};

}  // namespace ramcdb
