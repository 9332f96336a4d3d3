#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "api/mesh_file/attribute_names.h"
#include "api/mesh_file/gltf_buffers.h"

namespace ramcdb::mesh_file::gltf {
namespace {

std::string name_of(Index accessor) { return fmt::format("accessor {}", accessor); }

template <class T>
T load(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// Calls visit(T{}) with the type.
template <class Visit>
void with_type(NumberType type, Visit visit) {
  switch (type) {
    case NumberType::int8:
      return visit(std::int8_t{});
    case NumberType::uint8:
      return visit(std::uint8_t{});
    case NumberType::int16:
      return visit(std::int16_t{});
    case NumberType::uint16:
      return visit(std::uint16_t{});
    case NumberType::int32:
      return visit(std::int32_t{});
    case NumberType::uint32:
      return visit(std::uint32_t{});
    case NumberType::float32:
      return visit(float{});
    case NumberType::float64:
      return visit(double{});
  }
}

/// The loops over values, with the number of components and the distance known where they are the usual ones.
template <class T, std::size_t n>
void copy_fixed(const Strided& from, double* to) {
  for (std::size_t i = 0; i < from.count; ++i)
    for (std::size_t c = 0; c < n; ++c)
      to[i * n + c] = static_cast<double>(load<T>(from.at + i * from.stride + c * sizeof(T)));
}

template <class T>
void copy_values(const Strided& from, std::size_t components, double* to) {
  if (from.stride == components * sizeof(T)) {
    for (std::size_t i = 0; i < from.count * components; ++i)
      to[i] = static_cast<double>(load<T>(from.at + i * sizeof(T)));
    return;
  }
  if (components == 2) return copy_fixed<T, 2>(from, to);
  if (components == 3) return copy_fixed<T, 3>(from, to);
  if (components == 4) return copy_fixed<T, 4>(from, to);
  for (std::size_t i = 0; i < from.count; ++i)
    for (std::size_t c = 0; c < components; ++c)
      to[i * components + c] = static_cast<double>(load<T>(from.at + i * from.stride + c * sizeof(T)));
}

void copy_numbers(const Strided& from, NumberType type, std::size_t components, double* to) {
  if (!from.at) {
    std::fill_n(to, from.count * components, 0.0);
    return;
  }
  with_type(type, [&](auto number) { copy_values<decltype(number)>(from, components, to); });
}

}  // namespace

double unit_number(double value, NumberType type) {
  if (is_float(type) || type == NumberType::uint32 || type == NumberType::int32) return value;
  return std::max(value / range_of(type).most, -1.0);
}

Strided Accessors::inside(std::string_view bytes, std::size_t offset, std::size_t count, std::size_t size,
                          std::size_t stride, std::string_view part) const {
  if (count == 0) return {bytes.data(), size, 0};
  const auto refuse = [&] {
    return bad_part(file_, part,
                    fmt::format("{} values of {} bytes do not fit into the {} bytes of their buffer view", count, size,
                                bytes.size()));
  };
  if (stride == 0) stride = size;
  if (stride < size) throw bad_part(file_, part, fmt::format("values of {} bytes stand {} bytes apart", size, stride));
  if (offset > bytes.size() || size > bytes.size() - offset) throw refuse();
  if (count - 1 > (bytes.size() - offset - size) / stride) throw refuse();
  return {bytes.data() + offset, stride, count};
}

Strided Accessors::dense(Index index) {
  const Accessor& accessor = document_.accessors[index];
  if (!accessor.view) return {nullptr, 0, accessor.count};
  const std::size_t size = size_of(*accessor.type) * accessor.components;
  const std::string_view bytes = buffers_.view(*accessor.view);
  return inside(bytes, accessor.offset, accessor.count, size, document_.views[*accessor.view].stride, name_of(index));
}

void Accessors::check_sparse(Index index, const Sparse& sparse) {
  const Accessor& accessor = document_.accessors[index];
  const std::string part = name_of(index) + " sparse";
  const bool known = sparse.indices_type == NumberType::uint8 || sparse.indices_type == NumberType::uint16 ||
                     sparse.indices_type == NumberType::uint32;
  if (!known) throw bad_part(file_, part, "the type of its indices is none for indices");
  if (sparse.count > accessor.count)
    throw bad_part(file_, part, fmt::format("{} values for {} places", sparse.count, accessor.count));
  (void)inside(buffers_.view(sparse.indices_view), sparse.indices_offset, sparse.count, size_of(*sparse.indices_type),
               0, part);
  (void)inside(buffers_.view(sparse.values_view), sparse.values_offset, sparse.count,
               size_of(*accessor.type) * accessor.components, 0, part);
}

const Accessor& Accessors::checked(Index index) {
  if (index >= document_.accessors.size()) throw bad_part(file_, name_of(index), "there is no such accessor");
  const Accessor& accessor = document_.accessors[index];
  if (!accessor.type || accessor.components == 0)
    throw bad_part(file_, name_of(index), "its 'componentType' or 'type' is not one of glTF 2.0");
  // Columns of such matrices begin at multiples of four bytes.
  if (accessor.is_matrix && accessor.type != NumberType::float32)
    throw bad_part(file_, name_of(index), "matrices of integers are not read");
  (void)dense(index);
  if (accessor.sparse) check_sparse(index, *accessor.sparse);
  return accessor;
}

std::vector<std::uint32_t> Accessors::sparse_places(Index index) {
  const Accessor& accessor = document_.accessors[index];
  const Sparse& sparse = *accessor.sparse;
  const Strided from = inside(buffers_.view(sparse.indices_view), sparse.indices_offset, sparse.count,
                              size_of(*sparse.indices_type), 0, name_of(index));
  std::vector<std::uint32_t> places(sparse.count);
  with_type(*sparse.indices_type, [&](auto number) {
    for (std::size_t i = 0; i < places.size(); ++i)
      places[i] = static_cast<std::uint32_t>(load<decltype(number)>(from.at + i * from.stride));
  });
  for (const std::uint32_t place : places)
    if (place >= accessor.count)
      throw bad_part(file_, name_of(index),
                     fmt::format("a sparse value stands at {}, there are {}", place, accessor.count));
  return places;
}

void Accessors::read(Index index, bool unit, double* to) {
  const Accessor& accessor = document_.accessors[index];
  const std::size_t n = accessor.components;
  copy_numbers(dense(index), *accessor.type, n, to);
  if (accessor.sparse) {
    const auto places = sparse_places(index);
    const Strided from = inside(buffers_.view(accessor.sparse->values_view), accessor.sparse->values_offset,
                                places.size(), size_of(*accessor.type) * n, 0, name_of(index));
    std::vector<double> values(places.size() * n);
    copy_numbers(from, *accessor.type, n, values.data());
    for (std::size_t i = 0; i < places.size(); ++i)
      std::copy_n(values.data() + i * n, n, to + std::size_t{places[i]} * n);
  }
  if (unit && accessor.normalized)
    for (std::size_t i = 0; i < accessor.count * n; ++i) to[i] = unit_number(to[i], *accessor.type);
}

void Accessors::read_points(Index index, Point* to) {
  static_assert(sizeof(Point) == 3 * sizeof(double));
  read(index, true, reinterpret_cast<double*>(to));  // null where there are none
}

std::vector<std::uint32_t> Accessors::indices(Index index, std::size_t vertices, std::string_view where) {
  const Accessor& accessor = checked(index);
  const bool known =
      accessor.type == NumberType::uint8 || accessor.type == NumberType::uint16 || accessor.type == NumberType::uint32;
  if (!known || accessor.components != 1 || accessor.sparse)
    throw bad_part(file_, where, fmt::format("its indices, accessor {}, are of no type for indices", index));
  std::vector<std::uint32_t> indices(accessor.count);
  const Strided from = dense(index);
  std::uint32_t largest = 0;
  if (from.at)
    with_type(*accessor.type, [&](auto number) {
      using T = decltype(number);
      if (from.stride == sizeof(T))
        for (std::size_t i = 0; i < indices.size(); ++i)
          indices[i] = static_cast<std::uint32_t>(load<T>(from.at + i * sizeof(T)));
      else
        for (std::size_t i = 0; i < indices.size(); ++i)
          indices[i] = static_cast<std::uint32_t>(load<T>(from.at + i * from.stride));
      for (const std::uint32_t i : indices) largest = std::max(largest, i);
    });
  if (!indices.empty() && largest >= vertices)
    throw bad_part(file_, where, fmt::format("vertex index {} does not exist ({} vertices)", largest, vertices));
  return indices;
}

}  // namespace ramcdb::mesh_file::gltf
