#include "api/mesh_file/file_bytes.h"

#include <fast_float/fast_float.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "api/mesh_file/attribute_names.h"

namespace ramcdb::mesh_file {
namespace {

constexpr std::string_view kRest = "things of other names";
constexpr std::string_view kHowToGoOn = "repair or convert the file; nothing was imported";

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// The first character of a number that the parsers take: they know no plus sign.
const char* behind_plus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return text.data() + (plus ? 1 : 0);
}

bool has_digit(std::string_view text) { return text.find_first_of("0123456789") != text.npos; }

/// The nearest float; infinite only where the text says so.
template <class Float>
Float parse_float(const TextScanner& scan, std::string_view text) {
  if (text.empty()) throw scan.bad("a value is missing");
  Float value = 0;
  const auto [end, error] = fast_float::from_chars(behind_plus(text), text.data() + text.size(), value);
  if (end != text.data() + text.size()) throw scan.bad(fmt::format("a value is no number: '{}'", shown(text)));
  if (!std::isfinite(value) && has_digit(text))
    throw scan.bad(fmt::format("a value is too large for its type: '{}'", shown(text)));
  if (error != std::errc() && error != std::errc::result_out_of_range)
    throw scan.bad(fmt::format("a value is no number: '{}'", shown(text)));
  return value;
}

}  // namespace

FileBytes::FileBytes(const std::filesystem::path& file) : name_(file.string()) {
  const int descriptor = ::open(name_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    throw Error(errno == ENOENT ? Errc::not_found : Errc::storage,
                fmt::format("cannot open the file: {}", std::strerror(errno)), name_,
                "check the path and its permissions");
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    throw Error(Errc::invalid_argument, "this is not a regular file", name_, "name a mesh file");
  }
  size_ = static_cast<std::size_t>(status.st_size);
  void* mapped = size_ ? ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0) : nullptr;
  ::close(descriptor);
  if (mapped == MAP_FAILED)
    throw Error(Errc::storage, fmt::format("cannot read the file: {}", std::strerror(errno)), name_);
  data_ = static_cast<const char*>(mapped);
  mapped_ = mapped != nullptr;
}

FileBytes::~FileBytes() {
  if (mapped_) ::munmap(const_cast<char*>(data_), size_);
}

std::string shown(std::string_view word) {
  constexpr std::size_t kMost = 40;
  std::string text;
  for (const char c : word.substr(0, kMost))
    if (c >= ' ' && c <= '~')
      text += c;
    else
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  return text;
}

Error bad_line(const FileBytes& file, std::size_t line, std::string_view what) {
  return Error(Errc::invalid_argument, what, fmt::format("{}:{}", file.name(), line), kHowToGoOn);
}

Error bad_byte(const FileBytes& file, std::size_t offset, std::string_view what) {
  return Error(Errc::invalid_argument, what, fmt::format("{}, byte {}", file.name(), offset), kHowToGoOn);
}

TextScanner::TextScanner(const FileBytes& file, std::size_t offset, std::size_t lines_before, const Progress& progress)
    : file_(file),
      line_end_(file.text().find('\n') == std::string_view::npos ? '\r' : '\n'),
      at_(offset),
      line_(lines_before),
      progress_(progress) {
  if (at_ == 0 && file.text().substr(0, kByteOrderMark.size()) == kByteOrderMark) at_ = kByteOrderMark.size();
}

bool TextScanner::next_line(bool continued) {
  const std::string_view text = file_.text();
  if (at_ >= text.size()) return false;
  joined_.clear();
  while (true) {
    const std::size_t end = std::min(text.find(line_end_, at_), text.size());
    std::string_view piece = text.substr(at_, end - at_);
    at_ = std::min(end + 1, text.size());
    ++line_;
    if (progress_ && line_ % 65536 == 0) progress_(static_cast<double>(at_) / static_cast<double>(text.size()));
    while (!piece.empty() && is_blank(piece.back())) piece.remove_suffix(1);
    const bool goes_on =
        continued && !piece.empty() && piece.back() == '\\' && at_ < text.size() && !has_comment(piece);
    if (goes_on) piece.remove_suffix(1);
    if (!goes_on && joined_.empty()) {
      rest_ = piece;
      return true;
    }
    joined_.append(piece).push_back(' ');
    if (!goes_on) {
      rest_ = joined_;
      return true;
    }
  }
}

