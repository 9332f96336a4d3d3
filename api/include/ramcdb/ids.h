#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace ramcdb {

/// A number with a meaning. Ids of different kinds do not mix. Valid ids start at 1; 0 says "none".
template <class Tag>
struct Id {
  std::uint32_t value = 0;

  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t v) : value(v) {}
  constexpr explicit operator bool() const { return value != 0; }
  friend constexpr auto operator<=>(Id, Id) = default;
};

using MeshId = Id<struct MeshTag>;        ///< a mesh of the repository; fits 16 bits
using ChartId = Id<struct ChartTag>;      ///< a chart of one mesh, never used twice
using WireId = Id<struct WireTag>;        ///< a wire of one mesh, never used twice
using CornerId = Id<struct CornerTag>;    ///< a corner of one mesh, never used twice
using PageId = Id<struct PageTag>;        ///< an index page of one mesh, never used twice
using TableId = Id<struct TableTag>;      ///< a coder table of one mesh, never used twice
using VersionId = Id<struct VersionTag>;  ///< a published version of the whole repository

}  // namespace ramcdb

template <class Tag>
struct std::hash<ramcdb::Id<Tag>> {
  std::size_t operator()(ramcdb::Id<Tag> id) const noexcept { return std::hash<std::uint32_t>{}(id.value); }
};
