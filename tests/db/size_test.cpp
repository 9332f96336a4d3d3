#include <iostream>

#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

/// Sizes that scatter around their mean like those of real charts: half of it to one and a half.
std::size_t around(std::uint32_t id, std::size_t mean) { return mean / 2 + (id * 2654435761U >> 8) % (mean + 1); }

std::vector<Blob> mesh(std::uint32_t charts, std::uint32_t wires, std::uint32_t pages) {
  std::vector<Blob> blobs;
  for (std::uint32_t id = 1; id <= pages; ++id) blobs.push_back(make_blob(Kind::page, id, 2048));
  for (std::uint32_t id = 1; id <= wires; ++id) blobs.push_back(make_blob(Kind::wire, id, around(id, 45)));
  for (std::uint32_t id = 1; id <= charts; ++id) blobs.push_back(make_blob(Kind::chart, id, around(id, 6900)));
  return blobs;
}

std::uint64_t on_disk(Store& store) {
  const auto usage = store.usage();
  EXPECT_GT(usage.blob_file, 0U);
  EXPECT_GT(usage.catalogue, 0U);
  return usage.blob_file + usage.catalogue;
}

std::uint64_t sealed_bytes(const std::vector<Blob>& blobs) {
  std::uint64_t bytes = 0;
  for (const Blob& blob : blobs) bytes += blob.bytes.size() + 8;
  return bytes;
}

double ratio_of_a_fresh_repository(const std::vector<Blob>& blobs) {
  const TempStore temp;
  const auto store = temp.open();
  expect_blobs(*store, blobs, publish(*store, blobs));
  const double ratio = static_cast<double>(on_disk(*store)) / static_cast<double>(sealed_bytes(blobs));
  std::cout << "  " << blobs.size() << " blobs, " << sealed_bytes(blobs) << " bytes with checksums: store / blobs "
            << ratio << " (LMDB " << store->usage().blob_file << ", SQLite " << store->usage().catalogue << ")\n";
  return ratio;
}

TEST(Size, ASmallMeshTakesAtMostEightPercentMoreThanItsBlobs) {
  EXPECT_LE(ratio_of_a_fresh_repository(mesh(80, 240, 3)), 1.08);
}

TEST(Size, ALargeMeshTakesAtMostFivePercentMoreThanItsBlobs) {
  EXPECT_LE(ratio_of_a_fresh_repository(mesh(2000, 0, 0)), 1.05);
  EXPECT_LE(ratio_of_a_fresh_repository(mesh(2000, 6000, 60)), 1.05);
}

/// What edits add: a few charts, their wires and the pages above them, in each of many versions.
TEST(Size, AnEditCostsItsBlobsAndSomePages) {
  const TempStore temp;
  const auto store = temp.open();
  publish(*store, mesh(400, 1200, 12));
  const std::uint64_t before = on_disk(*store);
  constexpr std::uint32_t kEdits = 60;
  std::uint64_t bytes = 0;
  for (std::uint32_t edit = 1; edit <= kEdits; ++edit) {
    std::vector<Blob> blobs;
    for (std::uint32_t i = 0; i < 4; ++i)
      blobs.push_back(make_blob(Kind::chart, 1 + (edit * 97 + i) % 400, around(edit + i, 6900)));
    for (std::uint32_t i = 0; i < 4; ++i) blobs.push_back(make_blob(Kind::wire, 1 + (edit * 291 + i) % 1200, 45));
    blobs.push_back(make_blob(Kind::page, 1, 2048));
    blobs.push_back(make_blob(Kind::page, 2 + edit % 11, 2048));
    bytes += sealed_bytes(blobs);
    publish(*store, blobs);
  }
  const double ratio = static_cast<double>(on_disk(*store) - before) / static_cast<double>(bytes);
  std::cout << "  " << kEdits << " edits of " << bytes / kEdits << " bytes: growth / blobs " << ratio << '\n';
  EXPECT_LE(ratio, 1.8);
}

/// Attempts that are taken back leave room that later ones use: the file does not grow with them.
TEST(Size, TakenBackAttemptsGiveTheirRoomToLaterOnes) {
  const TempStore temp;
  const auto store = temp.open();
  publish(*store, mesh(20, 60, 2));
  const auto abandon = [&] {
    const auto writer = store->writer(10);
    for (const Blob& blob : mesh(100, 300, 3)) writer->put(blob.key, blob.bytes);
    writer->flush();
  };
  for (int i = 0; i < 3; ++i) abandon();
  const std::uint64_t settled = on_disk(*store);
  for (int i = 0; i < 10; ++i) abandon();
  EXPECT_LE(on_disk(*store), settled + settled / 20);
  EXPECT_TRUE(problems(*store).empty());
}

}  // namespace
}  // namespace ramcdb::db::test
