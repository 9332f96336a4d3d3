#pragma once

#include <filesystem>
#include <memory>

#include "db/store.h"
#include "ramcdb/repository.h"

namespace ramcdb {

/// An open store. It is opened for writing the first time that something is to be written.
class Repository::Impl {
 public:
  explicit Impl(std::filesystem::path folder)
      : folder_(std::move(folder)), store_(db::Store::open(folder_, db::Access::read)) {}

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const std::shared_ptr<db::Store>& store() const { return store_; }
  [[nodiscard]] std::shared_ptr<db::Store> store_for_writing() const {
    return db::Store::open(folder_, db::Access::write);
  }

 private:
  std::filesystem::path folder_;
  std::shared_ptr<db::Store> store_;
};

}  // namespace ramcdb
