#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ramcdb/attributes.h"
#include "ramcdb/geometry.h"
#include "ramcdb/ids.h"
#include "ramcdb/names.h"

/// What operations report: plain values, printed by the command line and checked by tests.
namespace ramcdb {

/// Bytes of all blobs of one mesh at one version, checksums included, keys not counted.
struct MeshBytes {
  std::uint64_t wire_net = 0;      ///< index pages
  std::uint64_t wires = 0;         ///< wire blobs
  std::uint64_t connectivity = 0;  ///< the charts' share that says how vertices connect
  std::uint64_t geometry = 0;      ///< the charts' share that says where inner vertices are
  std::uint64_t chart_headers = 0;
  std::uint64_t attributes = 0;
  std::uint64_t tables = 0;   ///< coder tables and the mesh record
  std::uint64_t payload = 0;  ///< the sum of the above
  std::uint64_t store = 0;    ///< what the LMDB and SQLite files of the whole repository occupy on disk

  friend bool operator==(const MeshBytes&, const MeshBytes&) = default;
};

struct MeshInfo {
  std::string mesh;
  VersionId revision;
  std::uint64_t vertices = 0, faces = 0, charts = 0, wires = 0, corners = 0;
  std::uint64_t polygons = 0;  ///< faces of the file with more than three corners; `faces` counts their triangles
  std::uint64_t components = 0, boundary_loops = 0, nonmanifold_edges = 0;
  std::uint64_t isolated_vertices = 0, degenerate_faces = 0, duplicate_faces = 0, nonmanifold_vertices = 0,
                inconsistent_edges = 0;
  Lattice lattice;
  bool lossless = false;
  double max_error = 0;  ///< the one loss, on entry: step / 2 per axis, model units
  std::string profile;
  std::uint32_t target_faces = 0;
  Point lo, hi;  ///< exact bounding box, model units
  struct Layer {
    AttributeInfo info;
    double max_error = 0;  ///< 0: kept without loss
  };
  std::vector<Layer> attributes;
  std::vector<std::string> references;  ///< to other files: "mtllib a.mtl", "texture skin.png"
  MeshBytes bytes;
  struct Spread {
    std::uint32_t min = 0, median = 0, p95 = 0, max = 0;
  } chart_faces;
};

struct MeshSummary {
  std::string name;
  MeshId id;
  std::uint64_t vertices = 0, faces = 0, charts = 0;
  std::uint64_t payload = 0;  ///< bytes
};

struct ChartSummary {
  ChartId id;
  std::uint32_t faces = 0, inner_vertices = 0, border_vertices = 0;
  Point lo, hi;                       ///< exact bounding box, model units
  std::uint64_t bytes = 0;            ///< of its geometry and connectivity
  std::uint64_t attribute_bytes = 0;  ///< of its attributes and polygons
  std::vector<ChartId> neighbours;    ///< charts that share a wire, ascending
  VersionId version;                  ///< that last changed it
};

struct VersionRecord {
  VersionId id;
  std::vector<VersionId> parents;
  std::string branch, author, message;
  std::int64_t time_us = 0;   ///< UTC, microseconds since 1970
  std::string operation;      ///< "import", "commit"
  std::vector<RefName> refs;  ///< branches and tags that name it now
  struct MeshChange {
    std::string mesh;
    std::vector<ChartId> charts;  ///< charts that the version wrote, ascending
  };
  std::vector<MeshChange> changes;
  std::uint64_t charts_touched = 0, vertices_moved = 0, vertices_added = 0, vertices_removed = 0;
  double max_displacement = 0;  ///< model units
  std::uint64_t bytes_written = 0;
};

/// What an import found and did. `info` is as `Snapshot::info` after it.
struct ImportReport {
  MeshInfo info;
  struct Dropped {
    std::string what;
    std::uint64_t count = 0;
  };
  std::vector<Dropped> dropped;        ///< named and counted: what the file holds and the repository does not
  std::uint64_t polygons = 0;          ///< faces with more than three corners
  std::uint64_t polygons_as_fans = 0;  ///< of them, those that took too long to cut well
  std::uint64_t vertices_welded = 0;   ///< corners of a triangle soup that were joined on equal positions
  double measured_error = 0;           ///< largest distance along an axis between file and lattice, model units
  double seconds = 0;
};

struct CheckoutReport {
  VersionId revision;
  std::uint64_t charts = 0, faces = 0, vertices = 0;
  std::uint64_t bytes_read = 0, blobs_read = 0, pages_read = 0;
  std::vector<ImportReport::Dropped> left_out;  ///< what the file's format cannot hold
  Point local_origin;                           ///< what the file's coordinates are relative to, model units
  std::optional<LockReport> lock;               ///< that was taken with it
  double seconds = 0;
};

/// How an edited file was understood.
struct FileNotes {
  std::string frame;                      ///< which change of axes or units was undone; empty for none
  std::uint64_t snapped_back = 0;         ///< vertices of the region's border that only rounding had moved
  std::uint64_t attributes_missing = 0;   ///< attributes that the file has nothing for: they stay
  std::vector<std::string> not_taken;     ///< attributes of the file that the mesh does not have
  std::uint64_t values_interpolated = 0;  ///< of new vertices, corners and faces, from the surface that was there
};

/// How much changed. Lengths, areas and volumes in model units.
struct ChangeFigures {
  std::uint64_t vertices_moved = 0, vertices_added = 0, vertices_removed = 0;
  std::uint64_t faces_added = 0, faces_removed = 0;   ///< triangles; a face is the same while its vertices are
  std::uint64_t values_changed = 0;                   ///< of attributes, of what stays
  double max_displacement = 0, rms_displacement = 0;  ///< rms over moved vertices
  double area_before = 0, area_after = 0;             ///< of the triangles that were looked at, changed or not
  /// How much larger the volume inside is; none where that is not defined, because an open border moved.
  std::optional<double> volume_change = 0;