bool TextScanner::has_comment(std::string_view piece) const {
  for (std::size_t i = 0; comment && i < piece.size(); ++i)
    if (piece[i] == comment && (i == 0 || is_blank(piece[i - 1]))) return true;
  return false;
}

std::string_view TextScanner::word() {
  std::size_t begin = 0;
  while (begin < rest_.size() && is_blank(rest_[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest_.size() && !is_blank(rest_[end])) ++end;
  const std::string_view found = rest_.substr(begin, end - begin);
  if (comment && !found.empty() && found.front() == comment) {
    rest_ = {};
    return {};
  }
  rest_.remove_prefix(end);
  return found;
}

std::string_view TextScanner::rest() {
  std::string_view found = rest_;
  rest_ = {};
  while (!found.empty() && is_blank(found.front())) found.remove_prefix(1);
  while (!found.empty() && is_blank(found.back())) found.remove_suffix(1);
  return found;
}

std::string_view TextScanner::word_anywhere() {
  while (true) {
    if (const std::string_view found = word(); !found.empty()) return found;
    if (!next_line()) return {};
  }
}

double TextScanner::parse_number(std::string_view text, std::string_view what) const {
  if (text.empty()) throw bad(fmt::format("{} is missing", what));
  double value = 0;
  const auto [end, error] = fast_float::from_chars(behind_plus(text), text.data() + text.size(), value);
  const bool all = end == text.data() + text.size();
  if (all && !std::isfinite(value) && has_digit(text))
    throw bad(fmt::format("{} is too large: '{}'", what, shown(text)));
  if (error != std::errc() || !all) throw bad(fmt::format("{} is no number: '{}'", what, shown(text)));
  if (!std::isfinite(value)) throw bad(fmt::format("{} is not finite: '{}'", what, shown(text)));
  return value;
}

std::int64_t TextScanner::parse_integer(std::string_view text, std::string_view what) const {
  if (text.empty()) throw bad(fmt::format("{} is missing", what));
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(behind_plus(text), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw bad(fmt::format("{} is no whole number: '{}'", what, shown(text)));
  return value;
}

double TextScanner::parse_value(std::string_view text, NumberType type) const {
  if (type == NumberType::float64) return parse_float<double>(*this, text);
  if (type == NumberType::float32) return static_cast<double>(parse_float<float>(*this, text));
  std::int64_t whole = 0;
  const auto [end, error] = std::from_chars(behind_plus(text), text.data() + text.size(), whole);
  const bool written_whole = error == std::errc() && end == text.data() + text.size() && !text.empty();
  // Some write 255.0 where an integer is to stand.
  const double value = (written_whole ? static_cast<double>(whole) : parse_float<double>(*this, text)) + 0.0;  // no -0
  if (std::isnan(value) || !range_of(type).holds(value))
    throw bad(fmt::format("'{}' is no number of the type of its property", shown(text)));
  return value;
}

double TextScanner::number(std::string_view what) { return parse_number(word(), what); }
double TextScanner::number_anywhere(std::string_view what) { return parse_number(word_anywhere(), what); }
std::int64_t TextScanner::integer(std::string_view what) { return parse_integer(word(), what); }
std::int64_t TextScanner::integer_anywhere(std::string_view what) { return parse_integer(word_anywhere(), what); }

void DroppedCounter::add(std::string_view what, std::uint64_t count) {
  for (auto& dropped : dropped_)
    if (dropped.what == what) {
      dropped.count += count;
      return;
    }
  if (dropped_.size() == kMostNames) what = kRest;
  if (dropped_.size() > kMostNames)
    dropped_.back().count += count;
  else
    dropped_.push_back({std::string(what), count});
}

std::vector<Dropped> DroppedCounter::take() {
  std::erase_if(dropped_, [](const Dropped& dropped) { return dropped.count == 0; });
  return std::move(dropped_);
}

}  // namespace ramcdb::mesh_file
