#pragma once

#include "chartify/partition.h"

namespace ramcdb::chartify {

/// Lets charts grow into the faces of no chart around them, ring after ring, small charts faster than large ones.
/// Faces that no chart reaches stay as they are.
void grow_into_new_faces(const Neighbours& neighbours, std::uint32_t target, Partition& partition);

}  // namespace ramcdb::chartify