  /// Nothing changed.
  [[nodiscard]] bool clean() const { return !came_or_went() && vertices_moved + values_changed == 0; }
  [[nodiscard]] bool came_or_went() const {
    return vertices_added + vertices_removed + faces_added + faces_removed > 0;
  }
};

/// What happened to a chart; of several things the last.
enum class ChangeClass {
  untouched,   ///< it was at most cut or coded anew: every vertex, face and value of it was there before
  attributes,  ///< values changed
  moved,       ///< vertices moved
  remeshed,    ///< vertices or faces came or went
};

struct ChartChange : ChangeFigures {
  ChartId chart;
  [[nodiscard]] ChangeClass change_class() const {
    if (came_or_went()) return ChangeClass::remeshed;
    if (vertices_moved) return ChangeClass::moved;
    return values_changed ? ChangeClass::attributes : ChangeClass::untouched;
  }
};

/// What an edited region would change, or did.
struct ChangeReport : ChangeFigures {
  FileNotes notes;
  VersionId base, tip;
  /// Charts of the region, ascending, that anything in them changes, border included, or that have to be cut anew
  /// beside a change.
  std::vector<ChartId> charts_touched;
  std::uint64_t border_vertices_moved = 0;  ///< of those that moved, on the region's own border
  /// Of the charts touched. Shared vertices count in each chart. New faces count in the chart that they are at.
  std::vector<ChartChange> per_chart;
  std::vector<ChartId> changed_by_others;  ///< charts of the region that newer versions changed
  std::vector<ChartId> conflicts;          ///< of these, the ones that this edit touches too
  std::vector<LockInfo> locks;             ///< on charts of the region, whoever holds them
};

/// A place that two edits changed in different ways.
struct MergeConflict {
  std::string mesh;
  ChartId chart;  ///< of the edit's own region
  Point place;    ///< where it was before either edit; model units
  std::string what;
};

struct CommitReport {
  std::string mesh;  ///< empty where it is of several
  FileNotes notes;
  bool merged = false;                         ///< it was merged with what others had done to the same charts
  std::vector<MergeConflict> conflict_places;  ///< of a merge that failed, at most 1,000
  VersionId revision;                          ///< the new version; the base when nothing changed
  VersionId parent;
  bool nothing_changed = false;
  std::uint64_t charts_touched = 0;  ///< with a moved vertex inside the region
  std::uint64_t charts_reencoded = 0, charts_added = 0, charts_removed = 0, wires_reencoded = 0, ranges_expanded = 0;
  std::vector<ChartId> added, removed;  ///< these charts, ascending
  std::uint64_t vertices_moved = 0, vertices_added = 0, vertices_removed = 0;
  std::uint64_t faces_added = 0, faces_removed = 0;  ///< triangles
  std::uint64_t values_changed = 0;                  ///< of attributes
  std::uint64_t layers_reencoded = 0;                ///< blobs of attributes
  double max_displacement = 0;                       ///< model units
  std::uint64_t bytes_written = 0;
  double seconds = 0;
  std::vector<ChartId> conflicts;  ///< not empty: refused, nothing was written
  /// Where a merge or a revert changes several meshes, or would: what it does to each. The counts above are their sums,
  /// and the lists of charts follow each other in this order. Empty for one mesh.
  std::vector<CommitReport> per_mesh;
  /// Of a built-in edit: attributes with normals, which it left as they were.
  std::vector<std::string> normals_left;
};

/// Two lines of history made one.
struct MergeReport {
  VersionId revision;  ///< the new version; the branch's tip when nothing changed
  VersionId parent, theirs, base;
  bool nothing_changed = false;    ///< the branch holds it already
  std::uint64_t charts_taken = 0;  ///< by their index pages, no blob copied
  CommitReport commit;             ///< where both sides changed meshes: what was merged, or the conflicts
  double seconds = 0;
};

/// What an import into a mesh found and did.
struct ImportIntoReport {
  CommitReport commit;                         ///< `notes.attributes_missing`: of the mesh, absent in what was added
  std::uint64_t vertices = 0, faces = 0;       ///< of the file; triangles
  std::vector<ImportReport::Dropped> dropped;  ///< named and counted: what the file holds and the mesh has no place for
  std::uint64_t polygons = 0, polygons_as_fans = 0, vertices_welded = 0;  ///< as ImportReport
  double measured_error = 0;  ///< largest distance along an axis between file and mesh, model units
};

/// A mesh coded anew.
struct RepackReport {
  VersionId revision;  ///< the new version; the tip when nothing changed
  VersionId parent;
  bool nothing_changed = false;  ///< it is in that profile already, and would not get smaller
  std::string profile;           ///< that it has now: "dense", "fast"
  std::uint64_t charts = 0;
  MeshBytes before, after;
  std::uint64_t bytes_written = 0;
  double seconds = 0;
};

struct VerifyReport {
  std::uint64_t objects = 0;  ///< blobs looked at
  std::uint64_t decoded_charts = 0;
  struct Problem {
    std::string kind, mesh, object;
    VersionId revision;
    std::string text;
  };
  std::vector<Problem> problems;
  [[nodiscard]] bool ok() const { return problems.empty(); }
};

/// How two versions of a mesh differ, whatever charts it was cut into. Areas are those of the charts that differ.
struct DiffReport : ChangeFigures {
  VersionId from, to;
  std::vector<ChartId> changed, added, removed;  ///< charts
  /// Of all these charts, ascending. What moved, was added or has another value counts in the chart that has it in the
  /// newer version, what is gone in the chart that had it.
  std::vector<ChartChange> per_chart;
  std::uint64_t bytes_read = 0, blobs_read = 0, pages_read = 0;
};

}  // namespace ramcdb
