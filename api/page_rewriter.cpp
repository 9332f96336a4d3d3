#include "api/page_rewriter.h"

#include <algorithm>

#include "api/store_format.h"
#include "codec/page_codec.h"

namespace ramcdb::detail {
namespace {

class Rewriter {
 public:
  Rewriter(const PageIndex& tip, const EncodedEdit& edit, db::Writer& writer, MeshRecord& record)
      : tip_(tip), edit_(edit), writer_(writer), record_(record) {}

  /// Recursion is as deep as the tree: a few levels, bounded by PageIndex.
  PageEntry rewrite(PageId id, VersionId version, int depth = 0) {
    const auto loaded = tip_.page(id, version);
    Page page = *loaded.page;
    if (auto* leaf = std::get_if<LeafPage>(&page)) {
      update(*leaf);
    } else if (depth < kMaxPageDepth) {
      for (PageEntry& child : std::get<InnerPage>(page).pages)
        if (touches(child)) child = rewrite(child.id, child.version, depth + 1);
    }
    Buffer blob = codec::encode_page(page);
    record_.page_bytes += blob.size() + kBlobOverhead - loaded.bytes;
    writer_.put({db::Kind::page, tip_.root().mesh, id.value, {}, 0}, std::move(blob));
    return entry_for(page, id, writer_.version());
  }

 private:
  bool touches(const PageEntry& entry) const {
    return std::any_of(entry.charts.begin(), entry.charts.end(), [&](const ChartRun& run) {
      const auto first = edit_.charts.lower_bound(run.first);
      return first != edit_.charts.end() && first->first.value - run.first.value < run.count;
    });
  }

  void update(LeafPage& leaf) const {
    for (PageChart& chart : leaf.charts) {
      const auto recoded = edit_.charts.find(chart.id);
      if (recoded == edit_.charts.end()) continue;
      for (const RecodedLayer& layer : recoded->second.layers)
        for (LayerRef& ref : chart.layers)
          if (ref.layer == layer.layer) ref.version = writer_.version();
      if (recoded->second.blob.empty()) continue;
      chart.version = writer_.version();
      chart.table = recoded->second.entry.table;
      chart.box = recoded->second.entry.box;
    }
    for (PageWire& wire : leaf.wires)
      if (const auto recoded = edit_.wires.find(wire.id); recoded != edit_.wires.end()) {
        wire.version = writer_.version();
        wire.group = recoded->second.group;
      }
    for (PageCorner& corner : leaf.corners)
      if (const auto moved = edit_.corners.find(corner.id); moved != edit_.corners.end())
        corner.position = moved->second;
  }

  const PageIndex& tip_;
  const EncodedEdit& edit_;
  db::Writer& writer_;
  MeshRecord& record_;
};

}  // namespace

std::vector<ChartId> find_conflicts(const PageIndex& tip, const EncodedEdit& edit) {
  std::vector<ChartId> conflicts;
  for (const auto& [id, recoded] : edit.charts) {
    const auto ref = tip.leaf_of(id);
    if (!ref || state_of(*find_chart(*ref->leaf, id)) != state_of(recoded.base)) conflicts.push_back(id);
  }
  return conflicts;
}

db::MeshRoot rewrite_pages(const PageIndex& tip, const EncodedEdit& edit, db::Writer& writer, MeshRecord& record) {
  Rewriter rewriter(tip, edit, writer, record);
  const PageEntry root = rewriter.rewrite(tip.root().root_page, tip.root().root_version);
  db::MeshRoot moved = tip.root();
  moved.root_page = root.id;
  moved.root_version = root.version;
  moved.record_version = writer.version();
  return moved;
}

}  // namespace ramcdb::detail
