#include "api/mesh_record.h"

#include <gtest/gtest.h>

#include <limits>

#include "ramcdb/error.h"

/// The record of a mesh as bytes: all of it comes back, and nothing else is taken for one.
namespace ramcdb::detail {
namespace {

MeshRecord plain_record() {
  MeshRecord record;
  record.lattice = {{0.5, -0.25, 0}, 0.001, 0};
  record.range = {{0, 0, 0}, {4095, 3000, 2000}};
  record.vertices = 43'243;
  record.faces = 86'482;
  return record;
}

/// Every field as large as it can be.
MeshRecord extreme_record() {
  constexpr std::uint32_t kLargest = std::numeric_limits<std::uint32_t>::max();
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  constexpr std::int32_t kFar = kMaxLatticeCoordinate;
  MeshRecord record;
  record.lattice = {{1.0 / 3, -1e300, 5e-324}, 1e-300, 1e300};
  record.target_faces = kLargest;
  record.profile = codec::Profile::fast;
  record.range = {{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
  record.exact = NumberType::float64;
  record.written_as = NumberType::float64;
  record.table = TableId(kLargest);
  record.table_version = record.layers = VersionId(kLargest);
  record.next_chart = ChartId(kLargest);
  record.next_wire = WireId(kLargest);
  record.next_corner = CornerId(kLargest);
  record.next_page = PageId(kLargest);
  record.next_table = TableId(kLargest);
  for (std::uint64_t* counter : {&record.vertices,
                                 &record.faces,
                                 &record.charts,
                                 &record.wires,
                                 &record.corners,
                                 &record.nonmanifold_edges,
                                 &record.nonmanifold_vertices,
                                 &record.isolated_vertices,
                                 &record.degenerate_faces,
                                 &record.duplicate_faces,
                                 &record.inconsistent_edges,
                                 &record.chart_cost.header,
                                 &record.chart_cost.connectivity,
                                 &record.chart_cost.geometry,
                                 &record.page_bytes,
                                 &record.wire_bytes,
                                 &record.table_bytes,
                                 &record.layer_bytes,
                                 &record.exact_bytes,
                                 &record.polygons})
    *counter = kMost;
  return record;
}

Errc refusal_of(const Buffer& blob) {
  try {
    (void)decode_record(blob, "here");
  } catch (const Error& e) {
    return e.code();
  }
  return Errc::cancelled;  // stands for "took it"
}

TEST(MeshRecord, ComesBack) {
  for (const MeshRecord& record : {MeshRecord(), plain_record(), extreme_record()}) {
    const Buffer blob = encode_record(record);
    const MeshRecord again = decode_record(blob, "here");
    EXPECT_EQ(again, record);
    EXPECT_EQ(encode_record(again), blob);
  }
}

TEST(MeshRecord, IsSmall) { EXPECT_LT(encode_record(plain_record()).size(), 75U); }

TEST(MeshRecord, EveryOtherLengthIsRefused) {
  for (const MeshRecord& record : {plain_record(), extreme_record()}) {
    Buffer blob = encode_record(record);
    blob.push_back(0);
    EXPECT_EQ(refusal_of(blob), Errc::corrupt);
    blob.pop_back();
    while (!blob.empty()) {
      blob.pop_back();
      EXPECT_EQ(refusal_of(blob), Errc::corrupt) << blob.size();
    }
  }
}

TEST(MeshRecord, BadNumbersAreRefused) {
  const auto with = [](auto&& change) {
    MeshRecord record = plain_record();
    change(record);
    return refusal_of(encode_record(record));
  };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(with([](MeshRecord& r) { r.lattice.step = 0; }), Errc::corrupt);
  EXPECT_EQ(with([](MeshRecord& r) { r.lattice.step = kInfinite; }), Errc::corrupt);
  EXPECT_EQ(with([](MeshRecord& r) { r.lattice.steps_per_unit = -1; }), Errc::corrupt);
  EXPECT_EQ(with([](MeshRecord& r) { r.lattice.origin.y = kInfinite; }), Errc::corrupt);
  EXPECT_EQ(with([](MeshRecord& r) { r.range.hi.z = kMaxLatticeCoordinate + 1; }), Errc::corrupt);
  EXPECT_EQ(with([](MeshRecord& r) { r.written_as = NumberType::int16; }), Errc::corrupt);
  EXPECT_EQ(with([](MeshRecord& r) { r.exact = NumberType::uint8; }), Errc::corrupt);
  EXPECT_EQ(with([](MeshRecord& r) { r.profile = codec::Profile{9}; }), Errc::unsupported_version);
}

TEST(MeshRecord, OtherFormatsAndFlagsAreRefused) {
  Buffer blob = encode_record(plain_record());
  const auto with_byte = [&](std::size_t at, std::uint8_t byte) {
    Buffer other = blob;
    other[at] = byte;
    return refusal_of(other);
  };
  EXPECT_EQ(with_byte(0, 0), Errc::corrupt);
  EXPECT_EQ(with_byte(0, 2), Errc::unsupported_version);
  EXPECT_EQ(with_byte(1, 16), Errc::corrupt);
}

}  // namespace
}  // namespace ramcdb::detail
