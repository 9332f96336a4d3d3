#include "db/file_system.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "ramcdb/error.h"

namespace ramcdb::db {

std::uint64_t bytes_on_disk(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return 0;
  return static_cast<std::uint64_t>(info.st_blocks) * 512;
}

std::uint64_t free_bytes(const std::filesystem::path& path) {
  struct statvfs info {};
  if (::statvfs(path.c_str(), &info) != 0) return ~std::uint64_t{0};
  return static_cast<std::uint64_t>(info.f_bavail) * info.f_frsize;
}

void require_free_bytes(const std::filesystem::path& path, std::uint64_t need) {
  const std::uint64_t have = free_bytes(path);
  if (have < need)
    throw Error(Errc::disk_full, fmt::format("disk full: need {} bytes, have {}", need, have), path.string(),
                "nothing was changed; free some space and try again");
}

bool is_network_file_system(const std::filesystem::path& path) {
  struct statfs info {};
  if (::statfs(path.c_str(), &info) != 0) return false;
  constexpr std::array<std::uint32_t, 6> kNetworks{0x6969 /* NFS */,      0x517B /* SMB */,     0xFF534D42 /* CIFS */,
                                                   0xFE534D42 /* SMB2 */, 0x5346414F /* AFS */, 0x73757245 /* Coda */};
  return std::find(kNetworks.begin(), kNetworks.end(), static_cast<std::uint32_t>(info.f_type)) != kNetworks.end();
}

void sync_folder(const std::filesystem::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) throw Error(Errc::storage, std::strerror(errno), folder.string());
  const int rc = ::fsync(fd);
  const int error = errno;
  ::close(fd);
  // Some file systems cannot sync folders; they say EINVAL and order names themselves.
  if (rc != 0 && error != EINVAL) throw Error(Errc::storage, std::strerror(error), folder.string());
}

}  // namespace ramcdb::db
