#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "api/mesh_file/gltf_document.h"

/// GLB, little-endian: "glTF", u32 version 2, u32 length of all; then chunks of u32 length, u32 kind and so many bytes:
/// first "JSON", then "BIN\0" if there is one, then such as readers skip. A file without the magic word is JSON itself,
/// whatever its extension.
namespace ramcdb::mesh_file::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "byte order of GLB readers and writers");

constexpr std::string_view kMagic = "glTF", kJson = "JSON", kBinary{"BIN\0", 4};
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

std::uint32_t load(std::string_view text, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, text.data() + at, sizeof value);
  return value;
}

struct Chunk {
  std::string_view kind, bytes;
};

Chunk next_chunk(const FileBytes& file, std::string_view text, std::size_t& at) {
  if (text.size() - at < kChunkHeader) throw bad_byte(file, at, "the file is cut off in the head of a chunk");
  const std::size_t length = load(text, at), room = text.size() - at - kChunkHeader;
  if (length > room)
    throw bad_byte(file, at, fmt::format("a chunk announces {} bytes, {} are left in the file", length, room));
  const Chunk chunk{text.substr(at + 4, 4), text.substr(at + kChunkHeader, length)};
  at += kChunkHeader + length;
  return chunk;
}

}  // namespace

Container open_container(const FileBytes& file, DroppedCounter& dropped) {
  std::string_view text = file.text();
  if (!text.starts_with(kMagic)) return {text, {}};
  if (text.size() < kHeader + kChunkHeader) throw bad_byte(file, text.size(), "the file is cut off");
  if (const auto version = load(text, 4); version != 2)
    throw bad_byte(file, 4, fmt::format("glTF of version {} is not read, only 2", version));
  const std::size_t length = load(text, 8);
  if (length > text.size())
    throw bad_byte(file, 8, fmt::format("the file is cut off: it announces {} bytes and has {}", length, text.size()));
  if (length < kHeader + kChunkHeader) throw bad_byte(file, 8, fmt::format("the file announces {} bytes", length));
  dropped.add("bytes behind the file's announced end", text.size() - length);
  text = text.substr(0, length);

  std::size_t at = kHeader;
  const Chunk first = next_chunk(file, text, at);
  if (first.kind != kJson)
    throw bad_byte(file, kHeader, fmt::format("the first chunk is '{}' instead of JSON", shown(first.kind)));
  Container container{first.bytes, {}};
  for (bool second = true; at < text.size(); second = false) {
    const Chunk chunk = next_chunk(file, text, at);
    if (second && chunk.kind == kBinary)
      container.binary = chunk.bytes;
    else
      dropped.add(fmt::format("chunk '{}'", shown(chunk.kind)));
  }
  return container;
}

}  // namespace ramcdb::mesh_file::gltf
