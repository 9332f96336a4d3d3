#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "api/mesh_file/file_bytes.h"
#include "api/mesh_file/mesh_file.h"

namespace ramcdb::mesh_file {
namespace {

static_assert(std::endian::native == std::endian::little, "byte order of STL and PLY writers");

/// A file that appears whole, when commit() is called, or not at all.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& file)
      : file_(file.string()), temporary_(fmt::format("{}.{}.tmp", file_, ::getpid())) {
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail();
    buffer_.reserve(kBlock + 1024);
  }
  ~NewFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!committed_) ::unlink(temporary_.c_str());
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void text(std::string_view words) {
    buffer_.append(words);
    if (buffer_.size() >= kBlock) flush();
  }
  template <class T>
  void binary(T value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    text({bytes.data(), bytes.size()});
  }
  /// The shortest text that reads back as the same number of this type.
  void number(double value, Scalar scalar) {
    std::array<char, 40> digits;
    const auto end = scalar == Scalar::float32
                         ? std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<float>(value)).ptr
                         : std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text({digits.data(), static_cast<std::size_t>(end - digits.data())});
  }
  void whole(std::uint64_t value) {
    std::array<char, 24> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text({digits.data(), static_cast<std::size_t>(end - digits.data())});
  }

  void commit() {
    flush();
    if (::fsync(descriptor_) != 0) fail();
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) fail();
    if (::rename(temporary_.c_str(), file_.c_str()) != 0) fail();
    committed_ = true;
  }

 private:
  static constexpr std::size_t kBlock = 1 << 20;

  void flush() {
    for (std::size_t done = 0; done < buffer_.size();) {
      const ssize_t n = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail();
      done += static_cast<std::size_t>(n);
      written_ += static_cast<std::uint64_t>(n);
    }
    buffer_.clear();
  }

  [[noreturn]] void fail() const {
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

  std::string file_, temporary_, buffer_;
  int descriptor_ = -1;
  std::uint64_t written_ = 0;
  bool committed_ = false;
};

void write_ply_header(NewFile& out, const MeshOutput& mesh, bool ascii) {
  const char* scalar = mesh.scalar == Scalar::float32 ? "float" : "double";
  out.text(fmt::format("ply\nformat {} 1.0\nelement vertex {}\n", ascii ? "ascii" : "binary_little_endian",
                       mesh.positions.size()));
  for (const char axis : {'x', 'y', 'z'}) out.text(fmt::format("property {} {}\n", scalar, axis));
  if (!mesh.vertex_ids.empty()) out.text("property uint ramcdb_id_hi\nproperty uint ramcdb_id_lo\n");
  out.text(fmt::format("element face {}\nproperty list uchar int vertex_indices\n", mesh.faces.size()));
  if (!mesh.face_colors.empty()) out.text("property uchar red\nproperty uchar green\nproperty uchar blue\n");
  out.text("end_header\n");
}

void write_ply_ascii(NewFile& out, const MeshOutput& mesh) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    for (int a = 0; a < 3; ++a) {
      if (a) out.text(" ");
      out.number(mesh.positions[v][a], mesh.scalar);
    }
    if (!mesh.vertex_ids.empty()) {
      out.text(" ");
      out.whole(mesh.vertex_ids[v] >> 32);
      out.text(" ");
      out.whole(mesh.vertex_ids[v] & 0xffffffffU);
    }
    out.text("\n");
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    out.text("3");
    for (const std::uint32_t v : mesh.faces[f]) {
      out.text(" ");
      out.whole(v);
    }
    if (!mesh.face_colors.empty()) {
      const FaceColor c = mesh.face_colors[f];
      out.text(fmt::format(" {} {} {}", c.r, c.g, c.b));
    }
    out.text("\n");
  }
}

void write_ply_binary(NewFile& out, const MeshOutput& mesh) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    for (int a = 0; a < 3; ++a) {
      if (mesh.scalar == Scalar::float32)
        out.binary(static_cast<float>(mesh.positions[v][a]));
      else
        out.binary(mesh.positions[v][a]);
    }
    if (!mesh.vertex_ids.empty()) {
      out.binary(static_cast<std::uint32_t>(mesh.vertex_ids[v] >> 32));
      out.binary(static_cast<std::uint32_t>(mesh.vertex_ids[v]));
    }
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    out.binary(std::uint8_t{3});
    for (const std::uint32_t v : mesh.faces[f]) out.binary(v);
    if (!mesh.face_colors.empty()) {
      out.binary(mesh.face_colors[f].r);
      out.binary(mesh.face_colors[f].g);
      out.binary(mesh.face_colors[f].b);
    }
  }
}

