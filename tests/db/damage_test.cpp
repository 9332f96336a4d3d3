#include <fstream>
#include <functional>
#include <iterator>
#include <set>

#include "db/sqlite.h"
#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

Buffer read_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return Buffer(std::istreambuf_iterator<char>(in), {});
}

void write_byte(const fs::path& file, std::size_t place, std::uint8_t byte) {
  std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
  out.seekp(static_cast<std::streamoff>(place));
  out.put(static_cast<char>(byte));
}

/// Three versions with blobs of all sizes, and where their bytes lie in data.mdb.
class Damage : public ::testing::Test {
 protected:
  Damage() {
    const auto store = temp_.open();
    for (std::uint32_t v = 1; v <= 3; ++v) {
      std::vector<Blob> blobs;
      for (std::uint32_t i = 1; i <= 12; ++i) {
        blobs.push_back(make_blob(Kind::wire, 100 * v + i, 30 + i));
        blobs.push_back(make_blob(Kind::chart, i * 3 + v, 300 + 700 * i));
        blobs.push_back(make_blob(Kind::attribute, i * 3 + v, 150 * i, MeshId(1), 1));
      }
      const VersionId version = publish(*store, blobs);
      for (Blob& blob : blobs) blob.key.version = version;
      blobs_.insert(blobs_.end(), blobs.begin(), blobs.end());
    }
    file_ = read_file(temp_ / "data.mdb");
  }

  /// Where these bytes of the blob lie, if they lie together (parts and page ends cut them): in their page, and in
  /// free ones that LMDB copied it from.
  [[nodiscard]] std::vector<std::size_t> find(const Blob& blob, std::size_t from, std::size_t size) const {
    const auto begin = blob.bytes.begin() + static_cast<std::ptrdiff_t>(from);
    const std::boyer_moore_searcher searcher(begin, begin + static_cast<std::ptrdiff_t>(size));
    std::vector<std::size_t> places;
    for (auto found = file_.begin(); (found = std::search(found, file_.end(), searcher)) != file_.end(); ++found)
      places.push_back(static_cast<std::size_t>(found - file_.begin()));
    return places;
  }

  /// Changes the byte `offset` behind each of the places.
  void flip(const std::vector<std::size_t>& places, std::ptrdiff_t offset, std::uint8_t bits) {
    for (const std::size_t place : places) {
      const std::size_t byte = place + static_cast<std::size_t>(offset);
      write_byte(temp_ / "data.mdb", byte, file_[byte] ^ bits);
    }
  }

  /// All blobs in a store with one damaged byte: each is right or refused. Returns those that are refused.
  std::set<BlobKey> refused(Store& store) {
    std::set<BlobKey> damaged;
    const auto reader = store.reader();
    for (const Blob& blob : blobs_) try {
        EXPECT_TRUE(reader->get(blob.key) == blob.bytes) << "wrong bytes, and nobody says so";
      } catch (const Error& e) {
        EXPECT_EQ(static_cast<int>(e.code()), static_cast<int>(Errc::corrupt)) << e.what();
        damaged.insert(blob.key);
      }
    return damaged;
  }

  /// Changes a byte of the blob `key`; expects that it is refused, and nothing else, and that check() finds it.
  void expect_found(const std::vector<std::size_t>& places, std::size_t offset, std::uint8_t bits, const BlobKey& key) {
    const auto signed_offset = static_cast<std::ptrdiff_t>(offset);
    flip(places, signed_offset, bits);
    {
      const auto store = temp_.open(Access::read);
      EXPECT_EQ(refused(*store), std::set<BlobKey>{key}) << "byte " << places.front() + offset;
      std::size_t named = 0;
      store->check([&](const Store::Problem& p) { named += p.key == key && p.kind == "checksum"; });
      EXPECT_EQ(named, 1U) << "byte " << places.front() + offset;
    }
    flip(places, signed_offset, 0);
  }

  TempStore temp_;
  std::vector<Blob> blobs_;
  Buffer file_;
};

TEST_F(Damage, AFlippedByteOfAPayloadIsNeverReadAsData) {
  std::size_t flips = 0;
  constexpr std::size_t kWindow = 12;
  for (const Blob& blob : blobs_)
    for (std::size_t from = 0; from + kWindow <= blob.bytes.size(); from += 613)
      if (const auto places = find(blob, from, kWindow); !places.empty()) {
        expect_found(places, flips % kWindow, static_cast<std::uint8_t>(1U << (flips % 8)), blob.key);
        ++flips;
      }
  EXPECT_GT(flips, 300U);
  EXPECT_EQ(problems(*temp_.open()), std::vector<std::string>{}) << "all flips were taken back";
}

