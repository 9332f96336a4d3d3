#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ramcdb/patch.h"
#include "ramcdb/repository.h"

namespace ramcdb {

/// One edit of one mesh: begin, check out patches, change them, commit or abort. It works on the version that was the
/// branch's tip when it began, and holds no lock until commit. Not thread-safe; any number may run side by side.
class EditTransaction {
 public:
  EditTransaction(EditTransaction&&) noexcept;
  EditTransaction& operator=(EditTransaction&&) noexcept;
  ~EditTransaction();  ///< aborts when neither commit() nor abort() was called

  [[nodiscard]] const Snapshot& base() const;

  /// Takes a region out. The patch lives as long as the transaction. Regions of several patches may not overlap:
  /// invalid_argument names the charts that are out already.
  Patch& checkout(const Region& region, unsigned threads = 1);

  /// What commit would do now.
  [[nodiscard]] ChangeReport status() const;

  /// Publishes what changed in all patches as one version; with nothing changed, writes nothing and says so. Vertices
  /// may move anywhere within the lattice's range. Throws invalid_argument when a patch's connectivity changed, when
  /// copies of a non-manifold vertex moved apart and for positions that are not finite. A report with conflicts means
  /// that others changed the same charts since: nothing was written, and the transaction goes on.
  CommitReport commit(const CommitOptions& options);

  void abort();

 private:
  friend class Repository;
  class Impl;
  explicit EditTransaction(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace ramcdb
