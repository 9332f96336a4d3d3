#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "ramcdb/chart.h"
#include "ramcdb/geometry.h"
#include "ramcdb/ids.h"

/// The wire-net in pages: the index of a mesh (paper, section 3; how versions hang on it: db/FORMAT.md).
///
/// A leaf page holds some neighbouring charts and is self-contained: every wire that one of its charts passes, and
/// every corner such a wire ends in, stands in it, also when a neighbouring page holds the chart on the other side and
/// so holds them too. Reading a chart therefore takes its pages from the root down and nothing beside them.
namespace ramcdb {

/// Where the current blob of one attribute layer of a chart was written.
struct LayerRef {
  std::uint16_t layer = 0;
  VersionId version;

  friend bool operator==(const LayerRef&, const LayerRef&) = default;
};

/// How the faces of a chart hang together by vertices of the chart, several of which may be one vertex of the mesh: the
/// corners and wires around a chart tell of that.
struct ChartPieces {
  std::vector<std::uint32_t> of_loop;  ///< per loop its piece; pieces are numbered as loops first name them
  std::uint32_t closed = 0;            ///< pieces without a loop

  friend bool operator==(const ChartPieces&, const ChartPieces&) = default;
};

struct PageChart {
  ChartId id;
  VersionId version;  ///< the version that wrote the chart's geometry blob
  TableId table;      ///< the coder table its blob needs; 0: the built-in one
  std::uint32_t faces = 0;
  std::uint32_t inner_vertices = 0;
  LatticeBox box;  ///< exact box of all its vertices, border included
  std::vector<WireLoop> loops;
  std::vector<LayerRef> layers;  ///< ascending by layer
  ChartPieces pieces;

  friend bool operator==(const PageChart&, const PageChart&) = default;
};

struct PageWire {
  WireId id;
  VersionId version;  ///< the version that wrote the blob with its points; a wire without inner points has none
  WireId group;       ///< whose id that blob's key has: the first wire in it; its own without inner points
  CornerId begin, end;
  std::uint32_t inner_points = 0;
  /// The charts that pass it, ascending, a chart once per pass: two as a rule, one on the mesh's own border, more along
  /// a non-manifold edge.
  std::vector<ChartId> charts;

  friend bool operator==(const PageWire&, const PageWire&) = default;
};

struct PageCorner {
  CornerId id;
  LatticePoint position;

  friend bool operator==(const PageCorner&, const PageCorner&) = default;
};

/// Charts, wires and corners each ascending by id.
struct LeafPage {
  std::vector<PageChart> charts;
  std::vector<PageWire> wires;
  std::vector<PageCorner> corners;

  friend bool operator==(const LeafPage&, const LeafPage&) = default;
};

/// Ids first .. first + count - 1.
struct ChartRun {
  ChartId first;
  std::uint32_t count = 0;

  friend bool operator==(const ChartRun&, const ChartRun&) = default;
};

/// What an inner page knows of a page below it.
struct PageEntry {
  PageId id;
  VersionId version;  ///< the version that wrote that page
  LatticeBox box;     ///< of everything below
  std::uint64_t faces = 0;
  std::vector<ChartRun> charts;  ///< ascending, no two runs touch

  friend bool operator==(const PageEntry&, const PageEntry&) = default;
};

struct InnerPage {
  std::vector<PageEntry> pages;

  friend bool operator==(const InnerPage&, const InnerPage&) = default;
};

using Page = std::variant<LeafPage, InnerPage>;

}  // namespace ramcdb
