#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <stdexcept>

#include "tools/benchmark/peer.h"

namespace ramcdb::benchmark {
namespace {

class Draco : public Peer {
 public:
  Draco(const chartify::IndexedMesh& mesh, int level) : level_(level) {
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    mesh_.set_num_points(count);
    draco::GeometryAttribute position;
    position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false, 3 * sizeof(std::int32_t), 0);
    draco::PointAttribute* const values = mesh_.attribute(mesh_.AddAttribute(position, true, count));
    for (std::uint32_t v = 0; v < count; ++v) {
      const LatticePoint p = mesh.positions[v];
      const std::int32_t xyz[3] = {p.x, p.y, p.z};
      values->SetAttributeValue(draco::AttributeValueIndex(v), xyz);
    }
    for (const Triangle& face : mesh.faces)
      mesh_.AddFace({draco::PointIndex(face[0]), draco::PointIndex(face[1]), draco::PointIndex(face[2])});
  }

  [[nodiscard]] std::string name() const override { return "Draco cl" + std::to_string(level_); }

  [[nodiscard]] Buffer encode() const override {
    draco::Encoder encoder;
    encoder.SetSpeedOptions(10 - level_, 10 - level_);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(mesh_, &buffer);
    if (!status.ok()) throw std::runtime_error("Draco refuses the mesh: " + status.error_msg_string());
    return {buffer.data(), buffer.data() + buffer.size()};
  }

  [[nodiscard]] CameBack decode(Bytes bytes) const override {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) throw std::runtime_error("Draco cannot read what it wrote");
    const draco::Mesh& mesh = *result.value();  // non-manifold vertices come back as several points
    return {mesh.num_faces(), std::min<std::size_t>(mesh.num_points(), mesh_.num_points())};
  }

 private:
  draco::Mesh mesh_;
  int level_;
};

}  // namespace

std::unique_ptr<Peer> draco_peer(const chartify::IndexedMesh& mesh, int level) {
  return std::make_unique<Draco>(mesh, level);
}

}  // namespace ramcdb::benchmark
