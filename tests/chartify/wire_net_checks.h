#pragma once

#include <span>
#include <vector>

#include "chartify/wire_net_builder.h"

/// What must hold for the wire-net of every mesh and every way to cut it, found without the code under test's helpers.
namespace ramcdb::chartify::test {

/// Fails the running test unless a chart is what ramcdb/chart.h says: manifold in its local vertices, one fan around
/// each, loops of three or more along exactly the edges that one face has.
void check_chart(const Chart& chart);

/// Fails the running test unless charts hold the mesh's faces and vertices, loops run along wires, and wires and
/// corners are what wire_net_builder.h says.
void check_wire_net(const IndexedMesh& mesh, const Charts& charts, const WireNet& net);

/// Likewise, of a net that edits left: wires in any order and direction, corners where none is needed any more.
void check_edited_net(const IndexedMesh& mesh, const Charts& charts, const WireNet& net);

/// Fails the running test unless the wires that lie on fixed ones cover these from end to end in their direction, cut
/// at corners only, and others lie on no edge of theirs.
void check_origins(const WireNet& net, std::span<const FixedWire> fixed);

/// The vertices of a wire as a loop passes it.
[[nodiscard]] std::vector<std::uint32_t> vertices_along(const WireNet& net, NetLoopStep step);

}  // namespace ramcdb::chartify::test
