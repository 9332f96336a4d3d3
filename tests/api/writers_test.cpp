#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <thread>

#include "tests/api/flat_surface.h"
#include "tests/api/oracle.h"
#include "tests/db/child_process.h"

// Eight processes edit one mesh at the same time: random regions, as files and in memory, moved, remeshed, painted.
// Afterwards every version is compared with a plain mesh to which the edits were done one after the other, in the order
// of history. RAMCDB_WRITER_COMMITS says how many commits, RAMCDB_WRITER_SEED which ones.
namespace ramcdb::test {
namespace {

namespace fs = std::filesystem;
using db::test::ChildProcess;

constexpr unsigned kWriterCount = 8;

unsigned writer_setting(const char* name, unsigned otherwise) {
  const char* text = std::getenv(name);
  return text ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : otherwise;
}

/// What a writer did, on disk before it goes on. Being killed loses at most the line at work.
class WriterLog {
 public:
  explicit WriterLog(const fs::path& file) : file_(::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600)) {}
  ~WriterLog() { ::close(file_); }
  WriterLog(const WriterLog&) = delete;
  WriterLog& operator=(const WriterLog&) = delete;

  void write(const std::string& text) const {
    if (::write(file_, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
      throw std::runtime_error("the log of a writer cannot be written");
  }

 private:
  int file_;
};

/// One process that edits and commits.
class RandomWriter {
 public:
  RandomWriter(const fs::path& folder, unsigned number, unsigned seed)
      : folder_(folder),
        name_("w" + std::to_string(number)),
        random_(1000 * seed + number),
        log_(folder / (name_ + ".log")),
        repository_(Repository::open(folder / "r")) {
    omerr().disable();  // it speaks of every face that it cannot hold
  }

  void run(unsigned commits) {
    for (unsigned done = 0; done < commits && !::testing::Test::HasFailure();) done += edit();
  }

 private:
  /// Some charts around one, seldom all.
  std::vector<ChartId> pick_charts(const Snapshot& snapshot) {
    const std::vector<ChartId> all = snapshot.find({{WholeMesh{}}, 0});
    if (random_() % 100 == 0) return all;
    const ChartId middle = all[random_() % all.size()];
    std::vector<ChartId> charts = snapshot.find({{OfCharts{{middle}}}, random_() % 2 ? 1U : 0U});
    const std::size_t most = 1 + random_() % 3;
    while (charts.size() > most) charts.erase(charts.begin() + static_cast<std::ptrdiff_t>(random_() % charts.size()));
    return charts;
  }

  /// True when there is one more version.
  bool edit() { return random_() % 2 ? edit_patch() : edit_file(); }

  bool edit_patch() {
    auto transaction = repository_.begin_edit();
    Patch& patch = transaction.checkout({{OfCharts{pick_charts(transaction.base())}}, 0});
    const RegionMesh region = patch.region();
    Sketch sketch = sketch_in_patch(patch, draw(region, true), random_);
    if (!sketch.outer_edges_intact() || sketch.faces.empty()) return false;  // OpenMesh could not hold it
    std::vector<std::int64_t> colors = painted(sketch);
    for (std::uint32_t v = 0; v < colors.size(); ++v)
      if (const std::uint32_t was = sketch.vertex_was[v]; was == Sketch::kNew)
        colors[v] = FlatSurface::kUnknown;
      else
        for (std::uint32_t i = 0; i < 3; ++i)
          patch.attributes().at(0).values[3 * was + i] = static_cast<double>(colors[v] >> (16 - 8 * i) & 255);
    return commit(sketch, colors, [&](const CommitOptions& options) { return transaction.commit(options); });
  }

  bool edit_file() {
    static constexpr const char* kKinds[] = {".ply", ".ply", ".obj", ".off"};
    const fs::path file = folder_ / (name_ + kKinds[random_() % 4]);
    const bool ids = file.extension() == ".ply";
    const Snapshot snapshot = repository_.snapshot();
    const std::vector<ChartId> charts = pick_charts(snapshot);
    FileOptions options;
    options.local_origin = false;
    (void)repository_.checkout_file(snapshot, charts, file, options);
    const RegionMesh region = snapshot.read_with_attributes(charts);
    const Sketch sketch = draw(region, ids);
    if (!sketch.outer_edges_intact() || sketch.faces.empty()) return false;
    const std::vector<std::int64_t> colors = painted(sketch);
    write(snapshot, sketch, colors, file);
    return commit(sketch, colors, [&](const CommitOptions& how) { return repository_.commit_file(file, how); });
  }

  Sketch draw(const RegionMesh& region, bool shared) {
    Sketch sketch(region);
    FlatChanges changes(sketch, random_);
    if (random_() % 2) changes.remesh();
    if (random_() % 3) changes.move(shared);
    sketch.tidy();
    return sketch;
  }

  /// Per vertex; now and then some are changed.
  std::vector<std::int64_t> painted(const Sketch& sketch) {
    const std::size_t every = random_() % 3 ? 0 : 1 + random_() % 20;
    std::vector<std::int64_t> colors;
    for (const std::uint32_t was : sketch.vertex_was) {
      const bool paint = was == Sketch::kNew || (every > 0 && random_() % every == 0);
      colors.push_back(paint ? static_cast<std::int64_t>(random_() & 0xffffff)
                             : packed_color(sketch.region().attributes.at(0).values, was));
    }
    return colors;
  }

  void write(const Snapshot& snapshot, const Sketch& sketch, const std::vector<std::int64_t>& colors,
             const fs::path& file) const {
    const std::vector<std::uint64_t> ids = mesh_file::read_mesh(file).vertex_ids;
    mesh_file::MeshOutput out;
    std::vector<Point> positions;
    std::vector<std::uint32_t> corners;
    std::vector<std::uint64_t> new_ids;
    Attribute color{{"color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color, {}, {}}, {}};
    for (std::uint32_t v = 0; v < sketch.points.size(); ++v) {
      positions.push_back(snapshot.position(sketch.points[v]));
      if (!ids.empty()) new_ids.push_back(sketch.vertex_was[v] == Sketch::kNew ? 0 : ids[sketch.vertex_was[v]]);
      for (int shift = 16; shift >= 0; shift -= 8)
        color.values.push_back(static_cast<double>(colors[v] >> shift & 255));
    }
    for (const Triangle& t : sketch.faces) corners.insert(corners.end(), t.begin(), t.end());
    const std::vector<Attribute> attributes{color};
    out.positions = positions;
    out.corners = corners;
    out.scalar = mesh_file::Scalar::float64;
    out.vertex_ids = new_ids;
    out.attributes = attributes;
    (void)mesh_file::write_mesh(file, mesh_file::format_of(file), out);
  }

  /// Says what it is about to do, does it, and says what came of it.
  template <class Commit>
  bool commit(const Sketch& sketch, const std::vector<std::int64_t>& colors, Commit&& run) {
    FlatSurface after;
    for (std::uint32_t v = 0; v < sketch.points.size(); ++v) after.add(sketch.points[v], colors[v]);
    after.add(sketch.points, sketch.faces);
    FlatEdit edit = FlatEdit::between(flat_surface(sketch.region()), after);
    if (edit.empty()) return false;
    CommitOptions options;
    options.merge = edit.may_merge = random_() % 3 == 0;
    options.author = name_;
    options.message = edit.id = name_ + "." + std::to_string(++edits_);
    log_.write(to_text(edit));
    const CommitReport report = run(options);
    if (!report.conflicts.empty()) {
      log_.write("conflict " + edit.id + " ;\n");
      return false;
    }
    EXPECT_FALSE(report.nothing_changed && !options.merge) << edit.id;
    if (report.nothing_changed) return false;
    log_.write(fmt::format("receipt {} {} {:d} ;\n", edit.id, report.revision.value, report.merged));
    return true;
  }

  fs::path folder_;
  std::string name_;
  Sketch::Random random_;
  WriterLog log_;
  Repository repository_;
  unsigned edits_ = 0;
};

/// What all writers wrote down.
struct WriterLogs {
  std::map<std::string, FlatEdit> edits;
  std::map<std::string, VersionId> receipts;
  unsigned conflicts = 0, merged = 0;

  void read(const fs::path& file) {
    std::ifstream in(file);
    std::string word, id, end;
    while (in >> word) {
      if (word == "edit") {
        FlatEdit edit;
        if (!read_edit(in, edit)) return;
        EXPECT_TRUE(edits.emplace(edit.id, edit).second) << edit.id;
      } else if (word == "conflict") {
        conflicts += in >> id >> end ? 1U : 0U;
      } else if (word == "receipt") {
        std::uint32_t version = 0;
        bool with_others = false;
        if (!(in >> id >> version >> with_others >> end)) return;
        EXPECT_TRUE(receipts.emplace(id, VersionId(version)).second) << id;
        merged += with_others;
      }
    }
  }
};

class Writers : public ::testing::Test {
 protected:
  Writers() {
    const TestMesh mesh = terrain(56, 56);
    mesh_file::MeshOutput out;
    std::vector<std::uint32_t> corners;
    for (const Triangle& t : mesh.faces) corners.insert(corners.end(), t.begin(), t.end());
    std::vector<Attribute> attributes{
        {{"color", AttributeOf::vertex, NumberType::uint8, 3, Meaning::color, {}, {}}, {}}};
    for (std::size_t i = 0; i < 3 * mesh.positions.size(); ++i)
      attributes[0].values.push_back(static_cast<double>(i % 256));
    out.positions = mesh.positions;
    out.corners = corners;
    out.attributes = attributes;
    (void)mesh_file::write_mesh(folder_ / "terrain.ply", mesh_file::Format::ply, out);
    Repository::create(folder_ / "r");
    ImportOptions options;
    options.chart_faces = 120;
    options.bits = 14;
    (void)Repository::open(folder_ / "r").import(folder_ / "terrain.ply", options);
  }

  [[nodiscard]] ChildProcess start_writer(unsigned number, unsigned commits) {
    started_ = std::max(started_, number + 1);
    return ChildProcess([this, number, commits] { RandomWriter(folder_ / "", number, seed_).run(commits); });
  }

  [[nodiscard]] WriterLogs logs() const {
    WriterLogs all;
    for (unsigned w = 0; w < started_; ++w) all.read(folder_ / ("w" + std::to_string(w) + ".log"));
    return all;
  }

  /// History is one line; every version in it is an edit of the logs, each once, and holds what all up to it made.
  /// \return how many have no receipt
  unsigned expect_a_serial_order(const WriterLogs& logs) const {
    const Repository repository = Repository::open(folder_ / "r");
    std::vector<VersionRecord> history = repository.log();
    std::ranges::reverse(history);
    FlatSurface expected = surface_of(repository, history.front().id);
    std::set<std::string> seen;
    unsigned without_receipt = 0;
    for (std::size_t i = 1; i < history.size() && !HasFailure(); ++i) {
      const VersionRecord& version = history[i];
      const std::string id = version.message;
      EXPECT_EQ(version.parents, std::vector<VersionId>{history[i - 1].id});
      EXPECT_TRUE(seen.insert(id).second) << id << " is doubled";
      const auto edit = logs.edits.find(id);
      if (edit == logs.edits.end()) {
        ADD_FAILURE() << "nobody made " << id;
        break;
      }
      const auto receipt = logs.receipts.find(id);
      if (receipt == logs.receipts.end())
        ++without_receipt;
      else
        EXPECT_EQ(receipt->second, version.id) << id;
      edit->second.apply(expected);
      expect_same(surface_of(repository, version.id), expected, id);
      if (HasFailure()) std::cout << "after " << to_text(edit->second);
    }
    if (HasFailure()) return without_receipt;
    for (const auto& [id, version] : logs.receipts) EXPECT_TRUE(seen.contains(id)) << id << " is lost";
    EXPECT_TRUE(repository.verify({}).ok());
    expect_export(repository, expected);
    return without_receipt;
  }

  unsigned seed_ = writer_setting("RAMCDB_WRITER_SEED", 1);
  TempFolder folder_;

 private:
  static FlatSurface surface_of(const Repository& repository, VersionId version) {
    return flat_surface(whole(repository.snapshot({}, std::to_string(version.value))));
  }

  static void expect_same(const FlatSurface& is, const FlatSurface& expected, const std::string& id) {
    EXPECT_TRUE(is.faces == expected.faces) << id << ": faces";
    EXPECT_EQ(is.vertices.size(), expected.vertices.size()) << id;
    std::string wrong;
    for (const auto& [name, vertex] : expected.vertices) {
      const auto it = is.vertices.find(name);
      if (it != is.vertices.end() && it->second.height == vertex.height &&
          (vertex.color == FlatSurface::kUnknown || it->second.color == vertex.color))
        continue;
      wrong += fmt::format(" {},{}: ", name[0], name[1]);
      wrong += it == is.vertices.end() ? "gone"
                                       : fmt::format("{} {:x} instead of {} {:x}", it->second.height, it->second.color,
                                                     vertex.height, vertex.color);
    }
    EXPECT_EQ(wrong, "") << id;
  }

  void expect_export(const Repository& repository, const FlatSurface& expected) const {
    const Snapshot last = repository.snapshot();
    (void)repository.export_mesh(last, folder_ / "last.ply", {});
    const mesh_file::MeshData file = mesh_file::read_mesh(folder_ / "last.ply");
    RegionMesh region;
    region.points = snapped(last.lattice(), file.positions);
    region.attributes = file.attributes;
    for (std::size_t c = 0; c + 2 < file.corners.size(); c += 3)
      region.faces.push_back({file.corners[c], file.corners[c + 1], file.corners[c + 2]});
    expect_same(flat_surface(region), expected, "export");
  }

  unsigned started_ = 0;
};

TEST_F(Writers, LoseNothingAndDoubleNothingInAnyOrder) {
  const unsigned commits = writer_setting("RAMCDB_WRITER_COMMITS", 160);
  std::vector<ChildProcess> writers;
  for (unsigned w = 0; w < kWriterCount; ++w) writers.push_back(start_writer(w, (commits + w) / kWriterCount));
  for (ChildProcess& writer : writers) EXPECT_EQ(writer.wait(), 0);
  const WriterLogs written = logs();
  EXPECT_EQ(written.receipts.size(), commits);
  EXPECT_EQ(expect_a_serial_order(written), 0U);
  std::cout << written.receipts.size() << " commits by " << kWriterCount << " processes, " << written.conflicts
            << " conflicts, " << written.merged << " merged with others'\n";
}

TEST_F(Writers, MayBeKilledAtAnyMomentBesideEachOther) {
  const unsigned commits = writer_setting("RAMCDB_WRITER_COMMITS", 160);
  Sketch::Random random(seed_);
  std::vector<ChildProcess> writers;
  unsigned started = 0, kills = 0;
  for (; started < kWriterCount; ++started) writers.push_back(start_writer(started, ~0U));
  while (logs().receipts.size() < commits && !HasFailure()) {
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 200'000));
    ChildProcess& writer = writers[random() % writers.size()];
    ::kill(writer.pid(), SIGKILL);
    EXPECT_EQ(writer.wait(), W_EXITCODE(0, SIGKILL)) << "a writer ended by itself";
    writer = start_writer(started++, ~0U);
    ++kills;
  }
  for (ChildProcess& writer : writers) {
    ::kill(writer.pid(), SIGKILL);
    EXPECT_EQ(writer.wait(), W_EXITCODE(0, SIGKILL)) << "a writer ended by itself";
    ++kills;
  }
  {
    Repository repository = Repository::open(folder_ / "r");  // recovers what the last kill left
    (void)repository.create_branch("after");
  }
  const WriterLogs written = logs();
  const unsigned without_receipt = expect_a_serial_order(written);
  EXPECT_LE(without_receipt, kills);
  std::cout << written.receipts.size() << " commits with receipts and " << without_receipt << " without, " << kills
            << " writers killed, " << written.conflicts << " conflicts, " << written.merged << " merged with others'\n";
}

}  // namespace
}  // namespace ramcdb::test
