#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "api/large_work.h"
#include "api/mesh_spool.h"
#include "api/scratch_records.h"
#include "api/shared_vertices.h"

namespace ramcdb::detail {

/// A face by where it lies along a Hilbert curve through the mesh; or a vertex without a face, as its first corner,
/// the others being kNoVertex.
struct SortedFace {
  static constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};

  std::uint64_t key = 0;
  std::uint32_t face = 0;  ///< its number in MeshSpool::faces()
  Triangle corners{};

  [[nodiscard]] bool is_isolated_vertex() const { return corners[1] == kNoVertex; }
  friend auto operator<=>(const SortedFace&, const SortedFace&) = default;
};

/// A mesh in blocks of faces that lie together.
struct FaceBlocks {
  explicit FaceBlocks(const std::filesystem::path& folder) : faces(folder) {}

  ScratchRecords<SortedFace> faces;
  std::vector<std::uint64_t> ends;  ///< of each block
  SharedVertices shared;            ///< by blocks

  [[nodiscard]] std::size_t count() const { return ends.size(); }
  [[nodiscard]] std::uint64_t begin(std::size_t block) const { return block == 0 ? 0 : ends[block - 1]; }
  [[nodiscard]] std::uint64_t size(std::size_t block) const { return ends[block] - begin(block); }
};

/// Sorts the faces of a mesh and cuts them into blocks of about `block_faces`.
/// \param range the box of the mesh on the lattice
[[nodiscard]] FaceBlocks sort_into_blocks(const MeshSpool& mesh, const Lattice& lattice, const LatticeBox& range,
                                          std::uint64_t block_faces, const LargeWork& work);

}  // namespace ramcdb::detail
