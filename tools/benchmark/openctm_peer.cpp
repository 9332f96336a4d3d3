#include <openctm.h>

#include <stdexcept>

#include "tools/benchmark/peer.h"

namespace ramcdb::benchmark {
namespace {

CTMuint append(const void* bytes, CTMuint size, void* to) {
  const auto* first = static_cast<const std::uint8_t*>(bytes);
  auto& out = *static_cast<Buffer*>(to);
  out.insert(out.end(), first, first + size);
  return size;
}

CTMuint take(void* to, CTMuint size, void* from) {
  auto& left = *static_cast<Bytes*>(from);
  const std::size_t n = std::min<std::size_t>(size, left.size());
  std::copy_n(left.begin(), n, static_cast<std::uint8_t*>(to));
  left = left.subspan(n);
  return static_cast<CTMuint>(n);
}

class OpenCtm : public Peer {
 public:
  explicit OpenCtm(const chartify::IndexedMesh& mesh) {
    for (const LatticePoint p : mesh.positions)
      for (int a = 0; a < 3; ++a) vertices_.push_back(static_cast<float>(p[a]));
    for (const Triangle& face : mesh.faces) indices_.insert(indices_.end(), face.begin(), face.end());
  }

  [[nodiscard]] std::string name() const override { return "OpenCTM MG2"; }

  [[nodiscard]] Buffer encode() const override {
    Buffer bytes;
    const CTMcontext context = ctmNewContext(CTM_EXPORT);
    ctmCompressionMethod(context, CTM_METHOD_MG2);
    ctmCompressionLevel(context, 9);
    ctmVertexPrecision(context, 1);
    ctmDefineMesh(context, vertices_.data(), static_cast<CTMuint>(vertices_.size() / 3), indices_.data(),
                  static_cast<CTMuint>(indices_.size() / 3), nullptr);
    ctmSaveCustom(context, append, &bytes);
    const CTMenum error = ctmGetError(context);
    ctmFreeContext(context);
    if (error != CTM_NONE) throw std::runtime_error("OpenCTM refuses the mesh");
    return bytes;
  }

  [[nodiscard]] CameBack decode(Bytes bytes) const override {
    const CTMcontext context = ctmNewContext(CTM_IMPORT);
    ctmLoadCustom(context, take, &bytes);
    const CTMuint faces = ctmGetInteger(context, CTM_TRIANGLE_COUNT);
    const CTMuint vertices = ctmGetInteger(context, CTM_VERTEX_COUNT);
    const CTMenum error = ctmGetError(context);
    ctmFreeContext(context);
    if (error != CTM_NONE) throw std::runtime_error("OpenCTM cannot read what it wrote");
    return {faces, vertices};
  }

 private:
  std::vector<float> vertices_;
  std::vector<CTMuint> indices_;
};

}  // namespace

std::unique_ptr<Peer> openctm_peer(const chartify::IndexedMesh& mesh) { return std::make_unique<OpenCtm>(mesh); }

}  // namespace ramcdb::benchmark
