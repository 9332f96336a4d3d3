#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ramcdb/ids.h"

namespace ramcdb::db {

/// An advisory lock: somebody says that they are at work on these charts. It binds who asks for it, and ends by itself.
struct ChartLock {
  std::uint32_t id = 0;         ///< given by the store, never used twice
  MeshId mesh;                  ///< on all branches
  std::vector<ChartId> charts;  ///< ascending
  std::string owner, reason;
  std::string branch;           ///< where its owner works, for people to read
  std::int64_t taken_us = 0;    ///< UTC, microseconds since 1970
  std::int64_t expires_us = 0;  ///< from then on it counts no more

  friend bool operator==(const ChartLock&, const ChartLock&) = default;
};

/// Which locks to give back: one, those on some charts of a mesh, or all.
struct LockSelection {
  std::uint32_t id = 0;  ///< not 0: this one
  MeshId mesh;           ///< not 0: these charts of it
  std::vector<ChartId> charts;
};

}  // namespace ramcdb::db
