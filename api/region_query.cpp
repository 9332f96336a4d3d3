#include "api/region_query.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

#include "api/chart_loader.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

/// A box in model units, closed.
struct ModelBox {
  Point lo, hi;
};

ModelBox model_box(const MeshRecord& record, const LatticeBox& box) {
  const auto [lo, hi] = record.bounds(box);
  return {lo, hi};
}

bool meets(const ModelBox& box, const InBox& shape) {
  for (int a = 0; a < 3; ++a)
    if (box.hi[a] < shape.lo[a] || box.lo[a] > shape.hi[a]) return false;
  return true;
}

double squared_distance(const ModelBox& box, const Point& p) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max({box.lo[a] - p[a], 0.0, p[a] - box.hi[a]});
    sum += d * d;
  }
  return sum;
}

bool meets(const ModelBox& box, const InSphere& shape) {
  return squared_distance(box, shape.center) <= shape.radius * shape.radius;
}

/// False only when all eight corners lie outside one and the same clip plane.
bool meets(const ModelBox& box, const InFrustum& shape) {
  const auto row = [&](std::size_t r, const Point& p) {
    return shape.clip[4 * r] * p.x + shape.clip[4 * r + 1] * p.y + shape.clip[4 * r + 2] * p.z + shape.clip[4 * r + 3];
  };
  for (std::size_t plane = 0; plane < 6; ++plane) {
    bool outside = true;
    for (unsigned corner = 0; corner < 8 && outside; ++corner) {
      const Point p{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                    corner & 4 ? box.hi.z : box.lo.z};
      const double value = row(plane / 2, p), w = row(3, p);
      outside = plane % 2 ? value > w : value < -w;
    }
    if (outside) return false;
  }
  return true;
}

bool meets_any(const ModelBox& box, const RegionShape& shape) {
  if (const auto* in_box = std::get_if<InBox>(&shape)) return meets(box, *in_box);
  if (const auto* in_sphere = std::get_if<InSphere>(&shape)) return meets(box, *in_sphere);
  if (const auto* in_frustum = std::get_if<InFrustum>(&shape)) return meets(box, *in_frustum);
  return false;
}

using ChartSet = std::set<ChartId>;

/// Adds the charts whose box `wanted` accepts.
void add_where(const Snapshot::Impl& at, const std::function<bool(const ModelBox&)>& wanted, ChartSet& found,
               ReadCost* cost) {
  const auto accepts = [&](const LatticeBox& box) { return !box.empty() && wanted(model_box(at.record(), box)); };
  at.pages().visit(
      accepts,
      [&](const LeafRef& ref) {
        for (const PageChart& chart : ref.leaf->charts)
          if (accepts(chart.box)) found.insert(chart.id);
      },
      cost);
}

/// Squared distance from `p` to the closest vertex of a chart.
double nearest_vertex(const Snapshot::Impl& at, ChartId chart, const Point& p, ReadCost* cost) {
  ChartLoader loader(at);
  const auto loaded = loader.load(std::span(&chart, 1), 1, cost);
  double best = std::numeric_limits<double>::infinity();
  const LoadedChart& found = loaded.front();
  for (std::size_t v = 0; v < found.chart.positions.size(); ++v) {
    const Point q = found.exact.empty() ? at.record().lattice.position(found.chart.positions[v]) : found.exact[v];
    best = std::min(best, squared_distance({q, q}, p));
  }
  return best;
}

/// Best first through the boxes of pages and charts: decodes only charts whose box is closer than the best vertex yet.
void add_nearest(const Snapshot::Impl& at, const Point& p, ChartSet& found, ReadCost* cost) {
  struct Item {
    double distance;
    ChartId chart;  ///< none for a page
    PageId page;
    VersionId version;
    bool operator>(const Item& other) const {
      return std::tie(distance, chart) > std::tie(other.distance, other.chart);
    }
  };
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  queue.push({0, {}, at.root().root_page, at.root().root_version});
  double best = std::numeric_limits<double>::infinity();
  ChartId nearest;
  const auto push = [&](const LatticeBox& box, ChartId chart, PageId page, VersionId version) {
    if (!box.empty()) queue.push({squared_distance(model_box(at.record(), box), p), chart, page, version});
  };
  while (!queue.empty() && queue.top().distance <= best) {
    const Item item = queue.top();
    queue.pop();
    if (item.chart) {
      const double distance = nearest_vertex(at, item.chart, p, cost);
      if (distance < best || (distance == best && item.chart < nearest)) {
        best = distance;
        nearest = item.chart;
      }
      continue;
    }
    const auto loaded = at.pages().page(item.page, item.version, cost);
    if (const auto* inner = std::get_if<InnerPage>(&*loaded.page))
      for (const PageEntry& e : inner->pages) push(e.box, {}, e.id, e.version);
    else
      for (const PageChart& c : std::get<LeafPage>(*loaded.page).charts) push(c.box, c.id, {}, {});
  }
  if (nearest) found.insert(nearest);
}

