#include "tools/benchmark/lossless_bench.h"

#include <algorithm>
#include <bit>

#include "api/mesh_file/mesh_file.h"
#include "ramcdb/repository.h"
#include "tools/benchmark/zstd_bytes.h"

namespace ramcdb::benchmark {
namespace {

/// XOR with the number before, byte k of all numbers after byte k - 1 of all numbers.
template <class Float, class Bits>
std::uint64_t packed_size(const std::vector<Point>& positions) {
  std::vector<Buffer> planes(sizeof(Bits));
  std::array<Bits, 3> before{};
  for (const Point& p : positions)
    for (int a = 0; a < 3; ++a) {
      const auto bits = std::bit_cast<Bits>(static_cast<Float>(p[a]));
      const Bits x = bits ^ before[static_cast<std::size_t>(a)];
      before[static_cast<std::size_t>(a)] = bits;
      for (std::size_t k = 0; k < planes.size(); ++k) planes[k].push_back(static_cast<std::uint8_t>(x >> (8 * k)));
    }
  Buffer all;
  for (const Buffer& plane : planes) all.insert(all.end(), plane.begin(), plane.end());
  return packed(all).size();
}

bool all_floats(const std::vector<Point>& positions) {
  return std::all_of(positions.begin(), positions.end(), [](const Point& p) {
    return static_cast<double>(static_cast<float>(p.x)) == p.x && static_cast<double>(static_cast<float>(p.y)) == p.y &&
           static_cast<double>(static_cast<float>(p.z)) == p.z;
  });
}

}  // namespace

LosslessFigures measure_lossless(const std::filesystem::path& file, const std::filesystem::path& scratch) {
  Repository::create(scratch / "r");
  auto repository = Repository::open(scratch / "r");
  ImportOptions options;
  options.lossless = true;
  const MeshInfo info = repository.import(file, options).info;
  (void)repository.export_mesh(repository.snapshot(), scratch / "out.ply", {});
  const std::vector<Point> positions = mesh_file::read_mesh(scratch / "out.ply").positions;

  LosslessFigures figures;
  figures.mesh = info.mesh;
  figures.vertices = info.vertices;
  figures.positions = info.bytes.geometry + info.bytes.wires;
  figures.everything = info.bytes.payload - info.bytes.attributes;
  figures.doubles = !all_floats(positions);
  figures.xor_zstd =
      figures.doubles ? packed_size<double, std::uint64_t>(positions) : packed_size<float, std::uint32_t>(positions);
  return figures;
}

}  // namespace ramcdb::benchmark
