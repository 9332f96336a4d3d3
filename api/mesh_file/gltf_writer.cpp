#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "api/mesh_file/gltf_base64.h"
#include "api/mesh_file/gltf_plan.h"

/// glTF 2.0, written as gltf_container.cpp reads it: a .glb with its buffer as second chunk, a .gltf with it as base64.
namespace ramcdb::mesh_file {
namespace gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "byte order of GLB readers and writers");

std::size_t padded(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

/// The buffer's bytes, in blocks.
class BufferWriter {
 public:
  explicit BufferWriter(const Plan& plan) : plan_(plan) {}

  template <class Put>
  void run(Put put) const {
    write_rows(plan_.vertices.count, 12, put, [&](std::size_t i, char* to) {
      for (int a = 0; a < 3; ++a) store(plan_.coordinate(i, a), to + 4 * a);
    });
    for (const OutColumn& column : plan_.columns.all()) write_column(column, put);
    write_indices(put);
  }

 private:
  template <class T>
  static void store(T value, char* to) {
    std::memcpy(to, &value, sizeof value);
  }

  /// Rows of `size` bytes, zero where row(i, to) leaves them.
  template <class Put, class Row>
  static void write_rows(std::size_t count, std::size_t size, Put put, Row row) {
    constexpr std::size_t kRows = 2048;
    std::vector<char> block(kRows * size);
    for (std::size_t begin = 0; begin < count; begin += kRows) {
      const std::size_t rows = std::min(kRows, count - begin);
      for (std::size_t i = 0; i < rows; ++i) row(begin + i, block.data() + i * size);
      put(std::string_view(block.data(), rows * size));
    }
  }

  template <class Put>
  void write_column(const OutColumn& column, Put put) const {
    if (!column.attribute) {
      return write_rows(plan_.vertices.count, 8, put,
                        [&](std::size_t i, char* to) { store(plan_.mesh.vertex_ids[plan_.vertices.vertex(i)], to); });
    }
    const auto write = [&](auto number) {
      using T = decltype(number);
      write_rows(plan_.vertices.count, column.stride(), put, [&](std::size_t i, char* to) {
        for (std::size_t c = 0; c < column.components; ++c) {
          const double value = number_at(column, plan_.vertices, i, c);
          store(std::isfinite(value) ? static_cast<T>(value) : T{}, to + c * sizeof(T));
        }
      });
    };
    switch (column.type) {
      case NumberType::int8:
        return write(std::int8_t{});
      case NumberType::uint8:
        return write(std::uint8_t{});
      case NumberType::int16:
        return write(std::int16_t{});
      case NumberType::uint16:
        return write(std::uint16_t{});
      default:
        return write(float{});
    }
  }

  template <class Put>
  void write_indices(Put put) const {
    for (const Object& object : plan_.groups.objects) {
      const std::size_t first = 3 * object.parts.front().first;
      const std::size_t count = 3 * (object.parts.back().first + object.parts.back().count) - first;
      const std::uint32_t* indices = plan_.groups.triangles.data() + first;
      const auto base = static_cast<std::uint32_t>(object.first);
      const auto write = [&](auto number) {
        using T = decltype(number);
        write_rows(count, sizeof(T), put,
                   [&](std::size_t i, char* to) { store(static_cast<T>(indices[i] - base), to); });
      };
      plan_.index_type == NumberType::uint16 ? write(std::uint16_t{}) : write(std::uint32_t{});
    }
  }

  const Plan& plan_;
};

}  // namespace
}  // namespace gltf

void write_glb(NewFile& out, const std::filesystem::path& file, const MeshOutput& mesh, DroppedCounter& dropped) {
  using namespace gltf;
  const Plan plan(file, mesh, dropped);
  const std::string json = compose_json(plan, false, dropped);
  const std::size_t json_length = padded(json.size()), binary_length = padded(plan.length);
  const std::size_t length = 12 + 8 + json_length + 8 + binary_length;
  if (length > 0xffffffffU)
    throw Error(Errc::limit_exceeded, fmt::format("a .glb of {} bytes: it can have 2^32 - 1", length), file.string(),
                "write .gltf or .ply; nothing was written");
  out.text("glTF");
  out.binary(std::uint32_t{2});
  out.binary(static_cast<std::uint32_t>(length));
  out.binary(static_cast<std::uint32_t>(json_length));
  out.text("JSON");
  out.text(json);
  out.text(std::string(json_length - json.size(), ' '));
  out.binary(static_cast<std::uint32_t>(binary_length));
  out.text({"BIN\0", 4});
  BufferWriter(plan).run([&](std::string_view bytes) { out.text(bytes); });
  out.text(std::string(binary_length - plan.length, '\0'));
}

void write_gltf(NewFile& out, const std::filesystem::path& file, const MeshOutput& mesh, DroppedCounter& dropped) {
  using namespace gltf;
  const Plan plan(file, mesh, dropped);
  const std::string json = compose_json(plan, true, dropped);
  const std::size_t at = json.find(kDataUri) + kDataUri.size();  // the first one: no name stands before it
  out.text(std::string_view(json).substr(0, at));
  Base64Encoder base64([&](std::string_view text) { out.text(text); });
  BufferWriter(plan).run([&](std::string_view bytes) { base64.add(bytes); });
  base64.end();
  out.text(std::string_view(json).substr(at));
  out.text("\n");
}

}  // namespace ramcdb::mesh_file
