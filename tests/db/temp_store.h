#pragma once

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "db/store.h"
#include "ramcdb/error.h"
#include "tests/support/temp_folder.h"

namespace ramcdb::db::test {

namespace fs = std::filesystem;

using ::ramcdb::test::TempFolder;

/// A folder with an empty repository.
class TempStore {
 public:
  TempStore() { Store::create(folder()); }

  [[nodiscard]] fs::path folder() const { return temp_ / "r.ramcdb"; }
  [[nodiscard]] fs::path operator/(const std::string& name) const { return folder() / name; }
  [[nodiscard]] std::shared_ptr<Store> open(Access access = Access::write) const {
    return Store::open(folder(), access);
  }

 private:
  TempFolder temp_;
};

/// One step of splitmix64.
inline std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

/// Bytes that nobody can compress, a function of the seed alone; those of two seeds have nothing in common.
inline Buffer random_bytes(std::uint64_t seed, std::size_t size) {
  Buffer bytes(size);
  std::uint64_t state = mix(seed + 0x9E3779B97F4A7C15U);
  for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(mix(state += 0x9E3779B97F4A7C15U) >> 56);
  return bytes;
}

struct Blob {
  BlobKey key;
  Buffer bytes;
};

/// A blob whose content follows from its name: a reader without other knowledge can tell whether it is whole.
inline Blob make_blob(Kind kind, std::uint32_t id, std::size_t size, MeshId mesh = MeshId(1), std::uint16_t layer = 0) {
  const std::uint64_t seed =
      (static_cast<std::uint64_t>(kind) << 56) ^ (std::uint64_t{mesh.value} << 40) ^ (std::uint64_t{layer} << 32) ^ id;
  return {{kind, mesh, id, VersionId(), layer}, random_bytes(seed, size)};
}

/// What a commit of nothing in particular says of itself.
inline CommitInfo commit_info(Writer& writer, const std::string& branch = "main") {
  CommitInfo info;
  info.branch = branch;
  info.expected_tip = writer.tip(branch);
  if (info.expected_tip) info.parents = {info.expected_tip};
  info.author = "tester";
  info.message = fmt::format("version {}", writer.version().value);
  info.attempt = new_attempt_id();
  info.figures = "{}";
  return info;
}

/// Publishes the blobs as one version.
inline VersionId publish(Store& store, const std::vector<Blob>& blobs, const std::string& branch = "main") {
  const auto writer = store.writer(10);
  for (const Blob& blob : blobs) writer->put(blob.key, blob.bytes);
  return writer->publish(commit_info(*writer, branch));
}

inline BlobKey at(BlobKey key, VersionId version) {
  key.version = version;
  return key;
}

/// Whether all blobs are there, byte for byte, as of the version that wrote them.
inline void expect_blobs(Store& store, const std::vector<Blob>& blobs, VersionId version) {
  const auto reader = store.reader();
  for (const Blob& blob : blobs)
    EXPECT_TRUE(reader->get(at(blob.key, version)) == blob.bytes)
        << "kind " << static_cast<int>(blob.key.kind) << " id " << blob.key.id << " version " << version.value;
}

/// What check() finds, one line each.
inline std::vector<std::string> problems(Store& store) {
  std::vector<std::string> texts;
  store.check([&](const Store::Problem& p) { texts.push_back(p.kind + ": " + p.text); });
  return texts;
}

/// The error that `run` throws; fails the test when it throws none.
template <class Run>
std::optional<Error> error_of(Run&& run) {
  try {
    run();
  } catch (const Error& e) {
    return e;
  }
  ADD_FAILURE() << "no error";
  return std::nullopt;
}

template <class Run>
void expect_error(Errc code, const std::string& part_of_text, Run&& run) {
  const auto error = error_of(std::forward<Run>(run));
  if (!error) return;
  EXPECT_EQ(static_cast<int>(error->code()), static_cast<int>(code)) << error->what();
  EXPECT_NE(std::string(error->what()).find(part_of_text), std::string::npos) << error->what();
}

}  // namespace ramcdb::db::test
