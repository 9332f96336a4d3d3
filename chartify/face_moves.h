#pragma once

#include "chartify/face_mover.h"

namespace ramcdb::chartify {

/// Shortens borders by moving single faces: from every border face a hill climb that may go down for a while and is
/// taken back to its best point (after Fiduccia and Mattheyses, 1982).
void move_faces(FaceMover& mover);

}  // namespace ramcdb::chartify
