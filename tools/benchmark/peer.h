#pragma once

#include <memory>
#include <string>
#include <vector>

#include "chartify/chartify.h"
#include "ramcdb/bytes.h"

namespace ramcdb::benchmark {

/// What the store adds to a blob, which is counted with it.
inline constexpr std::uint64_t kBlobOverhead = 8;

/// How much of a mesh came back. Some coders drop degenerate faces or vertices without faces.
struct CameBack {
  std::size_t faces = 0, vertices = 0;
};

/// Another coder, given a whole mesh on the lattice: all contestants code the same numbers.
class Peer {
 public:
  virtual ~Peer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual Buffer encode() const = 0;
  /// Decodes to the end.
  [[nodiscard]] virtual CameBack decode(Bytes bytes) const = 0;
};

/// Google's Draco. `level` is its compression level: 10 packs best, 7 is its tools' default.
[[nodiscard]] std::unique_ptr<Peer> draco_peer(const chartify::IndexedMesh& mesh, int level);

/// meshoptimizer's codecs, vertices and faces in the order that suits them, the result through zstd -19.
[[nodiscard]] std::unique_ptr<Peer> meshopt_peer(const chartify::IndexedMesh& mesh);

/// OpenCTM's MG2 with a precision that keeps every lattice point.
[[nodiscard]] std::unique_ptr<Peer> openctm_peer(const chartify::IndexedMesh& mesh);

/// Coordinates and indices as they are, in as few bytes as hold them, through zstd -19.
[[nodiscard]] std::unique_ptr<Peer> raw_peer(const chartify::IndexedMesh& mesh);

}  // namespace ramcdb::benchmark
