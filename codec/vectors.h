#pragma once

#include <cstdint>

/// Four numbers that are computed with at once: an extension that g++ and clang share. What it does is the same with
/// any instruction set. RAMCDB_FAST_CLONES: a function that is also built for newer processors, and chosen when run.
namespace ramcdb::codec {

using Int4 = std::int32_t __attribute__((vector_size(16)));
using Unsigned4 = std::uint32_t __attribute__((vector_size(16)));
using Float4 = float __attribute__((vector_size(16)));

}  // namespace ramcdb::codec

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define RAMCDB_FAST_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define RAMCDB_FAST_CLONES
#endif
#define RAMCDB_INLINE __attribute__((always_inline)) inline
