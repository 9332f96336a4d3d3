#pragma once

#include "api/mesh_record.h"
#include "api/page_delta.h"
#include "api/page_index.h"
#include "db/store.h"

namespace ramcdb::detail {

/// Writes new leaf pages for all that `delta` touches and new pages above them, up to the root. Pages that hold nothing
/// of it stay. Pages that got too large are split, small ones joined with a neighbour. `record.page_bytes` and
/// `record.next_page` follow. Returns the new root. REQUIRES: the mesh keeps a chart.
[[nodiscard]] db::MeshRoot rewrite_pages(const PageIndex& tip, const PageDelta& delta, db::Writer& writer,
                                         MeshRecord& record);

}  // namespace ramcdb::detail
