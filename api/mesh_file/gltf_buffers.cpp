#include "api/mesh_file/gltf_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "api/mesh_file/gltf_base64.h"

namespace ramcdb::mesh_file::gltf {
namespace {

constexpr std::string_view kData = "data:", kBase64 = ";base64,";

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// %20 and the like as the byte.
std::string percent_decoded(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool code = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
    if (!code) {
      text += uri[i];
      continue;
    }
    text += static_cast<char>(16 * hex_digit(uri[i + 1]) + hex_digit(uri[i + 2]));
    i += 2;
  }
  return text;
}

/// Whether a path stays in the folder that it is relative to, whatever system made it.
bool stays_below(const std::string& path) {
  if (path.empty() || path.find_first_of(":\\") != path.npos || path.find('\0') != path.npos) return false;
  const std::filesystem::path relative(path);
  return !relative.is_absolute() &&
         std::none_of(relative.begin(), relative.end(), [](const auto& step) { return step == ".."; });
}

std::string name_of_buffer(Index buffer) { return fmt::format("buffer {}", buffer); }

}  // namespace

Buffers::Buffers(const FileBytes& file, Document& document)
    : file_(file), document_(document), sources_(document.buffers.size()) {}

std::string_view Buffers::from_uri(Index buffer, const std::string& part) {
  std::string& uri = *document_.buffers[buffer].uri;
  Source& source = sources_[buffer];
  if (uri.starts_with(kData)) {
    const std::size_t comma = uri.find(',');
    if (comma == uri.npos || !uri.substr(0, comma + 1).ends_with(kBase64))
      throw bad_part(file_, part, "data in the file is not base64");
    if (!decode_base64(std::string_view(uri).substr(comma + 1), source.decoded))
      throw bad_part(file_, part, "data in the file is damaged base64");
    std::string().swap(uri);
    return source.decoded;
  }
  const std::string path = percent_decoded(uri);
  if (!stays_below(path))
    throw bad_part(
        file_, part,
        fmt::format("'{}' is no file beside this one or in a folder there; only such are opened", shown(uri)));
  const std::filesystem::path beside = std::filesystem::path(file_.name()).parent_path() / path;
  // A link may lead out of the folder just as ".." would.
  std::error_code error;
  const auto real = std::filesystem::weakly_canonical(beside, error);
  const auto folder = std::filesystem::weakly_canonical(std::filesystem::path(file_.name()).parent_path() / ".", error);
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), real.begin(), real.end());
  if (error || (end != folder.end() && !end->empty()))
    throw bad_part(file_, part, fmt::format("'{}' leads out of the file's folder", shown(uri)));
  if (!std::filesystem::is_regular_file(beside, error))
    throw bad_part(file_, part, fmt::format("there is no file '{}' beside this one, which it needs", shown(uri)));
  source.file = std::make_unique<FileBytes>(beside);
  return source.file->text();
}

std::string_view Buffers::buffer(Index buffer) {
  const std::string part = name_of_buffer(buffer);
  if (buffer >= sources_.size()) throw bad_part(file_, part, "there is no such buffer");
  Source& source = sources_[buffer];
  if (source.known) return source.bytes;
  const Buffer& wanted = document_.buffers[buffer];
  if (wanted.uri)
    source.bytes = from_uri(buffer, part);
  else if (buffer == 0)
    source.bytes = document_.binary;
  else
    throw bad_part(file_, part, "the buffer has no data");
  if (wanted.length > source.bytes.size())
    throw bad_part(
        file_, part,
        fmt::format("the data is cut off: {} bytes announced, {} there", wanted.length, source.bytes.size()));
  source.bytes = source.bytes.substr(0, wanted.length);
  source.known = true;
  return source.bytes;
}

std::size_t Buffers::bytes_beside() const {
  std::size_t bytes = 0;
  for (const Source& source : sources_)
    if (source.file) bytes += source.file->text().size();
  return bytes;
}

std::string_view Buffers::view(Index index) {
  const std::string part = fmt::format("buffer view {}", index);
  if (index >= document_.views.size()) throw bad_part(file_, part, "there is no such buffer view");
  const BufferView& view = document_.views[index];
  if (view.compressed && view.buffer < document_.buffers.size() && !document_.buffers[view.buffer].uri)
    throw bad_part(file_, part,
                   "the data is compressed by EXT_meshopt_compression, which is not read; save it without");
  const std::string_view bytes = buffer(view.buffer);
  if (view.offset > bytes.size() || view.length > bytes.size() - view.offset)
    throw bad_part(
        file_, part,
        fmt::format("bytes {} to {} of a buffer of {}", view.offset, view.offset + view.length, bytes.size()));
  return bytes.substr(view.offset, view.length);
}

}  // namespace ramcdb::mesh_file::gltf
