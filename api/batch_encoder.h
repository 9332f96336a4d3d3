#pragma once

#include <vector>

#include "api/chart_seams.h"
#include "api/chart_spool.h"
#include "api/large_work.h"
#include "api/layers.h"
#include "api/mesh_encoder.h"
#include "api/mesh_record.h"
#include "api/scratch_file.h"
#include "db/store.h"

namespace ramcdb::detail {

/// Charts, wires and corners of a mesh in batches.
struct BatchedCharts {
  const ChartSpool& spool;
  const std::vector<ChartSpool::Batch>& batches;
  std::size_t at_a_time;  ///< how many batches are held
  const ChartSeams& seams;
  const MeshSpool& mesh;
  const LayerTable& layers;
};

/// Blobs that wait in a temporary file to be put.
class BlobSpool {
 public:
  explicit BlobSpool(const std::filesystem::path& folder) : file_(folder) {}

  void add(db::Kind kind, std::uint32_t id, std::uint16_t layer, Bytes blob) {
    entries_.push_back({kind, id, layer, file_.append(blob), blob.size()});
  }
  void put_all(db::Writer& writer, MeshId mesh, const LargeWork& work) const;

 private:
  struct Entry {
    db::Kind kind;
    std::uint32_t id;
    std::uint16_t layer;
    std::uint64_t begin;
    std::size_t size;
  };
  ScratchFile file_;
  std::vector<Entry> entries_;
};

/// Coder tables that suit the mesh, from a sample of its charts.
[[nodiscard]] codec::CoderTables train_tables(const BatchedCharts& charts, const MeshRecord& record);

/// Codes all charts and wires, batch by batch. \param record gets what they take
[[nodiscard]] NetEntries encode_batches(const BatchedCharts& charts, const codec::CoderTables& tables,
                                        MeshRecord& record, BlobSpool& blobs, const LargeWork& work);

}  // namespace ramcdb::detail
