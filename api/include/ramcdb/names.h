#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ramcdb/ids.h"

/// What versions are called, and who is at work on which charts.
namespace ramcdb {

struct Branch {
  std::string name;
  VersionId tip;
  std::uint64_t ahead = 0;   ///< versions that its tip descends from and main's does not
  std::uint64_t behind = 0;  ///< the other way round
};

struct Tag {
  std::string name;
  VersionId version;
};

/// A name beside a version.
struct RefName {
  std::string name;
  bool is_tag = false;
};

/// How to lock charts: an advice to others, which ends by itself.
struct LockOptions {
  std::string owner;            ///< who commits under this name is not stopped by it
  std::string reason;           ///< for people to read
  std::string branch = "main";  ///< where the owner works, for people to read: a lock holds on all branches
  std::int64_t seconds = 24 * 3600;
  bool steal = false;  ///< take charts over that others have locked
};

struct LockInfo {
  std::uint32_t id = 0;
  std::string mesh;
  std::vector<ChartId> charts;  ///< ascending
  std::vector<ChartId> gone;    ///< of these, the ones that the tip of `branch` does not hold any more
  std::string owner, reason, branch;
  std::int64_t taken_us = 0, expires_us = 0;  ///< UTC, microseconds since 1970
};

struct LockReport {
  LockInfo lock;
  std::vector<LockInfo> stolen;  ///< what others held of these charts
};

}  // namespace ramcdb
