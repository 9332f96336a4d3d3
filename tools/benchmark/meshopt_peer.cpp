#include <meshoptimizer.h>

#include <stdexcept>

#include "tools/benchmark/peer.h"
#include "tools/benchmark/zstd_bytes.h"

namespace ramcdb::benchmark {
namespace {

class Meshopt : public Peer {
 public:
  explicit Meshopt(const chartify::IndexedMesh& mesh) : vertices_(mesh.positions.size()) {
    for (const Triangle& face : mesh.faces) indices_.insert(indices_.end(), face.begin(), face.end());
    std::vector<unsigned> remap(mesh.positions.size());
    meshopt_optimizeVertexCacheStrip(indices_.data(), indices_.data(), indices_.size(), mesh.positions.size());
    used_ = meshopt_optimizeVertexFetchRemap(remap.data(), indices_.data(), indices_.size(), mesh.positions.size());
    meshopt_remapIndexBuffer(indices_.data(), indices_.data(), indices_.size(), remap.data());
    meshopt_remapVertexBuffer(vertices_.data(), mesh.positions.data(), mesh.positions.size(), sizeof(LatticePoint),
                              remap.data());
    vertices_.resize(used_);
  }

  [[nodiscard]] std::string name() const override { return "meshoptimizer + zstd"; }

  [[nodiscard]] Buffer encode() const override {
    Buffer bytes(16 + meshopt_encodeIndexBufferBound(indices_.size(), used_) +
                 meshopt_encodeVertexBufferBound(used_, sizeof(LatticePoint)));
    const std::size_t index_size =
        meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices_.data(), indices_.size());
    const std::size_t vertex_size = meshopt_encodeVertexBuffer(bytes.data() + index_size, bytes.size() - index_size,
                                                               vertices_.data(), used_, sizeof(LatticePoint));
    bytes.resize(index_size + vertex_size);
    index_size_ = index_size;
    return packed(bytes);
  }

  [[nodiscard]] CameBack decode(Bytes bytes) const override {
    const Buffer whole = unpacked(bytes);
    std::vector<unsigned> indices(indices_.size());
    std::vector<LatticePoint> vertices(used_);
    if (meshopt_decodeIndexBuffer(indices.data(), indices.size(), sizeof(unsigned), whole.data(), index_size_) != 0 ||
        meshopt_decodeVertexBuffer(vertices.data(), used_, sizeof(LatticePoint), whole.data() + index_size_,
                                   whole.size() - index_size_) != 0)
      throw std::runtime_error("meshoptimizer cannot read what it wrote");
    return {indices.size() / 3, used_};
  }

 private:
  std::vector<unsigned> indices_;
  std::vector<LatticePoint> vertices_;
  std::size_t used_ = 0;
  mutable std::size_t index_size_ = 0;  ///< what a header would say
};

}  // namespace

std::unique_ptr<Peer> meshopt_peer(const chartify::IndexedMesh& mesh) { return std::make_unique<Meshopt>(mesh); }

}  // namespace ramcdb::benchmark
