#pragma once

namespace ramcdb::cli {

/// From here on the first Ctrl-C only asks: interrupted() turns true and the work in hand stops at its next step. A
/// second one ends the process at once, which the repository survives as it survives any crash.
void catch_interrupts();

[[nodiscard]] bool interrupted() noexcept;

}  // namespace ramcdb::cli
