#pragma once

#include <string_view>

#include "ramcdb/bytes.h"
#include "ramcdb/wire_net.h"

namespace ramcdb::codec {

/// Codes an index page. REQUIRES: the orders that wire_net.h gives (ids ascending, ...), every id that is named stands
/// in the page, and loops close: each wire begins at the corner where the one before it ended.
/// Throws invalid_argument otherwise.
[[nodiscard]] Buffer encode_page(const Page& page);

/// Throws corrupt for bytes that no encoder wrote. What it returns keeps the rules that encode_page requires.
[[nodiscard]] Page decode_page(Bytes blob);

/// The rules of a leaf page, also for `verify`: throws corrupt (with `where`) naming the first that is broken.
void validate_page(const Page& page, std::string_view where);

}  // namespace ramcdb::codec
