#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "chartify/chartify.h"
#include "chartify/fixed_wires.h"

/// The wire-net of a mesh that is in memory only part by part, each part whole charts. What parts share, edges (seams)
/// and vertices, is decided once for all of them: which vertices are corners, and which wires run along the seams. Then
/// every part's net is built with these as its fixed wires, and all nets fit together.
namespace ramcdb::chartify {

/// One part. Vertices have numbers in the whole mesh beside those in the part.
struct MeshPart {
  const IndexedMesh& mesh;
  const Charts& charts;
  std::span<const std::uint32_t> number;  ///< per vertex its number in the whole mesh
  std::span<const std::uint8_t> shared;   ///< per vertex whether other parts have it as well
};

/// An edge by the numbers of its vertices in the whole mesh, the smaller first.
using NumberedEdge = std::array<std::uint32_t, 2>;

/// The edges of a part between vertices that others have as well, ascending: those of them that others have, too, are
/// seams.
[[nodiscard]] std::vector<NumberedEdge> edges_between_shared(const MeshPart& part);

/// What a part does at the vertices that it shares. Numbers are those of the whole mesh.
struct SharedEnds {
  std::vector<std::array<std::uint32_t, 2>> cut_edges;  ///< a shared vertex, and the other end of a cut edge there
  std::vector<std::uint32_t> corners;                   ///< shared vertices that end wires whatever other parts do
};
/// \param seams those of the part, ascending
[[nodiscard]] SharedEnds find_shared_ends(const MeshPart& part, std::span<const NumberedEdge> seams);

struct Seam {
  NumberedEdge edge;
  std::vector<std::uint32_t> parts;  ///< that have it, ascending
};

struct SeamWire {
  std::vector<std::uint32_t> vertices;  ///< numbers in the whole mesh, from begin to end corner
  std::vector<std::uint32_t> parts;
};

struct SeamNet {
  std::vector<SeamWire> wires;
  std::vector<std::uint32_t> corners;  ///< shared vertices that are corners, ascending
};

/// \param seams ascending, each once
/// \param position of a vertex of the whole mesh
[[nodiscard]] SeamNet join_seams(const std::vector<Seam>& seams, SharedEnds ends,
                                 const std::function<LatticePoint(std::uint32_t)>& position);

/// The part's share of what was joined, as build_wire_net takes it.
struct PartSeams {
  std::vector<FixedWire> wires;
  std::vector<std::uint32_t> wire;     ///< per fixed wire its number in SeamNet::wires
  std::vector<std::uint32_t> corners;  ///< vertices of the part
};
/// \param wires the numbers of those that the part has, ascending
[[nodiscard]] PartSeams seams_of(const MeshPart& part, const SeamNet& net, std::span<const std::uint32_t> wires);

}  // namespace ramcdb::chartify