void add_named(const Snapshot::Impl& at, const OfCharts& shape, ChartSet& found, ReadCost* cost) {
  for (const ChartId id : shape.charts) {
    if (!at.pages().leaf_of(id, cost))
      throw Error(Errc::not_found, fmt::format("there is no chart {}", id.value),
                  fmt::format("mesh {}, version {}", at.root().name, at.version().value),
                  "`ramcdb charts REPO --all` lists them");
    found.insert(id);
  }
}

void add_shape(const Snapshot::Impl& at, const RegionShape& shape, ChartSet& found, ReadCost* cost) {
  if (const auto* named = std::get_if<OfCharts>(&shape)) {
    add_named(at, *named, found, cost);
  } else if (const auto* near = std::get_if<NearestTo>(&shape)) {
    add_nearest(at, near->point, found, cost);
  } else if (std::holds_alternative<WholeMesh>(shape)) {
    add_where(
        at, [](const ModelBox&) { return true; }, found, cost);
  } else {
    add_where(
        at, [&](const ModelBox& box) { return meets_any(box, shape); }, found, cost);
  }
}

/// Points, to be asked whether a box holds any of them.
class PlacesInBox {
 public:
  explicit PlacesInBox(const CornerPlaces& corners) {
    for (const auto& [id, position] : corners) sorted_.push_back(position);
    std::ranges::sort(sorted_);
  }
  [[nodiscard]] bool any(const LatticeBox& box) const {
    if (box.empty()) return false;
    for (auto p = std::ranges::lower_bound(sorted_, box.lo.x, {}, &LatticePoint::x);
         p != sorted_.end() && p->x <= box.hi.x; ++p)
      if (box.contains(*p)) return true;
    return false;
  }

 private:
  std::vector<LatticePoint> sorted_;  ///< by x first
};

/// One ring: every chart that shares a wire or a corner with one of `found`.
ChartSet ring_of(const Snapshot::Impl& at, const ChartSet& found, ReadCost* cost) {
  ChartSet grown = found;
  CornerPlaces corners;
  for (const ChartId id : found) {
    const auto ref = at.pages().leaf_of(id, cost);
    for (const WireLoop& loop : find_chart(*ref->leaf, id)->loops)
      for (const DirectedWire step : loop) {
        const PageWire& wire = *find_wire(*ref->leaf, step.wire);
        grown.insert(wire.charts.begin(), wire.charts.end());
        for (const CornerId corner : {wire.begin, wire.end})
          corners.emplace(corner, find_corner(*ref->leaf, corner)->position);
      }
  }
  for (const auto& [corner, around] : charts_at_corners(at, corners, cost)) grown.insert(around.begin(), around.end());
  return grown;
}

}  // namespace

bool meets_shape(const MeshRecord& record, const LatticeBox& box, const RegionShape& shape) {
  return !box.empty() && meets_any(model_box(record, box), shape);
}

bool meets_shape(const Point& lo, const Point& hi, const RegionShape& shape) { return meets_any({lo, hi}, shape); }

std::map<CornerId, std::set<ChartId>> charts_at_corners(const Snapshot::Impl& at, const CornerPlaces& corners,
                                                        ReadCost* cost) {
  std::map<CornerId, std::set<ChartId>> charts;
  for (const auto& [corner, position] : corners) charts[corner];
  const PlacesInBox places(corners);
  at.pages().visit([&](const LatticeBox& box) { return places.any(box); },
                   [&](const LeafRef& ref) {
                     for (const PageChart& chart : ref.leaf->charts) {
                       if (!places.any(chart.box)) continue;
                       for (const WireLoop& loop : chart.loops)
                         for (const DirectedWire step : loop) {
                           const PageWire& wire = *find_wire(*ref.leaf, step.wire);
                           for (const CornerId corner : {wire.begin, wire.end})
                             if (const auto found = charts.find(corner); found != charts.end())
                               found->second.insert(chart.id);
                         }
                     }
                   },
                   cost);
  return charts;
}

std::vector<ChartId> find_charts(const Snapshot::Impl& at, const Region& region, ReadCost* cost) {
  ChartSet found;
  for (const RegionShape& shape : region.shapes) add_shape(at, shape, found, cost);
  if (found.empty()) {
    const ModelBox box = model_box(at.record(), at.pages().box());
    throw Error(Errc::not_found, "the region holds no chart",
                fmt::format("mesh {} fills the box {:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", at.root().name, box.lo.x,
                            box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z),
                "choose a region that meets it, or --near X,Y,Z");
  }
  for (unsigned ring = 0; ring < region.grow; ++ring) {
    ChartSet grown = ring_of(at, found, cost);
    if (grown.size() == found.size()) break;
    found = std::move(grown);
  }
  return {found.begin(), found.end()};
}

}  // namespace ramcdb::detail