void write_positions(NewFile& out, const MeshOutput& mesh, std::string_view before) {
  for (const Point& p : mesh.positions) {
    out.text(before);
    for (int a = 0; a < 3; ++a) {
      if (a) out.text(" ");
      out.number(p[a], mesh.scalar);
    }
    out.text("\n");
  }
}

void write_obj(NewFile& out, const MeshOutput& mesh) {
  write_positions(out, mesh, "v ");
  for (const Triangle& t : mesh.faces) {
    out.text("f");
    for (const std::uint32_t v : t) {
      out.text(" ");
      out.whole(std::uint64_t{v} + 1);
    }
    out.text("\n");
  }
}

void write_off(NewFile& out, const MeshOutput& mesh) {
  out.text(fmt::format("OFF\n{} {} 0\n", mesh.positions.size(), mesh.faces.size()));
  write_positions(out, mesh, "");
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    out.text("3");
    for (const std::uint32_t v : mesh.faces[f]) {
      out.text(" ");
      out.whole(v);
    }
    if (!mesh.face_colors.empty()) {
      const FaceColor c = mesh.face_colors[f];
      out.text(fmt::format(" {} {} {}", c.r, c.g, c.b));
    }
    out.text("\n");
  }
}

/// The unit normal that STL wants, zero for triangles without area or too large for it.
std::array<float, 3> facet_normal(const Point& a, const Point& b, const Point& c) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
  return {static_cast<float>(nx / length), static_cast<float>(ny / length), static_cast<float>(nz / length)};
}

void write_stl(NewFile& out, const MeshOutput& mesh) {
  std::array<char, 80> header{};
  constexpr std::string_view kTitle = "binary STL written by ramcdb";
  std::copy(kTitle.begin(), kTitle.end(), header.begin());
  out.text({header.data(), header.size()});
  out.binary(static_cast<std::uint32_t>(mesh.faces.size()));
  for (const Triangle& t : mesh.faces) {
    for (const float n : facet_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]])) out.binary(n);
    for (const std::uint32_t v : t)
      for (int a = 0; a < 3; ++a) out.binary(static_cast<float>(mesh.positions[v][a]));
    out.binary(std::uint16_t{0});
  }
}

/// Nothing is written that our own reader would not take.
void check(const std::filesystem::path& file, Format format, const MeshOutput& mesh) {
  const auto refuse = [&](std::string_view what) {
    return Error(Errc::invalid_argument, what, file.string(), "nothing was written");
  };
  const bool floats = mesh.scalar == Scalar::float32 || format == Format::stl;
  const double largest = floats ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (int a = 0; a < 3; ++a)
      if (!(std::abs(mesh.positions[v][a]) <= largest))
        throw refuse(fmt::format("vertex {} has a coordinate that {} cannot hold", v, floats ? "float32" : "a file"));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t v : mesh.faces[f])
      if (v >= mesh.positions.size()) throw refuse(fmt::format("face {} names vertex {}, which is none", f, v));
  if (!mesh.vertex_ids.empty() && mesh.vertex_ids.size() != mesh.positions.size())
    throw refuse(fmt::format("{} ids for {} vertices", mesh.vertex_ids.size(), mesh.positions.size()));
  if (!mesh.face_colors.empty() && mesh.face_colors.size() != mesh.faces.size())
    throw refuse(fmt::format("{} colours for {} faces", mesh.face_colors.size(), mesh.faces.size()));
}

}  // namespace

void write_mesh(const std::filesystem::path& file, Format format, const MeshOutput& mesh, bool ascii) {
  check(file, format, mesh);
  NewFile out(file);
  switch (format) {
    case Format::ply:
      write_ply_header(out, mesh, ascii);
      ascii ? write_ply_ascii(out, mesh) : write_ply_binary(out, mesh);
      break;
    case Format::obj:
      write_obj(out, mesh);
      break;
    case Format::off:
      write_off(out, mesh);
      break;
    case Format::stl:
      write_stl(out, mesh);
      break;
  }
  out.commit();
}

}  // namespace ramcdb::mesh_file
