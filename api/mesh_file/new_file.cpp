#include "api/mesh_file/new_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>

#include "ramcdb/error.h"

namespace ramcdb::mesh_file {

NewFile::NewFile(const std::filesystem::path& file)
    : file_(file.string()), temporary_(fmt::format("{}.{}.tmp", file_, ::getpid())), buffer_(kBlock) {
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail();
}

NewFile::~NewFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!committed_) ::unlink(temporary_.c_str());
}

namespace {

using Digits = std::array<char, 40>;

std::string_view to_text(Digits& digits, double value, NumberType type) {
  if (std::isnan(value)) return "nan";
  char *const begin = digits.data(), *const end = begin + digits.size();
  const auto written = type == NumberType::float32   ? std::to_chars(begin, end, static_cast<float>(value))
                       : type == NumberType::float64 ? std::to_chars(begin, end, value)
                                                     : std::to_chars(begin, end, static_cast<std::int64_t>(value));
  return {begin, static_cast<std::size_t>(written.ptr - begin)};
}

}  // namespace

void NewFile::number(double value, NumberType type) {
  Digits digits;
  text(to_text(digits, value, type));
}

void NewFile::fraction(double value, NumberType type) {
  Digits digits;
  const std::string_view words = to_text(digits, value, type);
  text(words);
  if (words.find_first_not_of("0123456789-") == words.npos) text(".0");
}

void NewFile::whole(std::uint64_t value) {
  std::array<char, 24> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text({digits.data(), static_cast<std::size_t>(end - digits.data())});
}

void NewFile::commit() {
  flush();
  if (::fsync(descriptor_) != 0) fail();
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0) fail();
  if (::rename(temporary_.c_str(), file_.c_str()) != 0) fail();
  committed_ = true;
}

void NewFile::flush() {
  for (std::size_t done = 0; done < used_;) {
    const ssize_t n = ::write(descriptor_, buffer_.data() + done, used_ - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail();
    done += static_cast<std::size_t>(n);
    written_ += static_cast<std::uint64_t>(n);
  }
  used_ = 0;
}

void NewFile::make_room(std::size_t bytes) {
  flush();
  if (bytes > buffer_.size()) buffer_.resize(bytes);
}

void NewFile::fail() const {
  const int error = errno;
  if (error == ENOSPC || error == EDQUOT) {
    struct statvfs space {};
    ::statvfs(temporary_.c_str(), &space);
    throw Error(Errc::disk_full,
                fmt::format("disk full: need more than {} bytes, have {}", written_ + used_,
                            written_ + space.f_bavail * space.f_frsize),
                file_, "free space or write elsewhere; nothing was changed");
  }
  throw Error(Errc::storage, fmt::format("cannot write the file: {}", std::strerror(error)), file_,
              "check the folder and its permissions; nothing was changed");
}

}  // namespace ramcdb::mesh_file
