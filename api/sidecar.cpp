#include "api/sidecar.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "api/chart_text.h"
#include "ramcdb/error.h"
#include "ramcdb/region.h"

namespace ramcdb::detail {
namespace {

using nlohmann::ordered_json;

constexpr int kSidecarFormat = 1;
constexpr std::uintmax_t kMostBytes = 64 << 20;

/// Bytes to a temporary file beside `path`, then into its place.
void replace_file(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::path temporary = path;
  temporary += ".tmp";
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(temporary, path, error);
  if (!out || error) {
    std::filesystem::remove(temporary, error);
    throw Error(Errc::storage, "cannot write the sidecar", path.string(), "check the folder's permissions and space");
  }
}

Sidecar parse(const std::string& text, const std::filesystem::path& folder) {
  const auto j = ordered_json::parse(text);
  if (j.at("format") != "ramcdb-checkout" || j.at("format_version") != kSidecarFormat)
    throw Error(Errc::unsupported_version, "the sidecar has an unknown format");
  Sidecar s;
  s.repository_id = j.at("repository").at("id").get<std::string>();
  const std::filesystem::path relative = folder / j.at("repository").at("relative").get<std::string>();
  std::error_code ignored;
  s.repository = std::filesystem::exists(relative, ignored)
                     ? relative
                     : std::filesystem::path(j.at("repository").at("path").get<std::string>());
  s.mesh = j.at("mesh").get<std::string>();
  for (const auto& part : j.at("parts"))
    s.parts.push_back({VersionId(part.at("version").get<std::uint32_t>()),
                       parse_charts(part.at("charts").get<std::string>()).charts});
  s.ids_version = VersionId(j.at("ids_version").get<std::uint32_t>());
  for (int a = 0; a < 3; ++a) s.local_origin[a] = j.at("local_origin").at(static_cast<std::size_t>(a)).get<double>();
  s.file_hash = j.at("file_hash").get<std::string>();
  s.nonce = j.at("nonce").get<std::string>();
  s.lock = j.at("lock").get<std::uint32_t>();
  s.painted = j.at("painted").get<bool>();
  if (s.parts.empty()) throw Error(Errc::invalid_argument, "the sidecar names no charts");
  return s;
}

}  // namespace

std::filesystem::path sidecar_path(const std::filesystem::path& file) {
  std::filesystem::path path = file;
  path += ".ramcdb.json";
  return path;
}

void write_sidecar(const std::filesystem::path& file, const Sidecar& sidecar) {
  const auto folder = std::filesystem::absolute(file).parent_path();
  const auto repository = std::filesystem::canonical(sidecar.repository);
  ordered_json j;
  j["format"] = "ramcdb-checkout";
  j["format_version"] = kSidecarFormat;
  j["repository"] = {{"id", sidecar.repository_id},
                     {"relative", std::filesystem::proximate(repository, std::filesystem::canonical(folder)).string()},
                     {"path", repository.string()}};
  j["mesh"] = sidecar.mesh;
  j["parts"] = ordered_json::array();
  for (const auto& part : sidecar.parts)
    j["parts"].push_back({{"version", part.version.value}, {"charts", chart_text(part.charts)}});
  j["ids_version"] = sidecar.ids_version.value;
  j["local_origin"] = {sidecar.local_origin.x, sidecar.local_origin.y, sidecar.local_origin.z};
  j["file_hash"] = sidecar.file_hash;
  j["nonce"] = sidecar.nonce;
  j["lock"] = sidecar.lock;
  j["painted"] = sidecar.painted;
  replace_file(sidecar_path(file), j.dump(2) + "\n");
}

Sidecar read_sidecar(const std::filesystem::path& file) {
  const std::filesystem::path path = sidecar_path(file);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error)
    throw Error(Errc::not_found, "this file has no sidecar", path.string(),
                "keep FILE.ramcdb.json beside the file that `ramcdb checkout` wrote, or check out again");
  if (size > kMostBytes) throw Error(Errc::invalid_argument, "the sidecar is too large", path.string());
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  try {
    return parse(text, std::filesystem::absolute(file).parent_path());
  } catch (const nlohmann::json::exception&) {
    throw Error(Errc::invalid_argument, "the sidecar cannot be read", path.string(), "check out again");
  } catch (const Error& e) {
    throw Error(e.code(), e.what(), path.string(), "check out again");
  }
}

std::string hash_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(Errc::not_found, "cannot read the file", file.string(), "check the path");
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  std::array<char, 1 << 16> block;
  while (in.read(block.data(), block.size()) || in.gcount() > 0)
    XXH3_64bits_update(&state, block.data(), static_cast<std::size_t>(in.gcount()));
  return fmt::format("{:016x}", XXH3_64bits_digest(&state));
}

}  // namespace ramcdb::detail
