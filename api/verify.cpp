#include "api/verify.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <tuple>

#include "api/chart_loader.h"
#include "api/snapshot_impl.h"
#include "api/surface_pieces.h"
#include "chartify/parallel.h"
#include "codec/page_codec.h"
#include "ramcdb/error.h"

namespace ramcdb::detail {
namespace {

std::string object_name(const db::BlobKey& key) {
  static const std::map<db::Kind, const char*> names = {{db::Kind::page, "page"},
                                                        {db::Kind::wire, "wire"},
                                                        {db::Kind::chart, "chart"},
                                                        {db::Kind::attribute, "attribute"},
                                                        {db::Kind::table, "table"},
                                                        {db::Kind::commit_record, "commit record"},
                                                        {db::Kind::pending, "pending list"},
                                                        {db::Kind::mesh_record, "mesh record"}};
  const auto it = names.find(key.kind);
  return fmt::format("{} {}", it == names.end() ? "blob" : it->second, key.id);
}

class Verifier {
 public:
  Verifier(const std::shared_ptr<db::Store>& store, const Repository::VerifyOptions& options)
      : store_(store), options_(options) {}

  VerifyReport run() {
    progress("checksums", 0);
    report_.objects = store_->check([&](const db::Store::Problem& p) {
      report_.problems.push_back({p.kind, p.key ? fmt::format("{}", p.key->mesh.value) : "",
                                  p.key ? object_name(*p.key) : "", p.key ? p.key->version : VersionId(), p.text});
    });
    const auto versions = store_->all_versions();
    for (std::size_t i = 0; i < versions.size(); ++i) {
      progress("versions", static_cast<double>(i) / static_cast<double>(versions.size()));
      for (const db::MeshRoot& root : store_->roots(versions[i])) check_root(versions[i], root);
    }
    return std::move(report_);
  }

 private:
  void progress(std::string_view stage, double done) const {
    if (options_.progress) options_.progress(stage, done);
  }

  void note(const char* kind, const db::MeshRoot& root, std::string object, VersionId version, const Error& e) {
    report_.problems.push_back({kind, root.name, std::move(object), version, e.what()});
  }

  /// Meshes share most of their pages with the version before: a page that was walked is not walked again.
  void check_root(VersionId version, const db::MeshRoot& root) {
    if (!roots_.insert({root.mesh, root.root_page, root.root_version, root.record_version}).second) return;
    try {
      const Snapshot::Impl at(store_, version, root);
      check_pages(at);
    } catch (const Error& e) {
      note("index", root, "mesh", version, e);
    }
  }

  void check_pages(const Snapshot::Impl& at) {
    struct Step {
      PageId id;
      VersionId version;
    };
    std::vector<Step> todo{{at.root().root_page, at.root().root_version}};
    while (!todo.empty()) {
      const Step step = todo.back();
      todo.pop_back();
      if (!pages_.insert({at.root().mesh, step.id, step.version}).second) continue;
      try {
        const auto loaded = at.pages().page(step.id, step.version);
        codec::validate_page(*loaded.page, fmt::format("page {}", step.id.value));
        if (const auto* inner = std::get_if<InnerPage>(&*loaded.page)) {
          check_entries(at, *inner);
          for (const PageEntry& e : inner->pages) todo.push_back({e.id, e.version});
        } else {
          check_leaf(at, std::get<LeafPage>(*loaded.page));
        }
      } catch (const Error& e) {
        note("index", at.root(), fmt::format("page {}", step.id.value), step.version, e);
      }
    }
  }

  void check_entries(const Snapshot::Impl& at, const InnerPage& inner) {
    for (const PageEntry& entry : inner.pages) {
      try {
        const auto below = at.pages().page(entry.id, entry.version);
        if (!(entry_for(*below.page, entry.id, entry.version) == entry))
          throw Error(Errc::corrupt, "the entry above the page does not say what the page holds");
      } catch (const Error& e) {
        note("index", at.root(), fmt::format("page {}", entry.id.value), entry.version, e);
      }
    }
  }

