#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "db/environment.h"

/// What the blob half knows of itself: one small blob, replaced by every transaction that writes.
///
///     state = "RAMCdb" | format u16 | repository id, 16 bytes | seq u32 | last mesh u32       little-endian
namespace ramcdb::db {

struct StoreState {
  std::string repository_id;    ///< 32 hexadecimal digits
  std::uint32_t seq = 0;        ///< the last version number that was given away, published or not
  std::uint32_t last_mesh = 0;  ///< the last mesh id that was given away
};

/// Before the first write transaction the file is empty, and the state as well: an empty id, zeros.
/// Throws corrupt, unsupported_version.
[[nodiscard]] StoreState read_state(const Transaction& transaction);
void write_state(const Transaction& transaction, const StoreState& state);

/// 128 random bits as 32 hexadecimal digits.
[[nodiscard]] std::string random_id();

}  // namespace ramcdb::db
