#include <algorithm>
#include <bit>

#include "tools/benchmark/peer.h"
#include "tools/benchmark/zstd_bytes.h"

namespace ramcdb::benchmark {
namespace {

class Raw : public Peer {
 public:
  explicit Raw(const chartify::IndexedMesh& mesh)
      : mesh_(mesh), low_(mesh.positions.empty() ? LatticePoint{} : mesh.positions[0]) {
    std::uint32_t most = 0;
    for (int a = 0; a < 3; ++a)
      for (const LatticePoint p : mesh.positions) low_[a] = std::min(low_[a], p[a]);
    for (int a = 0; a < 3; ++a)
      for (const LatticePoint p : mesh.positions) most = std::max(most, static_cast<std::uint32_t>(p[a] - low_[a]));
    number_bytes_ = bytes_for(most);
    index_bytes_ = bytes_for(static_cast<std::uint32_t>(mesh.positions.size()));
  }

  [[nodiscard]] std::string name() const override { return "raw + zstd"; }

  [[nodiscard]] Buffer encode() const override {
    Buffer bytes;
    for (const LatticePoint p : mesh_.positions)
      for (int a = 0; a < 3; ++a) put(bytes, static_cast<std::uint32_t>(p[a] - low_[a]), number_bytes_);
    for (const Triangle& face : mesh_.faces)
      for (const std::uint32_t v : face) put(bytes, v, index_bytes_);
    return packed(bytes);
  }

  [[nodiscard]] CameBack decode(Bytes bytes) const override {
    const Buffer whole = unpacked(bytes);
    const std::size_t vertices = mesh_.positions.size();
    return {(whole.size() - 3 * number_bytes_ * vertices) / (3 * index_bytes_), vertices};
  }

 private:
  static std::size_t bytes_for(std::uint32_t most) { return (std::bit_width(most) + 7U) / 8; }
  static void put(Buffer& bytes, std::uint32_t x, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(x >> (8 * i)));
  }

  const chartify::IndexedMesh& mesh_;
  LatticePoint low_;
  std::size_t number_bytes_ = 1, index_bytes_ = 1;
};

}  // namespace

std::unique_ptr<Peer> raw_peer(const chartify::IndexedMesh& mesh) { return std::make_unique<Raw>(mesh); }

}  // namespace ramcdb::benchmark
