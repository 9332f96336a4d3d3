#pragma once

#include <string>
#include <vector>

namespace ramcdb::cli {

/// A table for people: columns padded to their widest cell, two spaces between them, no trailing spaces.
class Table {
 public:
  enum class Align { left, right };
  struct Column {
    std::string title;
    Align align = Align::right;
  };

  explicit Table(std::vector<Column> columns);

  /// REQUIRES: as many cells as columns.
  void add(std::vector<std::string> cells);

  /// The titles and all rows, a line each.
  [[nodiscard]] std::string text() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;  ///< the titles first
};

}  // namespace ramcdb::cli
