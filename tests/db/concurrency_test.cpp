#include <fmt/format.h>
#include <thread>

#include "db/environment.h"
#include "db/pins.h"
#include "tests/db/child_process.h"
#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

/// What the version before and this one wrote: enough to tell a whole version from half of one.
std::vector<Blob> blobs_of_version(std::uint32_t version) {
  std::vector<Blob> blobs;
  for (std::uint32_t i = 1; i <= 6; ++i) {
    blobs.push_back(make_blob(Kind::chart, i, 200 + (version * 37 + i * 911) % 6000, MeshId(1)));
    blobs.back().bytes = random_bytes(version * 100 + i, blobs.back().bytes.size());
  }
  return blobs;
}

/// Forks, opens, and reads whatever is the tip until it is `last`: every tip must be whole, and tips never go back.
ChildProcess start_reader(const TempStore& temp, std::uint32_t last) {
  return ChildProcess([&temp, last] {
    const auto store = temp.open(Access::read);
    VersionId seen;
    while (seen.value < last) {
      const VersionId tip = store->resolve("HEAD");
      ASSERT_GE(tip, seen);
      seen = tip;
      if (!tip) continue;
      ASSERT_EQ(store->version(tip).message, fmt::format("version {}", tip.value));
      expect_blobs(*store, blobs_of_version(tip.value), tip);
      expect_blobs(*store, blobs_of_version(1 + tip.value / 2), VersionId(1 + tip.value / 2));
      ASSERT_FALSE(::testing::Test::HasFailure());
    }
  });
}

TEST(Concurrency, ReadersBesideAWriterSeeWholeVersions) {
  constexpr std::uint32_t kVersions = 60;
  const TempStore temp;
  std::vector<ChildProcess> readers;
  for (int i = 0; i < 3; ++i) readers.push_back(start_reader(temp, kVersions));
  ChildProcess writer([&] {
    const auto store = temp.open();
    for (std::uint32_t v = 1; v <= kVersions; ++v) ASSERT_EQ(publish(*store, blobs_of_version(v)), VersionId(v));
  });
  EXPECT_EQ(writer.wait(), 0);
  for (ChildProcess& reader : readers) EXPECT_EQ(reader.wait(), 0);
  EXPECT_EQ(problems(*temp.open()), std::vector<std::string>{});
}

/// Adds one to the number in the chart of the tip. The lock is not held between reading and writing: whoever comes
/// second must be refused and begin anew.
void add_one(Store& store) {
  for (;;) {
    const VersionId base = store.resolve("main");
    const BlobKey key{Kind::chart, MeshId(1), 1, base, 0};
    Buffer number = base ? store.reader()->get(key) : Buffer(4, 0);
    ++number[0];
    const auto writer = store.writer(60);
    CommitInfo info = commit_info(*writer);
    info.expected_tip = base;
    info.parents.clear();
    if (base) info.parents = {base};
    writer->put(key, number);
    try {
      (void)writer->publish(info);
      return;
    } catch (const Error& e) {
      if (e.code() != Errc::conflict) throw;
    }
  }
}

TEST(Concurrency, NoUpdateOfTwoWritersIsLost) {
  constexpr std::uint8_t kEach = 25;
  const TempStore temp;
  const auto count = [&] {
    return ChildProcess([&] {
      const auto store = temp.open();
      for (int i = 0; i < kEach; ++i) add_one(*store);
    });
  };
  ChildProcess one = count(), two = count();
  EXPECT_EQ(one.wait(), 0);
  EXPECT_EQ(two.wait(), 0);
  const auto store = temp.open();
  const VersionId tip = store->resolve("main");
  EXPECT_EQ(store->reader()->get({Kind::chart, MeshId(1), 1, tip, 0})[0], 2 * kEach);
  EXPECT_EQ(store->history(tip, 1000).size(), 2U * kEach);
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
}

TEST(Concurrency, ThreadsOfOneProcessShareAStore) {
  constexpr std::uint8_t kEach = 10;
  const TempStore temp;
  const auto count = [&] {
    const auto store = temp.open();
    for (int i = 0; i < kEach; ++i) add_one(*store);
  };
  std::thread one(count), two(count), three(count);
  one.join();
  two.join();
  three.join();
  const auto store = temp.open();
  const VersionId tip = store->resolve("main");
  EXPECT_EQ(store->reader()->get({Kind::chart, MeshId(1), 1, tip, 0})[0], 3 * kEach);
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
}

