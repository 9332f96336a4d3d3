#include "db/key_list.h"

#include "ramcdb/error.h"

namespace ramcdb::db {
namespace {

void put_varint(Buffer& out, std::uint32_t value) {
  for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 0x80));
  out.push_back(static_cast<std::uint8_t>(value));
}

class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(bytes) {}

  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

  std::uint32_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      if (at_end()) break;
      const std::uint8_t byte = bytes_[at_++];
      value |= static_cast<std::uint64_t>(byte & 0x7F) << shift;
      if (byte < 0x80 && value <= ~std::uint32_t{0}) return static_cast<std::uint32_t>(value);
    }
    throw Error(Errc::corrupt, "a pending list is damaged", {}, "run `ramcdb verify`");
  }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

bool same_run(const BlobKey& a, const BlobKey& b) {
  return a.kind == b.kind && a.mesh == b.mesh && a.layer == b.layer && a.id <= b.id;
}

}  // namespace

Buffer encode_key_list(const std::vector<BlobKey>& keys) {
  Buffer out;
  for (std::size_t begin = 0, end; begin < keys.size(); begin = end) {
    for (end = begin + 1; end < keys.size() && same_run(keys[end - 1], keys[end]);) ++end;
    put_varint(out, static_cast<std::uint32_t>(keys[begin].kind));
    put_varint(out, keys[begin].mesh.value);
    put_varint(out, keys[begin].layer);
    put_varint(out, static_cast<std::uint32_t>(end - begin));
    std::uint32_t before = 0;
    for (std::size_t i = begin; i < end; ++i) {
      put_varint(out, keys[i].id - before);
      before = keys[i].id;
    }
  }
  return out;
}

std::vector<BlobKey> decode_key_list(Bytes bytes, VersionId version) {
  std::vector<BlobKey> keys;
  Reader in(bytes);
  while (!in.at_end()) {
    BlobKey key;
    key.kind = static_cast<Kind>(in.varint());
    key.mesh = MeshId(in.varint());
    key.layer = static_cast<std::uint16_t>(in.varint());
    key.version = version;
    for (std::uint32_t left = in.varint(); left > 0; --left) {
      key.id += in.varint();
      keys.push_back(key);
    }
  }
  return keys;
}

}  // namespace ramcdb::db
