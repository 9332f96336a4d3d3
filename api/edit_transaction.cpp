#include "ramcdb/edit_transaction.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "api/commit.h"
#include "api/repository_impl.h"
#include "api/snapshot_impl.h"
#include "ramcdb/error.h"

namespace ramcdb {
namespace {

using detail::VertexMove;

std::string place(const Patch::Mesh::Point& p) { return fmt::format("near {:.9g},{:.9g},{:.9g}", p[0], p[1], p[2]); }

[[noreturn]] void refuse_connectivity(const std::string& where) {
  throw Error(Errc::invalid_argument, "the patch's connectivity changed", where,
              "only vertices may move here: undo what added, removed or joined faces or vertices");
}

/// The patch still has the faces that it was given, in their order; OpenMesh may turn a face to another first corner.
void check_connectivity(const Patch& patch) {
  const auto& mesh = patch.mesh();
  const auto& region = patch.region();
  if (mesh.n_faces() != region.faces.size() || mesh.n_vertices() != region.points.size() + patch.copies())
    refuse_connectivity(fmt::format("{} faces, {} were checked out", mesh.n_faces(), region.faces.size()));
  for (const auto face : mesh.all_faces()) {
    Triangle found{};
    std::size_t i = 0;
    const bool gone = mesh.has_face_status() && mesh.status(face).deleted();
    for (auto v = mesh.cfv_iter(face); !gone && v.is_valid() && i < 3; ++v)
      found[i++] = mesh.property(patch.region_property(), *v);
    const Triangle& expected = region.faces[static_cast<std::size_t>(face.idx())];
    for (int turn = 0; turn < 3 && found != expected; ++turn)
      std::rotate(found.begin(), found.begin() + 1, found.end());
    if (gone || i != 3 || found != expected) {
      const LatticePoint p = region.points[expected[0]];
      const Point q = patch.base().position(p);
      refuse_connectivity(place({q.x, q.y, q.z}));
    }
  }
}

/// What a patch moved. Copies of one vertex must agree.
std::vector<VertexMove> moves_of(const Patch& patch) {
  check_connectivity(patch);
  const auto& region = patch.region();
  std::vector<std::optional<VertexMove>> found(region.points.size());
  std::vector<bool> known(region.points.size(), false);
  for (const auto v : patch.mesh().all_vertices()) {
    const auto p = patch.mesh().point(v);
    const std::uint32_t vertex = patch.mesh().property(patch.region_property(), v);
    auto move = detail::move_to(patch.base().impl(), region, vertex, {p[0], p[1], p[2]});
    if (known[vertex] && move != found[vertex])
      throw Error(Errc::invalid_argument, "two copies of one non-manifold vertex moved apart", place(p),
                  "move vertices with equal keys together");
    found[vertex] = std::move(move);
    known[vertex] = true;
  }
  std::vector<VertexMove> moves;
  for (const auto& move : found)
    if (move) moves.push_back(*move);
  return moves;
}

}  // namespace

class EditTransaction::Impl {
 public:
  Impl(Snapshot base, std::string_view branch)
      : base_(std::move(base)), branch_(branch), nonce_(db::new_attempt_id()) {}

  [[nodiscard]] const Snapshot& base() const { return base_; }

  Patch& checkout(const Region& region, unsigned threads) {
    require_open();
    const std::vector<ChartId> charts = base_.find(region);
    std::string taken;
    for (const ChartId id : charts)
      if (charts_out_.contains(id)) taken += fmt::format("{}{}", taken.empty() ? "" : ",", id.value);
    if (!taken.empty())
      throw Error(Errc::invalid_argument, "the region overlaps a patch of this edit", "charts " + taken,
                  "edit them in the patch that is out already");
    patches_.push_back(std::make_unique<Patch>(base_, base_.read_with_attributes(charts, threads)));
    charts_out_.insert(charts.begin(), charts.end());
    return *patches_.back();
  }

