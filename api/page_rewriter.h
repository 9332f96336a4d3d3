#pragma once

#include "api/edit_encoder.h"
#include "api/mesh_record.h"
#include "api/page_index.h"
#include "db/store.h"

namespace ramcdb::detail {

/// Charts of an edit that the tip no longer holds as the edit found them.
[[nodiscard]] std::vector<ChartId> find_conflicts(const PageIndex& tip, const EncodedEdit& edit);

/// Writes new leaf pages for all that an edit touches and new pages above them, up to the root. Pages that hold nothing
/// of it stay. REQUIRES: no conflicts. `record.page_bytes` follows. Returns the new root.
[[nodiscard]] db::MeshRoot rewrite_pages(const PageIndex& tip, const EncodedEdit& edit, db::Writer& writer,
                                         MeshRecord& record);

}  // namespace ramcdb::detail
