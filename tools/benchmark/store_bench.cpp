#include "tools/benchmark/store_bench.h"

#include <lmdb.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "ramcdb/edit_transaction.h"
#include "tools/benchmark/timing.h"

namespace ramcdb::benchmark {
namespace {

void check(int result) {
  if (result != 0) throw std::runtime_error(std::string("plain LMDB: ") + mdb_strerror(result));
}

/// What somebody would write who only wants bytes to be there.
class PlainLmdb {
 public:
  explicit PlainLmdb(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    check(mdb_env_create(&env_));
    check(mdb_env_set_mapsize(env_, std::size_t{1} << 30));
    check(mdb_env_open(env_, folder.c_str(), 0, 0644));
  }
  PlainLmdb(const PlainLmdb&) = delete;
  PlainLmdb& operator=(const PlainLmdb&) = delete;
  ~PlainLmdb() { mdb_env_close(env_); }

  void put(std::uint64_t values, std::uint64_t bytes_each) {
    MDB_txn* transaction = nullptr;
    check(mdb_txn_begin(env_, nullptr, 0, &transaction));
    MDB_dbi table = 0;
    check(mdb_dbi_open(transaction, nullptr, 0, &table));
    std::vector<char> bytes(bytes_each, 'x');
    for (std::uint64_t v = 0; v < values; ++v) {
      std::uint64_t number = next_++;
      MDB_val key{sizeof number, &number};
      MDB_val value{bytes.size(), bytes.data()};
      check(mdb_put(transaction, table, &key, &value, 0));
    }
    check(mdb_txn_commit(transaction));
  }

 private:
  MDB_env* env_ = nullptr;
  std::uint64_t next_ = 1;
};

CommitReport commit_one_chart(Repository& repository, ChartId chart) {
  auto edit = repository.begin_edit();
  Patch& patch = edit.checkout({.shapes = {OfCharts{{chart}}}});
  const double step = patch.base().lattice().step;
  for (const auto v : patch.mesh().vertices())
    if (!patch.on_outer_border(v)) patch.mesh().point(v)[2] += 3 * step;
  CommitOptions options;
  options.message = "benchmark";
  return edit.commit(options);
}

}  // namespace

StoreFigures measure_store(const std::filesystem::path& file, const std::filesystem::path& scratch, unsigned bits,
                           unsigned rounds) {
  Repository::create(scratch / "repository");
  auto repository = Repository::open(scratch / "repository");
  PlainLmdb plain(scratch / "plain");
  ImportOptions options;
  options.bits = bits;
  StoreFigures figures;
  const ImportReport imported = repository.import(file, options);
  figures.info = imported.info;
  figures.import_seconds = imported.seconds;

  const auto charts = repository.snapshot().find({.shapes = {WholeMesh{}}});
  std::vector<double> checkout, checkout_bytes, checkout_blobs, commit, commit_bytes, lmdb;
  for (unsigned round = 0; round < rounds; ++round) {
    const ChartId chart = charts[(2 * round + 1) * charts.size() / (2 * rounds)];
    checkout.push_back(seconds([&] {
      const Snapshot snapshot = repository.snapshot();
      ReadCost cost;
      (void)snapshot.read(snapshot.find({.shapes = {OfCharts{{chart}}}}, &cost), 1, &cost);
      checkout_bytes.push_back(static_cast<double>(cost.bytes));
      checkout_blobs.push_back(static_cast<double>(cost.blobs));
    }));
    CommitReport report;
    commit.push_back(seconds([&] { report = commit_one_chart(repository, chart); }));
    commit_bytes.push_back(static_cast<double>(report.bytes_written));
    const std::uint64_t values = report.charts_reencoded + report.wires_reencoded + 4;  // pages and records
    lmdb.push_back(seconds([&] { plain.put(values, report.bytes_written / values); }));
  }
  figures.checkout_seconds = median(checkout);
  figures.checkout_bytes = median(checkout_bytes);
  figures.checkout_blobs = median(checkout_blobs);
  figures.commit_seconds = median(commit);
  figures.commit_bytes = median(commit_bytes);
  figures.plain_lmdb_seconds = median(lmdb);
  return figures;
}

}  // namespace ramcdb::benchmark