TEST_F(Damage, AFlippedByteOfAChecksumRefusesTheBlob) {
  std::size_t flips = 0;
  for (const Blob& blob : blobs_) {
    // Longer ones may have their checksum in another part than the end of their payload.
    if (blob.bytes.size() > 1500) continue;
    const auto places = find(blob, blob.bytes.size() - 12, 12);
    if (places.empty()) continue;
    expect_found(places, 12 + flips % 8, 0x80, blob.key);
    ++flips;
  }
  EXPECT_GT(flips, 30U);
}

/// A key that turns into another one makes its blob miss; under the other name it is refused as well, because the
/// checksum is seeded by the key.
TEST_F(Damage, AFlippedByteOfAKeyGivesNobodyAnotherBlob) {
  std::size_t flips = 0;
  for (const Blob& blob : blobs_) {
    if (blob.bytes.size() > 1500) continue;
    const auto places = find(blob, 0, std::min<std::size_t>(blob.bytes.size(), 30));
    for (std::ptrdiff_t back = 1; !places.empty() && back <= 4; ++back)
      for (const std::uint8_t bits : std::initializer_list<std::uint8_t>{1, 2, 4}) {
        flip(places, -back, bits);
        {
          const auto store = temp_.open(Access::read);
          EXPECT_FALSE(refused(*store).empty()) << "byte " << places.front() << " - " << back;
          EXPECT_FALSE(problems(*store).empty()) << "byte " << places.front() << " - " << back;
        }
        flip(places, -back, 0);
        ++flips;
      }
  }
  EXPECT_GT(flips, 100U);
}

TEST_F(Damage, ARowWithoutBlobsIsNamedByCheck) {
  Database(temp_ / "catalogue.sqlite", Database::Mode::write)
      .run(
          "INSERT INTO version SELECT 9, branch, author, message, time_us, 'x', figures, parents, roots, changed "
          "FROM version WHERE id = 3");
  EXPECT_EQ(problems(*temp_.open()).front(), "missing: version 9 has lost its blobs");
}

TEST_F(Damage, AChangedRowIsFoundByCheck) {
  for (const char* change :
       {"message = 'other'", "author = ''", "branch = 'other'", "time_us = time_us + 1", "attempt = 'other'",
        "figures = '[]'", "parents = '[]'", "parents = '[7]'", "parents = 'x'", "roots = x'80ff'", "roots = x''",
        "changed = x'81'", "changed = x'8182018101'"}) {
    fs::copy_file(temp_ / "catalogue.sqlite", temp_ / "copy", fs::copy_options::overwrite_existing);
    Database(temp_ / "catalogue.sqlite", Database::Mode::write)
        .run(std::string("UPDATE version SET ") + change + " WHERE id = 2");
    {
      const auto store = temp_.open(Access::read);
      EXPECT_FALSE(problems(*store).empty()) << change;
    }
    for (const char* log : {"catalogue.sqlite-wal", "catalogue.sqlite-shm"}) fs::remove(temp_ / log);
    fs::rename(temp_ / "copy", temp_ / "catalogue.sqlite");
  }
  EXPECT_EQ(problems(*temp_.open()), std::vector<std::string>{});
}

TEST_F(Damage, ARowThatIsGoneLeavesOrphansForCheckToFind) {
  Database(temp_ / "catalogue.sqlite", Database::Mode::write).run("DELETE FROM version WHERE id = 2");
  std::set<VersionId> orphans;
  std::size_t count = 0;
  temp_.open()->check([&](const Store::Problem& p) {
    EXPECT_EQ(p.kind, "orphan") << p.text;
    if (p.key) orphans.insert(p.key->version);
    ++count;
  });
  EXPECT_EQ(orphans, std::set<VersionId>{VersionId(2)});
  EXPECT_GE(count, 36U);
}

TEST_F(Damage, ABranchThatPointsElsewhereIsFoundByCheck) {
  Database(temp_ / "catalogue.sqlite", Database::Mode::write).run("UPDATE ref SET version = 2 WHERE name = 'main'");
  EXPECT_EQ(problems(*temp_.open()),
            std::vector<std::string>{"catalogue: what branch main names is damaged: it says version 2"});
  Database(temp_ / "catalogue.sqlite", Database::Mode::write)
      .run("PRAGMA foreign_keys = OFF; UPDATE ref SET version = 8 WHERE name = 'main'");
  EXPECT_FALSE(problems(*temp_.open()).empty());
}

TEST_F(Damage, AnotherApplicationsCatalogueAndANewerFormatAreRefused) {
  Database(temp_ / "catalogue.sqlite", Database::Mode::write).run("PRAGMA user_version = 2");
  expect_error(Errc::unsupported_version, "format 2", [&] { (void)temp_.open(); });
  Database(temp_ / "catalogue.sqlite", Database::Mode::write).run("PRAGMA application_id = 1");
  expect_error(Errc::corrupt, "not one of RAMCdb", [&] { (void)temp_.open(); });
}

}  // namespace
}  // namespace ramcdb::db::test
