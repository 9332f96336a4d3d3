#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

/// Five versions, one chart each, and copies of both files as they were after the second.
class Restore : public ::testing::Test {
 protected:
  Restore() {
    const auto store = temp_.open();
    for (std::uint32_t id = 1; id <= 5; ++id) {
      blobs_.push_back(make_blob(Kind::chart, id, 5000));
      EXPECT_EQ(publish(*store, {blobs_.back()}), VersionId(id));
      if (id == 2 || id == 4) save(std::to_string(id));
    }
  }

  void save(const std::string& suffix) {
    // Every publish moves SQLite's log into its file: no log is to be copied.
    fs::copy_file(temp_ / "data.mdb", temp_.folder() / ("data." + suffix));
    fs::copy_file(temp_ / "catalogue.sqlite", temp_.folder() / ("catalogue." + suffix));
  }

  void put_back(const std::string& half, const std::string& suffix) {
    for (const char* log : {"catalogue.sqlite-wal", "catalogue.sqlite-shm"}) fs::remove(temp_ / log);
    fs::copy_file(temp_.folder() / (half + "." + suffix), temp_ / (half == "data" ? "data.mdb" : "catalogue.sqlite"),
                  fs::copy_options::overwrite_existing);
  }

  TempStore temp_;
  std::vector<Blob> blobs_;
};

TEST_F(Restore, BothHalvesTogetherAreTheOldRepository) {
  put_back("data", "2");
  put_back("catalogue", "2");
  const auto store = temp_.open();
  EXPECT_EQ(store->resolve("HEAD"), VersionId(2));
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
  EXPECT_EQ(publish(*store, {make_blob(Kind::chart, 9, 100)}), VersionId(3));
}

TEST_F(Restore, BlobsOlderThanTheHistoryAreReadAndNotWritten) {
  put_back("data", "2");
  const auto store = temp_.open();
  EXPECT_EQ(store->resolve("HEAD"), VersionId(2)) << "the newest version that both halves hold";
  EXPECT_EQ(store->resolve("~"), VersionId(1));
  EXPECT_EQ(store->resolve("1"), VersionId(1));
  for (const char* lost : {"3", "v4", "5", "5~3"})
    expect_error(Errc::corrupt, "has lost its blobs", [&] { (void)store->resolve(lost); });
  expect_blobs(*store, {blobs_[0]}, VersionId(1));
  expect_blobs(*store, {blobs_[1]}, VersionId(2));
  for (int i = 0; i < 2; ++i)
    expect_error(Errc::corrupt, "versions 3 to 5 have none", [&] { (void)store->writer(10); });
  const auto found = problems(*store);
  ASSERT_EQ(found.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(found[i], "missing: version " + std::to_string(3 + i) + " has lost its blobs");
  EXPECT_EQ(store->all_versions().size(), 5U) << "the refused writer changed nothing";
}

TEST_F(Restore, AHistoryOlderThanTheBlobsIsReadAndNotWritten) {
  put_back("catalogue", "2");
  const auto store = temp_.open();
  EXPECT_EQ(store->resolve("HEAD"), VersionId(2));
  for (std::uint32_t id = 1; id <= 5; ++id) expect_blobs(*store, {blobs_[id - 1]}, VersionId(id));
  for (int i = 0; i < 2; ++i)
    expect_error(Errc::corrupt, "versions 3 to 5 are not in it", [&] { (void)store->writer(10); });
  for (std::uint32_t id = 3; id <= 5; ++id) expect_blobs(*store, {blobs_[id - 1]}, VersionId(id));
}

TEST_F(Restore, TheMissingHalfPutBackHealsBoth) {
  save("5");
  put_back("catalogue", "2");
  expect_error(Errc::corrupt, "are not in it", [&] { (void)temp_.open()->writer(10); });
  put_back("catalogue", "5");
  EXPECT_EQ(problems(*temp_.open()), std::vector<std::string>{});
  put_back("data", "4");
  expect_error(Errc::corrupt, "versions 5 to 5 have none", [&] { (void)temp_.open()->writer(10); });
  put_back("data", "5");
  const auto store = temp_.open();
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
  EXPECT_EQ(publish(*store, {make_blob(Kind::chart, 9, 100)}), VersionId(6));
}

/// One version that the history does not know looks like a crash before its row, and is taken back as one. Its number
/// stays taken.
TEST_F(Restore, AHistoryThatLacksOneVersionTakesItBack) {
  put_back("catalogue", "4");
  const auto store = temp_.open();
  EXPECT_EQ(store->resolve("HEAD"), VersionId(4));
  EXPECT_EQ(publish(*store, {make_blob(Kind::chart, 9, 100)}), VersionId(6));
  EXPECT_FALSE(store->reader()->find(at(blobs_[4].key, VersionId(5))).has_value());
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
}

TEST_F(Restore, AFreshBlobFileUnderAHistoryIsReadAndNotWritten) {
  const TempStore fresh;
  fs::copy_file(fresh / "data.mdb", temp_ / "data.mdb", fs::copy_options::overwrite_existing);
  const auto store = temp_.open();
  expect_error(Errc::corrupt, "versions 1 to 5 have none", [&] { (void)store->writer(10); });
  expect_error(Errc::not_found, "", [&] { (void)store->resolve("HEAD"); });
  EXPECT_EQ(problems(*store).size(), 5U);
}

}  // namespace
}  // namespace ramcdb::db::test
