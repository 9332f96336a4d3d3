#include <fmt/format.h>

#include "tests/db/child_process.h"
#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

constexpr std::size_t kSizes[] = {0, 1, 50, 2017, 2018, 2019, 4096, 100'000, 5'000'000};

/// Every kind that callers put, in every size, with and without layers.
std::vector<Blob> blobs_of_all_kinds() {
  std::vector<Blob> blobs;
  for (const Kind kind : {Kind::page, Kind::wire, Kind::chart, Kind::attribute, Kind::table, Kind::mesh_record}) {
    std::uint32_t id = 0;
    for (const std::size_t size : kSizes)
      if (size < 1'000'000 || kind == Kind::chart) blobs.push_back(make_blob(kind, ++id, size));
  }
  for (const std::uint16_t layer : std::initializer_list<std::uint16_t>{1, 2, 65535})
    blobs.push_back(make_blob(Kind::attribute, 3, 3000, MeshId(1), layer));
  return blobs;
}

TEST(RoundTrip, AllKindsAndSizesInAnyOrder) {
  const TempStore temp;
  auto blobs = blobs_of_all_kinds();
  std::reverse(blobs.begin(), blobs.end());
  const VersionId version = publish(*temp.open(), blobs);
  const auto store = temp.open(Access::read);
  expect_blobs(*store, blobs, version);
  EXPECT_TRUE(problems(*store).empty());
}

TEST(RoundTrip, EverySizeAroundThePartsAndThePage) {
  const TempStore temp;
  std::vector<Blob> blobs;
  for (std::uint32_t size = 1950; size <= 2100; ++size) blobs.push_back(make_blob(Kind::chart, size, size));
  for (std::uint32_t size = 4000; size <= 4160; ++size) blobs.push_back(make_blob(Kind::wire, size, size));
  const auto store = temp.open();
  expect_blobs(*store, blobs, publish(*store, blobs));
}

TEST(RoundTrip, LaterVersionsStandBesideEarlierOnes) {
  const TempStore temp;
  const auto store = temp.open();
  std::vector<VersionId> versions;
  std::vector<std::vector<Blob>> written;
  for (std::uint32_t v = 0; v < 12; ++v) {
    // The same names with other contents and sizes, so that old pages are split.
    auto blobs = std::vector{make_blob(Kind::chart, 1, 3000), make_blob(Kind::chart, 2, 500),
                             make_blob(Kind::wire, 7, 40), make_blob(Kind::page, 1, 2048)};
    for (Blob& blob : blobs) blob.bytes = random_bytes(1000 * v + blob.key.id, blob.bytes.size() + 17 * v);
    versions.push_back(publish(*store, blobs));
    written.push_back(blobs);
  }
  for (std::size_t v = 0; v < versions.size(); ++v) expect_blobs(*store, written[v], versions[v]);
  EXPECT_TRUE(problems(*store).empty());
}

TEST(RoundTrip, ManyMeshesAndIdsOfAllMagnitudes) {
  const TempStore temp;
  std::vector<Blob> blobs;
  for (const std::uint32_t mesh : {1U, 2U, 240U, 241U, 2287U, 2288U, 65535U})
    for (const std::uint32_t id : {1U, 240U, 241U, 67823U, 67824U, (1U << 24) - 1, 1U << 24, ~0U})
      blobs.push_back(make_blob(Kind::chart, id, 100, MeshId(mesh)));
  const auto store = temp.open();
  expect_blobs(*store, blobs, publish(*store, blobs));
}

TEST(RoundTrip, FlushedPartsAndThePublishedRestAreOneVersion) {
  const TempStore temp;
  const auto store = temp.open();
  std::vector<Blob> blobs;
  VersionId version;
  std::uint64_t sealed = 0;
  {
    const auto writer = store->writer(10);
    for (std::uint32_t id = 1; id <= 300; ++id) {
      blobs.push_back(make_blob(Kind::chart, id * 7 % 307, 700));
      writer->put(blobs.back().key, blobs.back().bytes);
      sealed += 708;
      if (id % 60 == 0) writer->flush();
    }
    EXPECT_EQ(writer->bytes_put(), sealed);
    version = writer->publish(commit_info(*writer));
  }
  expect_blobs(*store, blobs, version);
  EXPECT_TRUE(problems(*store).empty());
}

TEST(RoundTrip, MissingBlobsAreNamedByGetAndNothingForFind) {
  const TempStore temp;
  const auto store = temp.open();
  const VersionId version = publish(*store, {make_blob(Kind::chart, 5, 100), make_blob(Kind::chart, 7, 5000)});
  const auto reader = store->reader();
  for (const BlobKey key :
       {BlobKey{Kind::chart, MeshId(1), 6, version, 0}, BlobKey{Kind::wire, MeshId(1), 5, version, 0},
        BlobKey{Kind::chart, MeshId(2), 5, version, 0},
        BlobKey{Kind::chart, MeshId(1), 5, VersionId(version.value + 1), 0},
        BlobKey{Kind::attribute, MeshId(1), 5, version, 1}}) {
    EXPECT_FALSE(reader->find(key).has_value());
    const std::string name = fmt::format("{} of mesh {}, version {}", key.id, key.mesh.value, key.version.value);
    expect_error(Errc::corrupt, name, [&] { (void)reader->get(key); });
  }
  EXPECT_EQ(reader->blobs_read(), 0U);
  EXPECT_TRUE(reader->find({Kind::chart, MeshId(1), 5, version, 0}).has_value());
  EXPECT_EQ(reader->blobs_read(), 1U);
  EXPECT_EQ(reader->bytes_read(), 108U);
}

TEST(RoundTrip, AReaderStaysAtItsMomentUntilItIsRenewed) {
  const TempStore temp;
  const auto store = temp.open();
  publish(*store, {make_blob(Kind::chart, 1, 100)});
  const auto reader = store->reader();
  const auto later = make_blob(Kind::chart, 2, 100);
  const VersionId version = publish(*store, {later});
  EXPECT_FALSE(reader->find(at(later.key, version)).has_value());
  reader->renew();
  EXPECT_TRUE(reader->get(at(later.key, version)) == later.bytes);
}

TEST(RoundTrip, AKeyIsPutOnce) {
  const TempStore temp;
  const auto store = temp.open();
  const auto twice = make_blob(Kind::chart, 1, 100);
  expect_error(Errc::corrupt, "exists already", [&] { publish(*store, {twice, twice}); });
  EXPECT_TRUE(store->all_versions().empty());
  expect_blobs(*store, {twice}, publish(*store, {twice}));
  EXPECT_TRUE(problems(*store).empty());
}

/// Expects that opening the store to write fails; root opens it as somebody else, since root may write everything.
void expect_no_opening(const TempStore& temp, const std::string& part_of_text) {
  ChildProcess child([&] {
    if (::geteuid() == 0 && ::setuid(65534) != 0) FAIL() << "root stays root";
    expect_error(Errc::storage, part_of_text, [&] { (void)temp.open(Access::write); });
  });
  EXPECT_EQ(child.wait(), 0);
}

TEST(RoundTrip, FilesThatMayNotBeWrittenGiveAnError) {
  const TempStore temp;
  publish(*temp.open(), {make_blob(Kind::chart, 1, 100)});
  fs::permissions(temp.folder().parent_path(), fs::perms::group_exec | fs::perms::others_exec, fs::perm_options::add);
  for (const auto& entry : fs::directory_iterator(temp.folder())) fs::permissions(entry.path(), fs::perms::owner_read);
  expect_no_opening(temp, "must be writable");
}

TEST(RoundTrip, AFolderThatMayNotBeEnteredIsNotTakenForNoRepository) {
  const TempStore temp;
  fs::permissions(temp.folder(), fs::perms::none);
  expect_no_opening(temp, "Permission denied");
  fs::permissions(temp.folder(), fs::perms::owner_all);
}

TEST(MeshIds, AreGivenOnceAndEnd) {
  const TempStore temp;
  const auto store = temp.open();
  {
    const auto writer = store->writer(10);
    EXPECT_EQ(writer->new_mesh_id(), MeshId(1));
    EXPECT_EQ(writer->new_mesh_id(), MeshId(2));
    (void)writer->publish(commit_info(*writer));
  }
  const auto writer = store->writer(10);
  for (std::uint32_t id = 3; id <= 65535; ++id) EXPECT_EQ(writer->new_mesh_id(), MeshId(id));
  expect_error(Errc::limit_exceeded, "65,535", [&] { (void)writer->new_mesh_id(); });
}

}  // namespace
}  // namespace ramcdb::db::test
