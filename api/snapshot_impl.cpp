#include "api/snapshot_impl.h"

#include <fmt/format.h>

#include "api/store_format.h"
#include "ramcdb/error.h"

namespace ramcdb {
namespace {

/// Waits for nothing: pinning a version that was pruned meanwhile fails by itself, in db.
Buffer read_record(db::Store& store, const db::MeshRoot& root) {
  return store.reader()->get({db::Kind::mesh_record, root.mesh, 1, root.record_version, 0});
}

}  // namespace

Snapshot::Impl::Impl(std::shared_ptr<db::Store> store, VersionId version, const db::MeshRoot& root)
    : store_(std::move(store)), version_(version), pin_(store_->pin(version, "snapshot")), pages_(store_, root) {
  const Buffer blob = read_record(*store_, root);
  record_bytes_ = blob.size() + detail::kBlobOverhead;
  record_ = detail::decode_record(blob, fmt::format("mesh {}, version {}", root.name, root.record_version.value));
  if (record_.layers)
    layers_ = detail::decode_layer_table(store_->reader()->get({db::Kind::attribute, root.mesh, 0, record_.layers, 0}),
                                         fmt::format("mesh {}, version {}", root.name, record_.layers.value));
  if (record_.table) {
    const Buffer tables =
        store_->reader()->get({db::Kind::table, root.mesh, record_.table.value, record_.table_version, 0});
    own_tables_ = codec::decode_tables(tables);
    table_bytes_ = tables.size() + detail::kBlobOverhead;
  }
}

const codec::CoderTables& Snapshot::Impl::tables(TableId table) const {
  if (table && table == record_.table) return own_tables_;
  if (table)
    throw Error(Errc::unsupported_version, fmt::format("coder table {} is unknown", table.value), root().name,
                "use a newer ramcdb");
  return built_in_tables_;
}

/// From 1/256 bit to whole bytes, so that the parts add up to the payload: what rounding leaves goes to the headers.
MeshBytes Snapshot::Impl::bytes() const {
  const auto whole = [](std::uint64_t cost) { return (cost + 1024) / 2048; };
  MeshBytes bytes;
  bytes.wire_net = record_.page_bytes;
  bytes.wires = record_.wire_bytes;
  bytes.connectivity = whole(record_.chart_cost.connectivity);
  bytes.geometry = whole(record_.chart_cost.geometry) + record_.exact_bytes;
  const std::uint64_t charts =
      whole(record_.chart_cost.header + record_.chart_cost.connectivity + record_.chart_cost.geometry) +
      record_.charts * detail::kBlobOverhead + record_.exact_bytes;
  bytes.chart_headers = charts - bytes.connectivity - bytes.geometry;
  bytes.attributes = record_.layer_bytes;
  bytes.tables = record_.table_bytes + record_bytes_;
  bytes.payload = bytes.wire_net + bytes.wires + charts + bytes.attributes + bytes.tables;
  const auto usage = store_->usage();
  bytes.store = usage.blob_file + usage.catalogue;
  return bytes;
}

}  // namespace ramcdb
