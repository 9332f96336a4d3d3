#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <type_traits>
#include <vector>

#include "api/scratch_file.h"

namespace ramcdb::detail {

/// Records of one size in a scratch file, written one after another and read again by their number.
template <class Record>
class ScratchRecords {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  explicit ScratchRecords(const std::filesystem::path& folder) : file_(folder) {}

  [[nodiscard]] std::uint64_t size() const { return file_.size() / sizeof(Record) + held_.size(); }

  void add(const Record& record) {
    held_.push_back(record);
    if (held_.size() >= kHeld) flush();
  }
  void add(std::span<const Record> records) {
    flush();
    file_.append({reinterpret_cast<const std::uint8_t*>(records.data()), records.size_bytes()});
  }
  /// Before anything is read.
  void flush() {
    if (held_.empty()) return;
    file_.append({reinterpret_cast<const std::uint8_t*>(held_.data()), held_.size() * sizeof(Record)});
    held_ = {};
  }

  void read(std::uint64_t first, std::span<Record> to) const {
    file_.read(first * sizeof(Record), {reinterpret_cast<std::uint8_t*>(to.data()), to.size_bytes()});
  }
  [[nodiscard]] std::vector<Record> read(std::uint64_t first, std::size_t count) const {
    std::vector<Record> records(count);
    read(first, std::span(records));
    return records;
  }
  /// All records from first to last, some at a time.
  template <class Take>
  void for_each_piece(Take&& take) const {
    std::vector<Record> piece;
    for (std::uint64_t first = 0; first < size(); first += piece.size()) {
      piece.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kHeld, size() - first)));
      read(first, std::span(piece));
      take(std::span<const Record>(piece), first);
    }
  }
  /// Lets change(record) change each of them in place.
  template <class Change>
  void replace(Change&& change) {
    flush();
    for_each_piece([&](std::span<const Record> piece, std::uint64_t first) {
      std::vector<Record> changed(piece.begin(), piece.end());
      for (Record& record : changed) change(record);
      file_.overwrite(first * sizeof(Record),
                      {reinterpret_cast<const std::uint8_t*>(changed.data()), changed.size() * sizeof(Record)});
    });
  }
  [[nodiscard]] ScratchView view() const { return ScratchView(file_); }

 private:
  static constexpr std::size_t kHeld = std::max<std::size_t>(1, (std::size_t{1} << 19) / sizeof(Record));
  ScratchFile file_;
  std::vector<Record> held_;
};

/// Reads records one by one, from any number of places at once within little memory.
template <class Record>
class RecordCursor {
 public:
  RecordCursor(const ScratchRecords<Record>& records, std::uint64_t begin, std::uint64_t end, std::size_t held)
      : records_(&records), next_(begin), end_(end), most_(std::max<std::size_t>(held, 1)) {
    fill();
  }
  [[nodiscard]] bool at_end() const { return at_ == held_.size(); }
  [[nodiscard]] const Record& value() const { return held_[at_]; }
  void advance() {
    if (++at_ == held_.size()) fill();
  }

 private:
  void fill() {
    held_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(most_, end_ - next_)));
    records_->read(next_, std::span(held_));
    next_ += held_.size();
    at_ = 0;
  }

  const ScratchRecords<Record>* records_;
  std::uint64_t next_, end_;
  std::size_t most_, at_ = 0;
  std::vector<Record> held_;
};

}  // namespace ramcdb::detail