TEST(Concurrency, TheSecondWriterOfAProcessIsRefusedWhenItsTimeIsOver) {
  const TempStore temp;
  const auto store = temp.open();
  const auto writer = store->writer(0);
  expect_error(Errc::storage, fmt::format("process {} is writing", ::getpid()), [&] { (void)store->writer(0); });
  ChildProcess other([&] {
    // A folder of its own name for the same files: the child must not touch the parent's store.
    expect_error(Errc::storage, "fork", [&] { (void)temp.open(); });
  });
  EXPECT_EQ(other.wait(), 0);
}

TEST(Concurrency, AStoreIsOneObjectPerProcess) {
  const TempStore temp;
  const auto store = temp.open(Access::read);
  EXPECT_EQ(store, temp.open(Access::write));
  EXPECT_EQ(store, Store::open(temp.folder() / "." / "", Access::read));
  fs::create_directory_symlink(temp.folder(), temp.folder().parent_path() / "link");
  EXPECT_EQ(store, Store::open(temp.folder().parent_path() / "link", Access::read));
  const TempStore other;
  EXPECT_NE(store, other.open());
}

TEST(Fork, AChildIsToldNotToUseItsParentsStore) {
  const TempStore temp;
  auto store = temp.open();
  const auto blobs = blobs_of_version(1);
  const VersionId version = publish(*store, blobs);
  auto reader = store->reader();
  auto pin = store->pin(version, "parent");
  ChildProcess child([&] {
    const std::function<void()> uses[] = {
        [&] { (void)store->resolve("HEAD"); }, [&] { (void)store->reader(); }, [&] { (void)store->writer(0); },
        [&] { (void)store->roots(version); },  [&] { problems(*store); },      [&] { reader->renew(); }};
    for (const auto& use : uses) expect_error(Errc::storage, "before a fork", use);
    expect_error(Errc::storage, "before a fork", [&] { (void)temp.open(); });
    pin.reset();
    reader.reset();
    store.reset();
    // Now it is nobody's in this process.
    const auto own = temp.open();
    expect_blobs(*own, blobs, version);
    EXPECT_EQ(publish(*own, blobs_of_version(2)).value, version.value + 1);
  });
  EXPECT_EQ(child.wait(), 0);
  expect_blobs(*store, blobs, version);
  EXPECT_EQ(store->resolve("HEAD").value, version.value + 1);
  EXPECT_EQ(sweep_pins(temp / "pins"), std::vector<VersionId>{version}) << "the child let go of its copy only";
  EXPECT_EQ(publish(*store, blobs_of_version(3)).value, version.value + 2);
}

TEST(Fork, AChildThatEndsLeavesItsParentsWriterAlone) {
  const TempStore temp;
  const auto store = temp.open();
  const auto writer = store->writer(0);
  for (const Blob& blob : blobs_of_version(1)) writer->put(blob.key, blob.bytes);
  writer->flush();
  ChildProcess child([] {});
  EXPECT_EQ(child.wait(), 0);
  expect_error(Errc::storage, "is writing", [&] { (void)store->writer(0); });
  expect_blobs(*store, blobs_of_version(1), writer->publish(commit_info(*writer)));
}

/// Memory maps that begin with a megabyte, for this test's processes.
class SmallMap : public ::testing::Test {
 protected:
  SmallMap() { set_first_map_size(1 << 20); }
  ~SmallMap() override { set_first_map_size(0); }
};

