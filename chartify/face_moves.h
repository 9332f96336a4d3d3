#pragma once

#include "chartify/face_mover.h"
#include "chartify/progress.h"

namespace ramcdb::chartify {

/// Shortens borders by moving single faces: along the border between any two charts, from every face a hill climb that
/// may go down for a while and is taken back to its best point (after Fiduccia and Mattheyses, 1982). \param threads
/// change the time, never the result
void move_faces(FaceMover& mover, unsigned threads = 1, const Progress& progress = {});

}  // namespace ramcdb::chartify
