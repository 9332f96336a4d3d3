#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <set>
#include <thread>

#include "tests/api/numbered_edits.h"

/// Several processes at one repository. No process forks while it has the repository open.
namespace ramcdb::test {
namespace {

/// Runs `work` in a child process; its exit code is 0 when nothing failed.
template <class Work>
pid_t start(Work&& work) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  try {
    work();
  } catch (const std::exception& e) {
    ADD_FAILURE() << e.what();
  }
  ::_exit(::testing::Test::HasFailure() ? 1 : 0);
}

int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

/// A line of text through a pipe.
class Pipe {
 public:
  Pipe() {
    if (::pipe(ends_) != 0) throw std::runtime_error("pipe");
  }
  ~Pipe() {
    close_writing();
    ::close(ends_[0]);
  }
  void close_writing() {
    if (ends_[1] >= 0) ::close(std::exchange(ends_[1], -1));
  }
  void write(std::uint32_t number) const { ASSERT_EQ(::write(ends_[1], &number, sizeof number), 4); }
  /// Nothing when everybody closed the other end.
  [[nodiscard]] std::optional<std::uint32_t> read() const {
    std::uint32_t number = 0;
    return ::read(ends_[0], &number, sizeof number) == 4 ? std::optional(number) : std::nullopt;
  }

 private:
  int ends_[2] = {-1, -1};
};

TEST(Processes, EightReadersSeeWholeVersionsWhileOneWrites) {
  constexpr int kReaders = 8;
  constexpr std::uint32_t kCommits = 200;
  const TempFolder folder;
  const auto path = folder / "r";
  make_terrain_repository(path, 40, 200);

  std::vector<pid_t> readers;
  for (unsigned r = 0; r < kReaders; ++r)
    readers.push_back(start([&] {
      const Repository repository = Repository::open(path);
      const NumberedEdits edits(repository);
      std::mt19937 random(r);
      for (VersionId newest; newest.value <= kCommits;) {
        newest = repository.resolve("HEAD");
        const VersionId version(random() % 2 ? newest.value : 1 + static_cast<std::uint32_t>(random()) % newest.value);
        std::set<ChartId> charts;
        while (charts.size() < 3) charts.insert(ChartId(1 + static_cast<std::uint32_t>(random()) % edits.charts()));
        edits.check(repository, version, {charts.begin(), charts.end()});
        if (::testing::Test::HasFailure()) return;
      }
    }));
  const pid_t writer = start([&] {
    Repository repository = Repository::open(path);
    const NumberedEdits edits(repository);
    for (std::uint32_t n = 0; n < kCommits; ++n) EXPECT_EQ(edits.commit(repository, n).revision, VersionId(n + 2));
  });
  EXPECT_EQ(wait_for(writer), 0);
  for (const pid_t reader : readers) EXPECT_EQ(wait_for(reader), 0);
  EXPECT_TRUE(Repository::open(path).verify({}).ok());
}

TEST(Processes, WritersBesideEachOtherLoseNothing) {
  constexpr std::uint32_t kWriters = 3, kCommits = 20;
  const TempFolder folder;
  const auto path = folder / "r";
  make_terrain_repository(path, 40, 200);
  std::vector<pid_t> writers;
  for (std::uint32_t w = 0; w < kWriters; ++w)
    writers.push_back(start([&, w] {
      Repository repository = Repository::open(path);
      const NumberedEdits edits(repository);
      for (std::uint32_t n = 0; n < kCommits; ++n)
        while (!edits.commit(repository, kWriters * n + w).conflicts.empty()) {
        }
    }));
  for (const pid_t writer : writers) EXPECT_EQ(wait_for(writer), 0);
  const Repository repository = Repository::open(path);
  const NumberedEdits edits(repository);
  EXPECT_EQ(repository.log().size(), 1 + kWriters * kCommits);
  std::set<std::string> numbers;
  for (const VersionRecord& record : repository.log()) numbers.insert(record.message);
  EXPECT_EQ(numbers.size(), 1 + kWriters * kCommits) << "every edit once";
  edits.check(repository, repository.resolve("HEAD"), repository.snapshot().find({{WholeMesh{}}, 0}));
}

TEST(KilledWriter, LeavesEveryVersionWhoseReceiptWasPrinted) {
  constexpr int kKills = 200;
  const TempFolder folder;
  const auto path = folder / "r";
  make_terrain_repository(path, 24, 150);
  std::mt19937 random(5);
  std::uint32_t receipts = 0;
  for (int kill = 0; kill < kKills; ++kill) {
    Pipe pipe;
    const pid_t writer = start([&] {
      Repository repository = Repository::open(path);
      const NumberedEdits edits(repository);
      for (std::uint32_t n = static_cast<std::uint32_t>(kill);; ++n)
        pipe.write(edits.commit(repository, n).revision.value);
    });
    pipe.close_writing();
    // Now and then in the middle of opening, as a rule somewhere in a commit.
    const auto until = std::chrono::steady_clock::now() + std::chrono::microseconds(random() % 80'000);
    if (random() % 8 != 0) receipts = pipe.read().value_or(receipts);
    std::this_thread::sleep_until(until);
    ::kill(writer, SIGKILL);
    while (const auto receipt = pipe.read()) receipts = *receipt;
    const int status = wait_for(writer);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself, with " << status;

    const Repository repository = Repository::open(path);
    const NumberedEdits edits(repository);
    const VersionId head = repository.resolve("HEAD");
    ASSERT_GE(head.value, receipts);
    if (receipts > 1) edits.check(repository, VersionId(receipts), repository.snapshot().find({{WholeMesh{}}, 0}));
    edits.check(repository, head, repository.snapshot().find({{WholeMesh{}}, 0}));
    ASSERT_FALSE(::testing::Test::HasFailure()) << "after kill " << kill;
  }
  EXPECT_GT(receipts, static_cast<std::uint32_t>(kKills)) << "the writer was killed too early to tell anything";
  Repository repository = Repository::open(path);
  (void)NumberedEdits(repository).commit(repository, 0);  // recovers what the last kill left
  EXPECT_TRUE(repository.verify({}).ok());
}

}  // namespace
}  // namespace ramcdb::test
