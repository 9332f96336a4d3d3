#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

/// Base64, RFC 4648, as in data URIs.
namespace ramcdb::mesh_file::gltf {

/// Puts text block by block.
class Base64Encoder {
 public:
  explicit Base64Encoder(std::function<void(std::string_view)> put) : put_(std::move(put)) {}

  void add(std::string_view bytes);
  void end();

 private:
  void add_digits(std::size_t digits);

  std::function<void(std::string_view)> put_;
  std::string text_;
  std::uint32_t bits_ = 0;
  std::size_t pending_ = 0;  ///< bytes in bits_
};

/// False where the text is no base64. Digits for URIs are taken too, and missing padding.
[[nodiscard]] bool decode_base64(std::string_view text, std::string& bytes);

}  // namespace ramcdb::mesh_file::gltf
