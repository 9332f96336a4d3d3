#include "api/tip_publisher.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/locks.h"
#include "api/page_rewriter.h"
#include "api/progress.h"
#include "api/version_figures.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

std::string figures_of(const CommitReport& report, std::string_view operation,
                       const std::vector<db::ChangedCharts>& changed) {
  VersionFigures figures;
  figures.operation = operation;
  for (const db::ChangedCharts& of_mesh : changed) figures.charts_touched += of_mesh.charts.size();
  figures.vertices_moved = report.vertices_moved;
  figures.vertices_added = report.vertices_added;
  figures.vertices_removed = report.vertices_removed;
  figures.max_displacement = report.max_displacement;
  figures.bytes_written = report.bytes_written;
  return encode_figures(figures);
}

/// Puts all that a version writes of a mesh, and says where that then stands.
db::MeshRoot put_edit(const Snapshot::Impl& tip, EncodedEdit& edit, db::Writer& writer) {
  MeshRecord& record = edit.record;
  if (record.table && !record.table_version) record.table_version = writer.version();
  if (edit.new_layer_table) record.layers = writer.version();
  for (EncodedEdit::Blob& blob : edit.blobs) writer.put(blob.key, std::move(blob.bytes));
  const db::MeshRoot root = rewrite_pages(tip.pages(), edit.pages, writer, record);
  writer.put({db::Kind::mesh_record, root.mesh, 1, {}, 0}, encode_record(record));
  return root;
}

class TipPublisher {
 public:
  TipPublisher(const std::shared_ptr<db::Store>& store, VersionId base, const CommitOptions& options,
               std::string_view operation, const std::string& attempt, const MakeDraft& make, CommitReport& report)
      : store_(store),
        base_(base),
        options_(options),
        branch_(options.onto.empty() ? options.branch : options.onto),
        operation_(operation),
        attempt_(attempt),
        make_(make),
        report_(report) {}

  void run() {
    constexpr int kTriesWithoutLock = 2;
    for (int tries = 0;; ++tries) {
      const auto lock = tries < kTriesWithoutLock ? nullptr : store_->writer();
      const VersionId tip = lock ? lock->tip(branch_) : store_->tip(branch_);
      const VersionId parent = tip || options_.onto.empty() ? tip : base_;
      begin_stage(options_.progress, "encode");
      std::optional<VersionDraft> draft = make_(parent);
      if (!draft) return;
      begin_stage(options_.progress, "store");
      if (publish(tip, parent, *draft, lock ? *lock : *store_->writer())) return;
    }
  }

 private:
  /// False when the tip moved.
  /// \param expected the branch's tip; 0 for a branch that begins with this version
  bool publish(VersionId expected, VersionId parent, VersionDraft& draft, db::Writer& writer) const {
    if (writer.tip(branch_) != expected) return false;
    db::CommitInfo info;
    info.changed = draft.taken;
    for (const VersionDraft::MeshEdit& mesh : draft.edits)
      info.changed.push_back({mesh.at->root().mesh, mesh.edit.changed});
    for (const db::ChangedCharts& changed : info.changed)
      if (!options_.ignore_locks) refuse_locked(*store_, changed.mesh, changed.charts, options_.author);
    info.roots = std::move(draft.roots);
    for (VersionDraft::MeshEdit& mesh : draft.edits)
      *std::ranges::find(info.roots, mesh.at->root().mesh, &db::MeshRoot::mesh) = put_edit(*mesh.at, mesh.edit, writer);
    info.branch = branch_;
    info.expected_tip = expected;
    info.parents = {parent};
    if (draft.second_parent) info.parents.push_back(draft.second_parent);
    info.author = options_.author;
    info.message = options_.message;
    info.attempt = attempt_;
    report_.parent = parent;
    report_.bytes_written = writer.bytes_put();
    info.figures = figures_of(report_, operation_, info.changed);
    report_.revision = writer.publish(info);
    return true;
  }

  const std::shared_ptr<db::Store>& store_;
  VersionId base_;
  const CommitOptions& options_;
  const std::string& branch_;
  std::string_view operation_;
  const std::string& attempt_;
  const MakeDraft& make_;
  CommitReport& report_;
};

}  // namespace

std::shared_ptr<const Snapshot::Impl> mesh_on_branch(const Snapshot::Impl& base, VersionId version,
                                                     const std::string& branch) {
  const auto roots = base.store().roots(version);
  const auto root = std::ranges::find(roots, base.root().mesh, &db::MeshRoot::mesh);
  if (root != roots.end()) return std::make_shared<Snapshot::Impl>(base.store_handle(), version, *root);
  throw Error(Errc::conflict, fmt::format("mesh {} is not on branch {}", base.root().name, branch),
              version ? fmt::format("version {}", version.value) : "there is no such branch",
              "commit to the branch that you checked out from, or with --onto to a new one");
}

void publish_on_tip(const std::shared_ptr<db::Store>& store, VersionId base, const CommitOptions& options,
                    std::string_view operation, const std::string& attempt, const MakeDraft& make,
                    CommitReport& report) {
  TipPublisher(store, base, options, operation, attempt, make, report).run();
}

VersionId publish_nameless(const Snapshot::Impl& at, EncodedEdit edit, const CommitOptions& options) {
  const auto writer = at.store().writer();
  db::CommitInfo info;
  info.nameless = true;
  info.parents = {at.version()};
  info.author = options.author;
  info.message = options.message;
  info.attempt = db::new_attempt_id();
  info.changed = {{at.root().mesh, edit.changed}};
  info.roots = at.store().roots(at.version());
  *std::ranges::find(info.roots, at.root().mesh, &db::MeshRoot::mesh) = put_edit(at, edit, *writer);
  CommitReport report;
  report.bytes_written = writer->bytes_put();
  info.figures = figures_of(report, "commit", info.changed);
  return writer->publish(info);
}

}  // namespace ramcdb::detail
