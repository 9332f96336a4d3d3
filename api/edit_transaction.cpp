#include "ramcdb/edit_transaction.h"

#include <fmt/format.h>

#include <set>

#include "api/commit.h"
#include "api/patch_edit.h"
#include "api/repository_impl.h"
#include "api/snapshot_impl.h"
#include "ramcdb/error.h"

namespace ramcdb {
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
    const detail::PendingEdit edit = collect();
    ChangeReport report = detail::describe_edit(edit);
    detail::compare_with_tip(report, edit.parts, branch_);
    return report;
  }

  CommitReport commit(const CommitOptions& options) {
    require_open();
    const detail::PendingEdit edit = collect();
    CommitReport report = detail::commit_edit(edit, options, detail::attempt_name(nonce_, options.branch, edit));
    if (report.conflicts.empty()) abort();
    return report;
  }

  void abort() {
    patches_.clear();
    open_ = false;
  }

 private:
  /// All patches as one edit.
  [[nodiscard]] detail::PendingEdit collect() const {
    detail::PendingEdit edit;
    edit.may_recut_outside = true;
    edit.parts = {{&base_.impl(), {charts_out_.begin(), charts_out_.end()}}};
    if (patches_.empty()) return edit;
    if (patches_.size() == 1) {
      edit.region = patches_.front()->region();
      edit.edited = detail::edited_in_patch(*patches_.front());
    } else {
      edit.region = detail::load_region(edit.parts, 1, nullptr, true);
      edit.edited = detail::edited_in_patches(patches_, edit.region);
    }
    edit.changes = detail::changes_of(base_.impl(), edit.region, edit.edited);
    return edit;
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
