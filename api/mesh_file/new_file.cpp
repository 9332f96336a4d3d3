#include "api/mesh_file/new_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>

#include "ramcdb/error.h"

namespace ramcdb::mesh_file {

NewFile::NewFile(const std::filesystem::path& file)
    : file_(file.string()), temporary_(fmt::format("{}.{}.tmp", file_, ::getpid())) {
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail();
  buffer_.reserve(kBlock + 1024);
}

NewFile::~NewFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!committed_) ::unlink(temporary_.c_str());
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
  for (std::size_t done = 0; done < buffer_.size();) {
    const ssize_t n = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail();
    done += static_cast<std::size_t>(n);
    written_ += static_cast<std::uint64_t>(n);
  }
  buffer_.clear();
}

void NewFile::fail() const {
  const int error = errno;
  if (error == ENOSPC || error == EDQUOT) {
    struct statvfs space {};
    ::statvfs(temporary_.c_str(), &space);
    throw Error(Errc::disk_full,
                fmt::format("disk full: need more than {} bytes, have {}", written_ + buffer_.size(),
                            written_ + space.f_bavail * space.f_frsize),
                file_, "free space or write elsewhere; nothing was changed");
  }
  throw Error(Errc::storage, fmt::format("cannot write the file: {}", std::strerror(error)), file_,
              "check the folder and its permissions; nothing was changed");
}

}  // namespace ramcdb::mesh_file
