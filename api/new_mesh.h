#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "api/layers.h"
#include "api/mesh_encoder.h"
#include "api/mesh_record.h"
#include "api/topology.h"
#include "db/store.h"
#include "ramcdb/repository.h"

/// How a mesh that was imported becomes a version.
namespace ramcdb::detail {

/// The name that an import gives its mesh. Throws invalid_argument for one that is none.
[[nodiscard]] std::string mesh_name(const std::filesystem::path& file, const ImportOptions& options);
/// Throws invalid_argument when the branch holds a mesh of that name.
void refuse_taken_name(db::Store& store, const ImportOptions& options, const std::filesystem::path& file);

/// The record of a mesh before anything of it is counted.
[[nodiscard]] MeshRecord new_record(const Lattice& lattice, NumberType type, const ImportOptions& options);
/// What snapping to the lattice moved a coordinate at most, as the mesh is kept: 0 where every bit is. Such a mesh is
/// written as the numbers of `type` that it came as.
[[nodiscard]] double note_error(MeshRecord& record, double error, NumberType type);
void note_topology(MeshRecord& record, const Topology& topology);
/// Counts charts, wires and corners, and gives the ids after theirs.
void note_entries(MeshRecord& record, const NetEntries& entries);
/// Adds what blobs of charts, wires and layers take.
void note_blobs(MeshRecord& record, const EncodedMesh& encoded);

struct NewMeshSource {
  const std::string& name;
  const std::filesystem::path& file;
  const ImportOptions& options;
};
struct NewMeshParts {
  const NetEntries& entries;
  const Buffer& tables;
  const LayerTable& layers;
};
/// Puts the pages, tables and record of a mesh under the attempt's version, and what `put_blobs` puts: charts, wires
/// and layers; then publishes it. Throws as refuse_taken_name, and as the writer does.
void publish_mesh(db::Store& store, const NewMeshSource& source, const NewMeshParts& parts, MeshRecord& record,
                  const std::function<void(db::Writer& writer, MeshId mesh)>& put_blobs);

}  // namespace ramcdb::detail