  void check_leaf(const Snapshot::Impl& at, const LeafPage& leaf) {
    check_shared(at, leaf);
    if (options_.quick) return check_presence(at, leaf);
    std::vector<const PageChart*> fresh;
    for (const PageChart& chart : leaf.charts)
      if (charts_.insert({at.root().mesh, chart.id, state_of(chart)}).second) fresh.push_back(&chart);
    std::vector<std::string> failures(fresh.size());
    parallel_for(fresh.size(), options_.threads, [&](std::size_t i) {
      try {
        check_chart(at, *fresh[i]);
      } catch (const Error& e) {
        failures[i] = e.what();
      }
    });
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      ++report_.decoded_charts;
      if (!failures[i].empty())
        report_.problems.push_back(
            {"chart", at.root().name, fmt::format("chart {}", fresh[i]->id.value), fresh[i]->version, failures[i]});
    }
  }

  static void check_chart(const Snapshot::Impl& at, const PageChart& entry) {
    ChartLoader loader(at);
    const auto loaded = loader.load(std::span(&entry.id, 1), 1, nullptr, true);
    LatticeBox box;
    for (const LatticePoint p : loaded.front().chart.positions) box.add(p);
    if (!(box == entry.box)) throw Error(Errc::corrupt, "the chart's box in its index page is not its exact box");
    if (!(pieces_of(loaded.front().chart) == entry.pieces))
      throw Error(Errc::corrupt, "the chart's pieces in its index page are not those of its faces");
  }

  void check_presence(const Snapshot::Impl& at, const LeafPage& leaf) {
    const auto reader = store_->reader();
    for (const PageChart& chart : leaf.charts) {
      require(at, *reader, {db::Kind::chart, at.root().mesh, chart.id.value, chart.version, 0});
      for (const LayerRef& layer : chart.layers)
        require(at, *reader, {db::Kind::attribute, at.root().mesh, chart.id.value, layer.version, layer.layer});
    }
    for (const PageWire& wire : leaf.wires)
      if (wire.inner_points) require(at, *reader, {db::Kind::wire, at.root().mesh, wire.group.value, wire.version, 0});
  }

  void require(const Snapshot::Impl& at, db::BlobReader& reader, const db::BlobKey& key) {
    try {
      (void)reader.get(key);
    } catch (const Error& e) {
      note("missing", at.root(), object_name(key), key.version, e);
    }
  }

  /// Neighbouring pages hold a shared wire or corner alike, and both know the charts on the other side.
  void check_shared(const Snapshot::Impl& at, const LeafPage& leaf) {
    for (const PageWire& wire : leaf.wires) {
      for (const ChartId chart : wire.charts) {
        if (find_chart(leaf, chart)) continue;
        const auto other = at.pages().leaf_of(chart);
        const PageWire* twin = other ? find_wire(*other->leaf, wire.id) : nullptr;
        if (!twin || !(*twin == wire) || !same_corners(leaf, *other->leaf, wire))
          note("neighbours", at.root(), fmt::format("wire {}", wire.id.value), wire.version,
               Error(Errc::corrupt, fmt::format("chart {} on its other side does not agree about it", chart.value)));
      }
    }
  }

  static bool same_corners(const LeafPage& a, const LeafPage& b, const PageWire& wire) {
    for (const CornerId corner : {wire.begin, wire.end}) {
      const PageCorner* other = find_corner(b, corner);
      if (!other || !(*other == *find_corner(a, corner))) return false;
    }
    return true;
  }

  std::shared_ptr<db::Store> store_;
  const Repository::VerifyOptions& options_;
  VerifyReport report_;
  std::set<std::tuple<MeshId, PageId, VersionId, VersionId>> roots_;
  std::set<std::tuple<MeshId, PageId, VersionId>> pages_;
  std::set<std::tuple<MeshId, ChartId, ChartState>> charts_;
};

}  // namespace

VerifyReport verify_repository(const std::shared_ptr<db::Store>& store, const Repository::VerifyOptions& options) {
  return Verifier(store, options).run();
}

}  // namespace ramcdb::detail
