#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "api/mesh_file/file_bytes.h"

/// Binary OFF: behind the line "OFF BINARY" int32 counts of vertices, faces and edges; per vertex three float32; per
/// face an int32 number of corners, so many int32 indices, an int32 number of colour components and so many float32.
/// Geomview writes it big-endian. Others write little-endian, and no colours: what fits the file's length is taken.
namespace ramcdb::mesh_file {
namespace {

constexpr std::size_t kCounts = 12, kVertex = 12, kLeastFace = 16;

class BinaryOff {
 public:
  BinaryOff(const FileBytes& file, std::size_t offset, MeshData& mesh)
      : file_(file), text_(file.text().substr(offset)), offset_(offset), mesh_(mesh) {}

  void run() {
    if (text_.size() < kCounts) throw bad(0, "the file is cut off in its counts");
    if (!counts_fit()) {
      swap_ = !swap_;
      if (!counts_fit()) throw bad(0, "the file is too short for the vertices and faces that it announces");
    }
    const std::uint32_t vertices = word(0), faces = word(4);
    mesh_.positions.reserve(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
      const std::size_t at = kCounts + kVertex * v;
      mesh_.positions.push_back({coordinate(at), coordinate(at + 4), coordinate(at + 8)});
    }
    const std::size_t with = walk(faces, true, nullptr), without = walk(faces, false, nullptr);
    with_colors_ = with == text_.size() || (with && without != text_.size());
    mesh_.corners.reserve(3 * std::size_t{faces});
    DroppedCounter dropped;
    const std::size_t end = walk(faces, with_colors_, &dropped);
    dropped.add("bytes behind the last face", text_.size() - end);
    mesh_.dropped = dropped.take();
  }

 private:
  [[nodiscard]] Error bad(std::size_t at, std::string_view what) const { return bad_byte(file_, offset_ + at, what); }

  [[nodiscard]] std::uint32_t word(std::size_t at) const {
    std::uint32_t value = 0;
    std::memcpy(&value, text_.data() + at, sizeof value);
    return swap_ ? __builtin_bswap32(value) : value;
  }
  [[nodiscard]] double coordinate(std::size_t at) const { return static_cast<double>(std::bit_cast<float>(word(at))); }

  [[nodiscard]] bool counts_fit() const {
    return std::uint64_t{word(0)} * kVertex + std::uint64_t{word(4)} * kLeastFace <= text_.size() - kCounts;
  }

  /// The position behind the last face, or 0 where `take` is null and the bytes are no faces of this kind. With `take`
  /// faces are added, colours counted, and what is wrong thrown.
  std::size_t walk(std::uint32_t faces, bool colors, DroppedCounter* take) {
    std::size_t at = kCounts + kVertex * mesh_.positions.size();
    for (std::uint32_t f = 0; f < faces; ++f) {
      const std::size_t corners = text_.size() - at < 4 ? 0 : word(at);
      const bool whole = text_.size() - at >= 4 && corners <= (text_.size() - at) / 4 - 1;
      if (!take && (!whole || corners < 3)) return 0;
      if (!whole) throw bad(at, fmt::format("the file is cut off in face {}", f));
      if (corners < 3) throw bad(at, fmt::format("a face has {} corners", corners));
      if (take) add_face(at, static_cast<std::uint32_t>(corners));
      at += 4 + 4 * corners;
      if (!colors) continue;
      const std::size_t components = text_.size() - at < 4 ? text_.size() : word(at);
      if (components > (text_.size() - at) / 4) return 0;
      if (take && components) take->add("face colours");
      at += 4 + 4 * components;
      if (at > text_.size()) return 0;
    }
    return at;
  }

  void add_face(std::size_t at, std::uint32_t corners) {
    for (std::size_t c = 0; c < corners; ++c) {
      const std::uint32_t v = word(at + 4 + 4 * c);
      if (v >= mesh_.positions.size())
        throw bad(at, fmt::format("vertex index {} does not exist ({} vertices)", v, mesh_.positions.size()));
      mesh_.corners.push_back(v);
    }
    end_face(mesh_, corners);
  }

  const FileBytes& file_;
  std::string_view text_;
  std::size_t offset_;
  MeshData& mesh_;
  bool swap_ = std::endian::native == std::endian::little, with_colors_ = false;
};

}  // namespace

void read_binary_off(const FileBytes& file, std::size_t offset, MeshData& mesh) { BinaryOff(file, offset, mesh).run(); }

}  // namespace ramcdb::mesh_file
