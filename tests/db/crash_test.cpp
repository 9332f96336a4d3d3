#include <fcntl.h>
#include <sys/resource.h>

#include <csignal>
#include <stdexcept>

#include "db/fail_points.h"
#include "tests/db/child_process.h"
#include "tests/db/temp_store.h"

namespace ramcdb::db::test {
namespace {

/// Where a commit can end, and whether its version is published then.
struct Place {
  const char* point;
  bool published;
};
constexpr Place kPlaces[] = {{"writer.locked", false},   {"blobs.flushed", false},     {"blobs.before", false},
                             {"blobs.committed", false}, {"row.before_commit", false}, {"row.committed", true}};

struct Interruption : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Takes the hook away with the test.
class Hook {
 public:
  explicit Hook(FailHook hook) { set_fail_hook(std::move(hook)); }
  ~Hook() { set_fail_hook({}); }
  Hook(const Hook&) = delete;
  Hook& operator=(const Hook&) = delete;
};

FailHook at_point(const std::string& point, const std::function<void()>& act) {
  return [=](std::string_view name) {
    if (name == point) act();
  };
}

[[noreturn]] void kill_myself() {
  ::kill(::getpid(), SIGKILL);
  ::_exit(9);
}

std::vector<Blob> blobs_of(std::uint32_t first) {
  std::vector<Blob> blobs;
  for (std::uint32_t i = 0; i < 40; ++i) {
    blobs.push_back(make_blob(Kind::chart, first + i, 400 + 150 * i));
    blobs.push_back(make_blob(Kind::wire, first + i, 40));
  }
  return blobs;
}

/// Half of the blobs flushed, the rest published.
VersionId publish_in_two(Store& store, const std::vector<Blob>& blobs) {
  const auto writer = store.writer(10);
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (i == blobs.size() / 2) writer->flush();
    writer->put(blobs[i].key, blobs[i].bytes);
  }
  return writer->publish(commit_info(*writer));
}

void expect_no_blobs(Store& store, const std::vector<Blob>& blobs, VersionId version) {
  const auto reader = store.reader();
  for (const Blob& blob : blobs) EXPECT_FALSE(reader->find(at(blob.key, version)).has_value()) << blob.key.id;
}

/// A repository with two versions, and a third that ends in the middle.
class Crash : public ::testing::TestWithParam<Place> {
 protected:
  Crash() {
    const auto store = temp_.open();
    first_version_ = publish(*store, first_);
    second_version_ = publish_in_two(*store, second_);
  }

  /// The next writer works, all that was published is whole, and nothing else is left.
  void expect_recovered(bool third_published) {
    const VersionId third(second_version_.value + 1);
    const auto store = temp_.open();
    VersionId next;
    {
      const auto writer = store->writer(10);
      EXPECT_EQ(writer->tip("main"), third_published ? third : second_version_);
      EXPECT_GT(writer->version(), writer->tip("main"));
      writer->put(fourth_.key, fourth_.bytes);
      next = writer->publish(commit_info(*writer));
    }
    expect_blobs(*store, first_, first_version_);
    expect_blobs(*store, second_, second_version_);
    if (third_published)
      expect_blobs(*store, third_, third);
    else
      // Where nothing of it was durable its number may be the next one's.
      expect_no_blobs(*store, third_, third);
    expect_blobs(*store, {fourth_}, next);
    EXPECT_EQ(store->all_versions().size(), third_published ? 4U : 3U);
    EXPECT_EQ(problems(*store), std::vector<std::string>{});
  }

  void die(const std::string& point, const std::function<void()>& act, int status) {
    ChildProcess child([&] {
      const Hook hook(at_point(point, act));
      const auto store = temp_.open();
      (void)publish_in_two(*store, third_);
      ADD_FAILURE() << "survived " << point;
    });
    EXPECT_EQ(child.wait(), status);
  }