TEST_F(SmallMap, GrowsUnderTwoProcessesThatTakeTurns) {
  const TempStore temp;
  const auto turns = [&](std::uint32_t first) {
    return ChildProcess([&, first] {
      const auto store = temp.open();
      for (std::uint32_t i = 0; i < 8; ++i) {
        const auto blobs = std::vector{make_blob(Kind::chart, first + i, 400'000), make_blob(Kind::wire, first + i, 9)};
        expect_blobs(*store, blobs, publish(*store, blobs));
      }
    });
  };
  ChildProcess one = turns(100), two = turns(200);
  ChildProcess reader([&] {
    const auto store = temp.open(Access::read);
    for (std::size_t seen = 0; seen < 16;) {
      seen = store->all_versions().size();
      if (const VersionId tip = store->resolve("HEAD")) (void)store->version(tip);
      const auto blobs = store->reader();
    }
  });
  EXPECT_EQ(one.wait(), 0);
  EXPECT_EQ(two.wait(), 0);
  EXPECT_EQ(reader.wait(), 0);
  const auto store = temp.open();
  EXPECT_EQ(store->all_versions().size(), 16U);
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
}

/// Every wire of a large mesh anew: each copies a leaf page and splits it, many times its bytes.
TEST_F(SmallMap, HoldsManySmallBlobsBetweenOlderOnes) {
  const TempStore temp;
  const auto store = temp.open();
  std::vector<Blob> wires, again;
  for (std::uint32_t id = 1; id <= 20'000; ++id) wires.push_back(make_blob(Kind::wire, id, 60));
  for (std::uint32_t id = 1; id <= 20'000; id += 7) again.push_back(make_blob(Kind::wire, id, 60));
  expect_blobs(*store, wires, publish(*store, wires));
  for (int i = 0; i < 4; ++i) expect_blobs(*store, again, publish(*store, again));
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
}

TEST_F(SmallMap, HasRoomToTakeBackWhatACrashLeft) {
  const TempStore temp;
  for (int i = 0; i < 3; ++i) {
    ChildProcess child([&] {
      const auto store = temp.open();
      const auto writer = store->writer(10);
      for (std::uint32_t id = 1; id <= 3000; ++id) {
        writer->put({Kind::chart, MeshId(1), id * 7919 % 3001, VersionId(), 0}, random_bytes(id, 900));
        if (id % 1000 == 0) writer->flush();
      }
      ::kill(::getpid(), SIGKILL);
    });
    EXPECT_EQ(child.wait(), W_EXITCODE(0, SIGKILL));
  }
  const auto store = temp.open();
  expect_blobs(*store, blobs_of_version(1), publish(*store, blobs_of_version(1)));
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
}

TEST(Pins, HoldUntilTheirObjectOrTheirProcessIsGone) {
  const TempStore temp;
  const auto store = temp.open();
  for (std::uint32_t v = 1; v <= 3; ++v) (void)publish(*store, blobs_of_version(v));

  auto first = store->pin(VersionId(1), "one");
  auto again = store->pin(VersionId(1), "two");
  auto third = store->pin(VersionId(3), "three");
  const auto none = store->pin(VersionId(), "nothing");
  EXPECT_EQ(sweep_pins(temp / "pins"), (std::vector{VersionId(1), VersionId(3)}));
  first.reset();
  third.reset();
  EXPECT_EQ(sweep_pins(temp / "pins"), std::vector{VersionId(1)});
  again.reset();
  EXPECT_TRUE(sweep_pins(temp / "pins").empty());
  EXPECT_TRUE(fs::is_empty(temp / "pins"));
  expect_error(Errc::not_found, "no version 9", [&] { (void)store->pin(VersionId(9), "nobody"); });
  EXPECT_TRUE(fs::is_empty(temp / "pins"));
}

TEST(Pins, OfAKilledProcessAreSwept) {
  const TempStore temp;
  (void)publish(*temp.open(), blobs_of_version(1));
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  ChildProcess child([&] {
    const auto pin = temp.open(Access::read)->pin(VersionId(1), "child");
    ASSERT_EQ(::write(ready[1], "x", 1), 1);
    for (;;) ::pause();
  });
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_EQ(sweep_pins(temp / "pins"), std::vector{VersionId(1)});
  ::kill(child.pid(), SIGKILL);
  EXPECT_EQ(child.wait(), W_EXITCODE(0, SIGKILL));
  EXPECT_FALSE(fs::is_empty(temp / "pins")) << "its file stays";
  EXPECT_TRUE(sweep_pins(temp / "pins").empty());
  EXPECT_TRUE(fs::is_empty(temp / "pins"));
  for (const int fd : ready) ::close(fd);
}

}  // namespace
}  // namespace ramcdb::db::test
