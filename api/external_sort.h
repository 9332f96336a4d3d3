#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "api/scratch_records.h"
#include "chartify/parallel.h"

namespace ramcdb::detail {

/// Calls take(record, run) for the records of ascending runs in one ascending order; equal ones by run.
template <class Record, class Take>
void merge_runs(std::vector<RecordCursor<Record>>& runs, Take&& take) {
  const auto later = [&](std::size_t a, std::size_t b) {
    if (runs[a].value() < runs[b].value()) return false;
    return runs[b].value() < runs[a].value() || a > b;
  };
  std::vector<std::size_t> heap;
  for (std::size_t r = 0; r < runs.size(); ++r)
    if (!runs[r].at_end()) heap.push_back(r);
  std::make_heap(heap.begin(), heap.end(), later);
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), later);
    const std::size_t r = heap.back();
    take(runs[r].value(), r);
    runs[r].advance();
    if (runs[r].at_end())
      heap.pop_back();
    else
      std::push_heap(heap.begin(), heap.end(), later);
  }
}

/// Sorts any number of records within a bound of memory: runs on disk, merged. The order must be total, so that neither
/// the bound nor the number of threads shows in the result.
template <class Record>
class ExternalSorter {
 public:
  /// \param report is called again and again while runs are sorted; may throw to cancel
  ExternalSorter(const std::filesystem::path& folder, std::uint64_t memory, unsigned threads,
                 std::function<void()> report)
      : records_(folder),
        memory_(memory),
        threads_(threads),
        report_(std::move(report)),
        most_(std::max<std::size_t>(static_cast<std::size_t>(memory) / sizeof(Record), 16)) {}

  void add(const Record& record) {
    if (held_.capacity() == 0) held_.reserve(std::min<std::size_t>(most_, 1 << 12));
    if (held_.size() == held_.capacity()) held_.reserve(std::min(most_, 2 * held_.capacity()));
    held_.push_back(record);
    if (held_.size() == most_) end_runs();
  }

  /// Once, when all are added: calls take(record) for each, ascending.
  template <class Take>
  void merge(Take&& take) {
    end_runs();
    std::vector<Record>().swap(held_);
    const std::size_t each = static_cast<std::size_t>(memory_) / (sizeof(Record) * (runs_.size() + 1));
    std::vector<RecordCursor<Record>> cursors;
    for (std::size_t r = 0; r < runs_.size(); ++r)
      cursors.emplace_back(records_, r == 0 ? 0 : runs_[r - 1], runs_[r], std::min<std::size_t>(each, kMostHeld));
    merge_runs(cursors, [&](const Record& record, std::size_t) { take(record); });
  }

 private:
  static constexpr std::size_t kMostHeld = (std::size_t{1} << 20) / sizeof(Record);
  static constexpr std::size_t kMostOfRun = std::size_t{1} << 19;  // a tenth of a second

  void end_runs() {
    const std::size_t count = (held_.size() + kMostOfRun - 1) / kMostOfRun;
    const auto run = [&](std::size_t r) {
      return std::span(held_).subspan(r * kMostOfRun, std::min(kMostOfRun, held_.size() - r * kMostOfRun));
    };
    parallel_for(
        count, threads_, [&](std::size_t r) { std::sort(run(r).begin(), run(r).end()); }, [&](double) { report_(); });
    for (std::size_t r = 0; r < count; ++r) {
      report_();
      records_.add(std::span<const Record>(run(r)));
      runs_.push_back(records_.size());
    }
    held_.clear();
  }

  ScratchRecords<Record> records_;
  std::uint64_t memory_;
  unsigned threads_;
  std::function<void()> report_;
  std::size_t most_;
  std::vector<Record> held_;
  std::vector<std::uint64_t> runs_;  ///< where each ends
};

}  // namespace ramcdb::detail