  [[nodiscard]] ChangeReport status() const {
    require_open();
    const Collected all = collect();
    ChangeReport report = detail::describe_edit(all.region, all.edit);
    const detail::RegionPart part{&base_.impl(), all.region.charts};
    detail::compare_with_tip(report, std::span(&part, 1), branch_);
    return report;
  }

  CommitReport commit(const CommitOptions& options) {
    require_open();
    const Collected all = collect();
    const detail::RegionPart part{&base_.impl(), all.region.charts};
    const ChangeReport change = detail::describe_edit(all.region, all.edit);
    const std::string attempt = detail::attempt_name(nonce_, options.branch, all.edit);
    CommitReport report = detail::commit_edit(std::span(&part, 1), change, all.edit, options, attempt);
    if (report.conflicts.empty()) abort();
    return report;
  }

  void abort() {
    patches_.clear();
    open_ = false;
  }

 private:
  /// All patches as one region, with the edits of all.
  struct Collected {
    RegionMesh region;
    detail::Edit edit;
  };

  [[nodiscard]] Collected collect() const {
    std::map<std::uint64_t, VertexMove> moves;
    std::map<std::uint16_t, detail::LayerEdit> layers;
    for (const auto& patch : patches_) {
      for (const VertexMove& move : moves_of(*patch)) {
        const auto [it, is_new] = moves.emplace(move.key.packed(), move);
        if (!is_new && it->second != move) refuse_split(move);
      }
      for (auto& edit : detail::changed_values(patch->region(), base_.impl().layers(), patch->attributes())) {
        detail::LayerEdit& all = layers[edit.layer.id];
        all.layer = edit.layer;
        all.at_vertices.merge(edit.at_vertices);
        all.in_charts.merge(edit.in_charts);
        for (const auto& [key, value] : edit.at_vertices)  // those that another patch has, too
          if (all.at_vertices.at(key) != value)
            throw Error(Errc::invalid_argument, "two patches gave their shared vertex different values",
                        edit.layer.info.name, "check both regions out as one patch");
      }
    }
    Collected all;
    if (!charts_out_.empty()) {
      const std::vector<ChartId> charts(charts_out_.begin(), charts_out_.end());
      all.region = base_.read(charts);
    }
    for (const auto& [key, move] : moves) all.edit.moves.push_back(move);
    for (auto& [id, layer] : layers) all.edit.layers.push_back(std::move(layer));
    return all;
  }

  [[noreturn]] void refuse_split(const VertexMove& move) const {
    const Point& p = move.position;
    throw Error(Errc::invalid_argument, "two patches moved their shared vertex to different places",
                place({p.x, p.y, p.z}), "check both regions out as one patch");
  }

  void require_open() const {
    if (!open_)
      throw Error(Errc::invalid_argument, "the edit is over", {}, "begin another with Repository::begin_edit");
  }

  Snapshot base_;
  std::string branch_;
  std::string nonce_;
  std::vector<std::unique_ptr<Patch>> patches_;
  std::set<ChartId> charts_out_;
  bool open_ = true;
};

EditTransaction::EditTransaction(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
EditTransaction::EditTransaction(EditTransaction&&) noexcept = default;
EditTransaction& EditTransaction::operator=(EditTransaction&&) noexcept = default;
EditTransaction::~EditTransaction() = default;

const Snapshot& EditTransaction::base() const { return impl_->base(); }
Patch& EditTransaction::checkout(const Region& region, unsigned threads) { return impl_->checkout(region, threads); }
ChangeReport EditTransaction::status() const { return impl_->status(); }
CommitReport EditTransaction::commit(const CommitOptions& options) { return impl_->commit(options); }
void EditTransaction::abort() { impl_->abort(); }

EditTransaction Repository::begin_edit(std::string_view mesh, std::string_view branch) {
  return EditTransaction(std::make_unique<EditTransaction::Impl>(snapshot(mesh, branch), branch));
}

}  // namespace ramcdb
