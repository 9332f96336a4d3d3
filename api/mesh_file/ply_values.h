#pragma once

#include <algorithm>
#include <bit>
#include <cstring>

#include "api/mesh_file/ply_header.h"

/// The values of a PLY body one after another, in text and in both byte orders.
namespace ramcdb::mesh_file::ply {

/// Values of a text body.
class AsciiValues {
 public:
  static constexpr bool kBinary = false;

  AsciiValues(const FileBytes& file, const Header& header, const Progress& progress)
      : scan_(file, header.size, header.lines, progress) {}

  /// A coordinate: finite, and the nearest double, whatever its type.
  double number(Type) { return scan_.number_anywhere("a value"); }
  /// A number of its type.
  double value(Type type) { return scan_.value_anywhere(type); }
  void values(Type type, std::vector<double>& to) {
    for (double& number : to) number = value(type);
  }
  std::uint64_t whole(Type) {
    const std::int64_t value = scan_.integer_anywhere("a value");
    if (value < 0) refuse(std::to_string(value) + " is negative");
    return static_cast<std::uint64_t>(value);
  }
  void skip(Type, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i)
      if (scan_.word_anywhere().empty()) refuse("the file is cut off");
  }
  [[nodiscard]] std::size_t left_for(Type) const { return scan_.left() / 2 + 1; }
  [[noreturn]] void refuse(std::string_view what) const { throw scan_.bad(what); }
  [[nodiscard]] bool at_end() { return scan_.word_anywhere().empty(); }

 private:
  TextScanner scan_;
};

/// Values of a binary body.
template <std::endian order>
class BinaryValues {
 public:
  static constexpr bool kBinary = true;

  BinaryValues(const FileBytes& file, const Header& header) : file_(file), at_(header.size) {}

  double number(Type type) {
    double number = 0;
    column(take(size_of(type)), 0, 1, type, [&](std::size_t, double value) { number = value; });
    return number;
  }
  double value(Type type) { return number(type); }
  void values(Type type, std::vector<double>& to) {
    column(take(to.size() * size_of(type)), size_of(type), to.size(), type,
           [&](std::size_t i, double value) { to[i] = value; });
  }
  /// The numbers of one property of `count` elements of `stride` bytes each: store(i, number).
  template <class Store>
  static void column(const char* p, std::size_t stride, std::size_t count, Type type, Store store) {
    switch (type) {
      case Type::float32:
        return column_of<float>(p, stride, count, store);
      case Type::float64:
        return column_of<double>(p, stride, count, store);
      case Type::int8:
        return column_of<std::int8_t>(p, stride, count, store);
      case Type::uint8:
        return column_of<std::uint8_t>(p, stride, count, store);
      case Type::int16:
        return column_of<std::int16_t>(p, stride, count, store);
      case Type::uint16:
        return column_of<std::uint16_t>(p, stride, count, store);
      case Type::int32:
        return column_of<std::int32_t>(p, stride, count, store);
      case Type::uint32:
        return column_of<std::uint32_t>(p, stride, count, store);
    }
  }
  std::uint64_t whole(Type type) {
    const char* p = take(size_of(type));
    switch (type) {  // the two that nearly all files have, first
      case Type::uint8:
        return load<std::uint8_t>(p);
      case Type::int32:
        return not_negative(load<std::int32_t>(p));
      case Type::int8:
        return not_negative(load<std::int8_t>(p));
      case Type::int16:
        return not_negative(load<std::int16_t>(p));
      case Type::uint16:
        return load<std::uint16_t>(p);
      case Type::uint32:
        return load<std::uint32_t>(p);
      case Type::float32:
      case Type::float64:
        break;
    }
    refuse("a number that must be whole is none");
  }
  void skip(Type type, std::uint64_t count) {
    if (count > left_for(type)) refuse("the file is cut off");
    at_ += static_cast<std::size_t>(count) * size_of(type);
  }
  [[nodiscard]] std::size_t left_for(Type type) const { return (file_.text().size() - at_) / size_of(type); }
  [[noreturn]] void refuse(std::string_view what) const { throw bad_byte(file_, at_, what); }
  [[nodiscard]] bool at_end() const { return at_ == file_.text().size(); }

  /// The bytes of `count` elements of `bytes` each.
  const char* rows(std::size_t count, std::size_t bytes) { return take(count * bytes); }
  /// The common case of a list: reads `count` indices of 32 bits and is true, or takes nothing and is false when they
  /// are of another type or one is not below `limit`. The file must have room for them.
  bool indices(Type type, std::size_t count, std::uint64_t limit, std::vector<std::uint32_t>& to) {
    if (type != Type::int32 && type != Type::uint32) return false;
    const char* p = file_.text().data() + at_;
    if (count == 3) {
      const std::uint32_t v[3] = {load<std::uint32_t>(p), load<std::uint32_t>(p + 4), load<std::uint32_t>(p + 8)};
      if (v[0] >= limit || v[1] >= limit || v[2] >= limit) return false;
      to.insert(to.end(), v, v + 3);
      at_ += sizeof v;
      return true;
    }
    const std::size_t before = to.size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto v = load<std::uint32_t>(p + 4 * i);
      if (v >= limit) {
        to.resize(before);
        return false;
      }
      to.push_back(v);
    }
    at_ += 4 * count;
    return true;
  }

 private:
  std::uint64_t not_negative(std::int64_t value) const {
    if (value < 0) refuse(std::to_string(value) + " is negative");
    return static_cast<std::uint64_t>(value);
  }
  const char* take(std::size_t bytes) {
    if (bytes > file_.text().size() - at_) refuse("the file is cut off");
    at_ += bytes;
    return file_.text().data() + at_ - bytes;
  }
  template <class T, class Store>
  static void column_of(const char* p, std::size_t stride, std::size_t count, const Store& store) {
    for (std::size_t i = 0; i < count; ++i) store(i, static_cast<double>(load<T>(p + i * stride)));
  }
  template <class T>
  static T load(const char* p) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, p, sizeof(T));
    if constexpr (order != std::endian::native) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  const FileBytes& file_;
  std::size_t at_;
};

}  // namespace ramcdb::mesh_file::ply
