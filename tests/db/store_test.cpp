#include <fstream>

#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

void write_file(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(StoreCreate, MakesANewFolderAndItsParents) {
  const TempFolder temp;
  Store::create(temp / "a/b/r.ramcdb");
  const auto store = Store::open(temp / "a/b/r.ramcdb", Access::write);
  EXPECT_EQ(store->id().size(), 32U);
  EXPECT_EQ(store->resolve(""), VersionId());
  EXPECT_TRUE(store->all_versions().empty());
  EXPECT_TRUE(problems(*store).empty());
}

TEST(StoreCreate, TakesAnEmptyFolder) {
  const TempFolder temp;
  fs::create_directory(temp / "r");
  Store::create(temp / "r");
  EXPECT_NE(Store::open(temp / "r", Access::read), nullptr);
}

TEST(StoreCreate, RefusesAFolderWithFilesAndLeavesThem) {
  const TempFolder temp;
  fs::create_directory(temp / "r");
  write_file(temp / "r/letter.txt", "dear");
  expect_error(Errc::invalid_argument, "not empty", [&] { Store::create(temp / "r"); });
  EXPECT_EQ(names_in(temp / "r"), std::vector<std::string>{"letter.txt"});
}

TEST(StoreCreate, RefusesARepositoryAndLeavesIt) {
  const TempStore temp;
  const auto blobs = std::vector{make_blob(Kind::chart, 1, 100)};
  const VersionId version = publish(*temp.open(), blobs);
  expect_error(Errc::invalid_argument, "there is a repository already", [&] { Store::create(temp.folder()); });
  expect_blobs(*temp.open(), blobs, version);
}

TEST(StoreCreate, RefusesAFileInThePlaceOfTheFolder) {
  const TempFolder temp;
  write_file(temp / "r", "a file");
  expect_error(Errc::storage, "cannot be made", [&] { Store::create(temp / "r"); });
}

TEST(StoreCreate, SweepsWhatAnUnfinishedCreateLeft) {
  const TempFolder temp;
  fs::create_directories(temp / "r/pins");
  write_file(temp / "r/data.mdb", "half");
  write_file(temp / "r/data.mdb-lock", "half");
  write_file(temp / "r/catalogue.sqlite.new", "half");
  write_file(temp / "r/catalogue.sqlite.new-wal", "half");
  Store::create(temp / "r");
  const auto store = Store::open(temp / "r", Access::write);
  const auto blobs = std::vector{make_blob(Kind::chart, 1, 100)};
  expect_blobs(*store, blobs, publish(*store, blobs));
  for (const std::string& name : names_in(temp / "r")) EXPECT_EQ(name.find(".new"), std::string::npos) << name;
}

TEST(StoreCreate, LeavesTheBlobsOfARepositoryThatLostItsCatalogue) {
  const TempStore temp;
  const auto blobs = std::vector{make_blob(Kind::chart, 1, 100)};
  const VersionId version = publish(*temp.open(), blobs);
  fs::rename(temp / "catalogue.sqlite", temp.folder().parent_path() / "away");
  expect_error(Errc::invalid_argument, "not empty", [&] { Store::create(temp.folder()); });
  fs::rename(temp.folder().parent_path() / "away", temp / "catalogue.sqlite");
  expect_blobs(*temp.open(), blobs, version);
}

TEST(StoreOpen, SaysWhatIsNoRepository) {
  const TempFolder temp;
  expect_error(Errc::not_found, "ramcdb init", [&] { (void)Store::open(temp / "none", Access::read); });
  fs::create_directory(temp / "empty");
  expect_error(Errc::not_found, "not a repository", [&] { (void)Store::open(temp / "empty", Access::read); });
}

TEST(StoreOpen, SaysWhichHalfIsMissing) {
  const TempStore temp;
  publish(*temp.open(), {make_blob(Kind::chart, 1, 100)});
  fs::rename(temp / "data.mdb", temp / "away");
  expect_error(Errc::corrupt, "data.mdb", [&] { (void)temp.open(); });
  EXPECT_FALSE(fs::exists(temp / "data.mdb"));
  fs::rename(temp / "away", temp / "data.mdb");
  fs::remove(temp / "catalogue.sqlite");
  expect_error(Errc::not_found, "catalogue.sqlite is missing", [&] { (void)temp.open(); });
}

TEST(StoreOpen, RefusesTheHalvesOfTwoRepositories) {
  const TempStore one, two;
  publish(*one.open(), {make_blob(Kind::chart, 1, 100)});
  publish(*two.open(), {make_blob(Kind::chart, 1, 100)});
  fs::copy_file(one / "data.mdb", two / "data.mdb", fs::copy_options::overwrite_existing);
  expect_error(Errc::corrupt, "different repositories", [&] { (void)two.open(); });
}

TEST(StoreOpen, RefusesABlobFileOfAnyShorterLength) {
  const TempStore temp;
  publish(*temp.open(), {make_blob(Kind::chart, 1, 40'000)});
  const std::uint64_t whole = fs::file_size(temp / "data.mdb");
  fs::copy_file(temp / "data.mdb", temp / "copy");
  for (const std::uint64_t length : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{100}, std::uint64_t{4096},
                                     std::uint64_t{8191}, std::uint64_t{8192}, whole / 2, whole - 4096, whole - 1}) {
    fs::copy_file(temp / "copy", temp / "data.mdb", fs::copy_options::overwrite_existing);
    fs::resize_file(temp / "data.mdb", length);
    expect_error(Errc::corrupt, "cut short", [&] { (void)temp.open(); });
    EXPECT_EQ(fs::file_size(temp / "data.mdb"), length) << "a damaged file is evidence and stays as it is";
  }
}

TEST(StoreOpen, RefusesACatalogueOfAnyShorterLength) {
  const TempStore temp;
  publish(*temp.open(), {make_blob(Kind::chart, 1, 100)});
  const std::uint64_t whole = fs::file_size(temp / "catalogue.sqlite");
  fs::copy_file(temp / "catalogue.sqlite", temp / "copy");
  for (const std::uint64_t length :
       {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{99}, std::uint64_t{100}, std::uint64_t{512}, whole / 2}) {
    for (const char* suffix : {"-wal", "-shm"}) fs::remove(temp.folder() / ("catalogue.sqlite" + std::string(suffix)));
    fs::copy_file(temp / "copy", temp / "catalogue.sqlite", fs::copy_options::overwrite_existing);
    fs::resize_file(temp / "catalogue.sqlite", length);
    const auto error = error_of([&] {
      const auto store = temp.open();
      (void)store->resolve("");
      (void)store->roots(VersionId(1));
    });
    EXPECT_TRUE(error && error->code() == Errc::corrupt) << length << ": " << (error ? error->what() : "");
  }
}

TEST(StoreOpen, RefusesFilesThatAreSomethingElse) {
  const TempStore temp;
  const Buffer noise = random_bytes(1, 16384);
  write_file(temp / "catalogue.sqlite", std::string(noise.begin(), noise.end()));
  expect_error(Errc::corrupt, "catalogue.sqlite", [&] { (void)temp.open(); });

  const TempStore other;
  write_file(other / "data.mdb", std::string(noise.begin(), noise.end()));
  expect_error(Errc::corrupt, "data.mdb", [&] { (void)other.open(); });
}

}  // namespace
}  // namespace ramcdb::db::test