  const std::vector<Blob> first_ = blobs_of(1), second_ = blobs_of(20), third_ = blobs_of(30);
  const Blob fourth_ = make_blob(Kind::chart, 1000, 3000);
  TempStore temp_;
  VersionId first_version_, second_version_;
};

TEST_P(Crash, AnErrorOnTheWayIsTakenBack) {
  const auto store = temp_.open();
  {
    const Hook hook(at_point(GetParam().point, [] { throw Interruption("here"); }));
    EXPECT_THROW((void)publish_in_two(*store, third_), Interruption);
  }
  if (!GetParam().published) {
    EXPECT_EQ(store->resolve("main"), second_version_);
  }
  expect_recovered(GetParam().published);
}

TEST_P(Crash, AProcessThatEndsOnTheWay) {
  die(
      GetParam().point, [] { ::_exit(7); }, W_EXITCODE(7, 0));
  expect_recovered(GetParam().published);
}

TEST_P(Crash, AProcessThatIsKilledOnTheWay) {
  die(GetParam().point, kill_myself, W_EXITCODE(0, SIGKILL));
  expect_recovered(GetParam().published);
}

TEST_P(Crash, ReadersSeeOnlyPublishedVersionsBeforeAnyoneRecovers) {
  die(GetParam().point, kill_myself, W_EXITCODE(0, SIGKILL));
  const auto store = temp_.open(Access::read);
  const VersionId tip = store->resolve("HEAD");
  EXPECT_EQ(tip.value, second_version_.value + (GetParam().published ? 1 : 0));
  expect_blobs(*store, GetParam().published ? third_ : second_, tip);
}

TEST_P(Crash, ManyInARowOneAfterTheOther) {
  for (int i = 0; i < 3; ++i) {
    ChildProcess child([&] {
      const Hook hook(at_point(GetParam().point, kill_myself));
      const auto store = temp_.open();
      (void)publish_in_two(*store, blobs_of(100));
    });
    EXPECT_EQ(child.wait(), W_EXITCODE(0, SIGKILL));
  }
  const auto store = temp_.open();
  const VersionId next = publish(*store, {fourth_});
  const auto versions = store->all_versions();
  EXPECT_EQ(versions.size(), GetParam().published ? 6U : 3U);
  for (const VersionId version : versions)
    if (version > second_version_ && version < next) expect_blobs(*store, blobs_of(100), version);
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(Points, Crash, ::testing::ValuesIn(kPlaces), [](const auto& place) {
  std::string name = place.param.point;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

class CrashInRecovery : public Crash {};

TEST_P(CrashInRecovery, IsRecoveredByTheNextWriter) {
  die("blobs.committed", kill_myself, W_EXITCODE(0, SIGKILL));
  for (int i = 0; i < 2; ++i) die(GetParam().point, kill_myself, W_EXITCODE(0, SIGKILL));
  expect_recovered(false);
}

TEST_P(CrashInRecovery, AnErrorLeavesItToTheNextWriter) {
  die("blobs.committed", kill_myself, W_EXITCODE(0, SIGKILL));
  const auto store = temp_.open();
  {
    const Hook hook(at_point(GetParam().point, [] { throw Interruption("here"); }));
    EXPECT_THROW((void)store->writer(10), Interruption);
  }
  expect_recovered(false);
}

// The first place only: once the leftovers are gone there is nothing to recover from.
INSTANTIATE_TEST_SUITE_P(Points, CrashInRecovery, ::testing::Values(Place{"recovery.begin", false}),
                         [](const auto&) { return "recovery_begin"; });

TEST_F(Crash, BehindTheRecoveryNothingIsLeft) {
  die("blobs.committed", kill_myself, W_EXITCODE(0, SIGKILL));
  die("recovery.deleted", kill_myself, W_EXITCODE(0, SIGKILL));
  EXPECT_EQ(problems(*temp_.open()), std::vector<std::string>{});
  expect_recovered(false);
}

TEST_F(Crash, ANumberThatWasDurableIsNotUsedAgain) {
  die("blobs.committed", kill_myself, W_EXITCODE(0, SIGKILL));
  const auto store = temp_.open();
  EXPECT_EQ(store->writer(10)->version().value, second_version_.value + 2);
  EXPECT_EQ(publish(*store, {fourth_}).value, second_version_.value + 2);
}

TEST_F(Crash, ALostAnswerIsFoundByTheAttempt) {
  const std::string attempt = new_attempt_id();
  const auto run = [&](Store& store) {
    const auto writer = store.writer(10);
    CommitInfo info = commit_info(*writer);
    info.attempt = attempt;
    return writer->publish(info);
  };
  ChildProcess child([&] {
    const Hook hook(at_point("row.committed", kill_myself));
    (void)run(*temp_.open());
  });
  EXPECT_EQ(child.wait(), W_EXITCODE(0, SIGKILL));
  const auto store = temp_.open();
  const auto found = store->published_by(attempt);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(run(*store), *found);
  EXPECT_EQ(store->all_versions().size(), 3U);
}

TEST_F(Crash, AKilledFirstCommitLeavesAnEmptyRepository) {
  const TempStore fresh;
  ChildProcess child([&] {
    const Hook hook(at_point("blobs.committed", kill_myself));
    (void)publish(*fresh.open(), first_);
  });
  EXPECT_EQ(child.wait(), W_EXITCODE(0, SIGKILL));
  const auto store = fresh.open();
  EXPECT_EQ(store->resolve(""), VersionId());
  expect_blobs(*store, first_, publish(*store, first_));
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
}

/// The number of the newest transaction as LMDB's lock file tells it to other processes, where on this platform it is.
class ToldTransaction {
 public:
  explicit ToldTransaction(const fs::path& data)
      : data_(::open(data.c_str(), O_RDONLY)), lock_(::open((data.string() + "-lock").c_str(), O_RDWR)) {}
  ToldTransaction(const ToldTransaction&) = delete;
  ~ToldTransaction() {
    ::close(data_);
    ::close(lock_);
  }

  /// Others go on seeing the one before, as long as nobody begins to write.
  void set_back() const {
    constexpr off_t kInMeta = 144, kInLock = 48;
    const std::uint64_t newest = std::max(number(data_, kInMeta), number(data_, ::sysconf(_SC_PAGESIZE) + kInMeta));
    ASSERT_EQ(number(lock_, kInLock), newest);
    const std::uint64_t before = newest - 1;
    ASSERT_EQ(::pwrite(lock_, &before, sizeof before, kInLock), 8);
  }

 private:
  static std::uint64_t number(int file, off_t at) {
    std::uint64_t value = 0;
    EXPECT_EQ(::pread(file, &value, sizeof value, at), 8);
    return value;
  }

  int data_, lock_;
};

/// LMDB's commit is on disk a moment before LMDB tells other processes of it; a writer may be killed in between.
TEST(CrashBesideOthers, BlobsThatOtherProcessesWereNotToldOfAreTakenBack) {
  const TempStore temp;
  auto store = temp.open();  // and its lock file stays as it is
  const std::vector<Blob> blobs = blobs_of(1);
  ChildProcess child([&] {
    store.reset();
    const auto own = temp.open();
    const auto writer = own->writer(10);
    for (const Blob& blob : blobs) writer->put(blob.key, blob.bytes);
    writer->flush();
    ToldTransaction(temp / "data.mdb").set_back();
    const rlimit nothing{0, 0};
    ::setrlimit(RLIMIT_FSIZE, &nothing);
    for (const Blob& blob : blobs_of(1000)) writer->put(blob.key, blob.bytes);
    writer->flush();  // dies as it writes its first page, with LMDB's lock
  });
  EXPECT_EQ(child.wait() & 0x7f, SIGXFSZ);
  expect_blobs(*store, blobs, publish(*store, blobs));
  EXPECT_EQ(problems(*store), std::vector<std::string>{});
}

}  // namespace
}  // namespace ramcdb::db::test
