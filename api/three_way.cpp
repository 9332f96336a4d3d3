#include "api/three_way.h"

#include <algorithm>
#include <set>

#include "api/alike_additions.h"
#include "api/edited_region_builder.h"
#include "api/region_match.h"
#include "api/region_mesh.h"
#include "api/same_values.h"

namespace ramcdb::detail {
namespace {

constexpr const char* kMovedGone = "a vertex that one side moved was removed by the other";
constexpr const char* kValueGone = "a vertex or face of which one side changed a value was removed by the other";

class ThreeWayMerge {
 public:
  ThreeWayMerge(const Snapshot::Impl& tip, const RegionMesh& base, const EditedRegion& ours, const RegionMesh& theirs,
                std::span<const ChartId> equal)
      : base_(base),
        ours_(ours),
        theirs_(theirs),
        equal_(equal),
        lattice_(tip.record().lattice),
        base_places_(positions_in(base, lattice_)),
        our_places_(positions_in(ours.mesh, lattice_)),
        their_places_(positions_in(theirs, lattice_)),
        values_(theirs.attributes),
        builder_(tip, theirs) {}

  MergedEdit run() {
    match_theirs();
    index_ours();
    find_alike();
    mark_new_edges();
    add_vertices();
    expect_faces_of_values();
    add_faces();
    add_new_faces();
    if (!merged_.conflicts.empty()) return std::move(merged_);
    builder_.take_new(ours_.mesh, std::move(new_vertices_), std::move(new_faces_));
    merged_.edited = builder_.finish(values_);
    return std::move(merged_);
  }

 private:
  void match_theirs() {
    const RegionMatch match = match_region(base_, theirs_, lattice_, equal_);
    base_vertex_.assign(theirs_.points.size(), kNew);
    their_vertex_.assign(base_.points.size(), kNew);
    for (std::uint32_t v = 0; v < base_vertex_.size(); ++v)
      if (const std::uint32_t b = match.vertices[match.vertex[v]].region; b != kNew) {
        base_vertex_[v] = b;
        their_vertex_[b] = v;
        merged_.theirs_moved = merged_.theirs_moved || !same_bits(their_places_[v], base_places_[b]);
      }
    guessed_.assign(base_.points.size(), false);
    for (const std::uint32_t b : match.guessed) guessed_[b] = true;
    base_face_ = match.faces;
    their_face_.assign(base_.faces.size(), kNew);
    for (std::uint32_t f = 0; f < base_face_.size(); ++f)
      if (base_face_[f].face != kNew) their_face_[base_face_[f].face] = f;
    merged_.theirs_moved = merged_.theirs_moved || !match.same_connectivity();
  }

  void index_ours() {
    our_vertex_.assign(base_.points.size(), kNew);
    for (std::uint32_t v = 0; v < ours_.vertex_source.size(); ++v)
      if (ours_.vertex_source[v] != kNew) our_vertex_[ours_.vertex_source[v]] = v;
    our_face_.assign(base_.faces.size(), kNew);
    for (std::uint32_t f = 0; f < ours_.face_source.size(); ++f)
      if (ours_.face_source[f] != kNew) our_face_[ours_.face_source[f]] = f;
  }

  /// What both sides added alike is taken once. Faces that both removed are gone, unless one put others there, or has
  /// new ones that hang together with nothing: these may be the same once more, at another place.
  void find_alike() {
    std::vector<bool> is_new;
    for (const FaceMatch& match : base_face_) is_new.push_back(match.face == kNew);
    alike_ = find_alike_additions(ours_, our_places_, theirs_, their_places_, base_vertex_, is_new);
    std::vector<bool> has_new(base_.points.size(), false);
    bool loose = false;
    const auto mark = [&](const Triangle& t, const std::vector<std::uint32_t>& base_vertex) {
      loose = loose || std::ranges::all_of(t, [&](std::uint32_t v) { return base_vertex[v] == kNew; });
      for (const std::uint32_t v : t)
        if (base_vertex[v] != kNew) has_new[base_vertex[v]] = true;
    };
    for (std::uint32_t f = 0; f < is_new.size(); ++f)
      if (is_new[f] && !alike_.faces_of_theirs[f]) mark(theirs_.faces[f], base_vertex_);
    for (std::uint32_t f = 0; f < ours_.face_source.size(); ++f)
      if (ours_.face_source[f] == kNew && !alike_.faces[f]) mark(ours_.mesh.faces[f], ours_.vertex_source);
    for (std::uint32_t f = 0; f < our_face_.size(); ++f)
      if (our_face_[f] == kNew && their_face_[f] == kNew)
        for (const std::uint32_t v : base_.faces[f])
          if (loose || has_new[v]) conflict_at(v, "both sides changed the faces here");
    for (const std::uint32_t f : alike_.disputed)
      conflict_between(ours_.mesh.faces[f], "both sides added faces here, and not the same");
  }

  /// Edges of the base at which faces of theirs are new.
  void mark_new_edges() {
    for (std::uint32_t f = 0; f < base_face_.size(); ++f) {
      if (base_face_[f].face != kNew) continue;
      for (std::size_t i = 0; i < 3; ++i)
        add_edge(base_vertex_[theirs_.faces[f][i]], base_vertex_[theirs_.faces[f][(i + 1) % 3]]);
    }
  }

  void add_edge(std::uint32_t a, std::uint32_t b) {
    if (a != kNew && b != kNew) their_new_edges_.insert({std::min(a, b), std::max(a, b)});
  }

  void conflict_at(std::uint32_t base_vertex, const char* what) {
    constexpr std::size_t kMost = 1000;
    if (merged_.conflicts.size() < kMost && told_.insert(base_vertex).second)
      merged_.conflicts.push_back({{}, chart_of(base_vertex), base_places_[base_vertex], what});
  }

  /// At a new face of ours, wherever the base is next to it.
  void conflict_between(const Triangle& face, const char* what) {
    for (const std::uint32_t v : face)
      if (ours_.vertex_source[v] != kNew) return conflict_at(ours_.vertex_source[v], what);
    constexpr std::size_t kMost = 1000;
    if (merged_.conflicts.size() < kMost)
      merged_.conflicts.push_back({{}, base_.charts.front(), our_places_[face[0]], what});
  }

  [[nodiscard]] ChartId chart_of(std::uint32_t base_vertex) const {
    for (std::uint32_t f = 0; f < base_.faces.size(); ++f)
      if (std::ranges::count(base_.faces[f], base_vertex)) return base_.charts[base_.chart_of_face[f]];
    return ChartId(base_.keys[base_vertex].id);
  }

  /// Whether ours takes a face of theirs away.
  [[nodiscard]] bool is_taken_away(std::uint32_t face) const {
    return base_face_[face].face != kNew && our_face_[base_face_[face].face] == kNew;
  }

  /// Per vertex of the base whether each side took away all faces that the other left there: it goes with them.
  [[nodiscard]] std::vector<bool> left_bare(const std::vector<bool>& used) const {
    std::vector<bool> theirs(base_.points.size(), false), ours = theirs, stays = theirs;
    for (const Triangle& t : theirs_.faces)
      for (const std::uint32_t v : t)
        if (base_vertex_[v] != kNew) theirs[base_vertex_[v]] = true;
    for (std::uint32_t v = 0; v < used.size(); ++v)
      if (used[v] && base_vertex_[v] != kNew) stays[base_vertex_[v]] = true;
    for (std::uint32_t f = 0; f < ours_.face_source.size(); ++f)
      for (const std::uint32_t v : ours_.mesh.faces[f]) {
        const std::uint32_t b = ours_.vertex_source[v];
        if (b == kNew) continue;
        ours[b] = true;
        stays[b] = stays[b] || ours_.face_source[f] == kNew;
      }
    for (std::uint32_t b = 0; b < stays.size(); ++b) stays[b] = theirs[b] && ours[b] && !stays[b];
    return stays;
  }

  void add_vertices() {
    std::vector<bool> used(theirs_.points.size(), false);
    for (std::uint32_t f = 0; f < theirs_.faces.size(); ++f)
      for (const std::uint32_t v : theirs_.faces[f]) used[v] = used[v] || !is_taken_away(f);
    const std::vector<bool> bare = left_bare(used);
    vertex_.assign(theirs_.points.size(), kNew);
    for (std::uint32_t v = 0; v < theirs_.points.size(); ++v) {
      const std::uint32_t b = base_vertex_[v];
      if (b != kNew && our_vertex_[b] == kNew) {
        if (used[v]) conflict_at(b, "a vertex that one side uses was removed by the other");
        if (!same_bits(their_places_[v], base_places_[b])) conflict_at(b, kMovedGone);
        if (has_new_values(AttributeOf::vertex, b, theirs_.attributes, v)) conflict_at(b, kValueGone);
        if (!used[v]) continue;
      } else if (b != kNew && bare[b]) {
        if (moved_by_us(b) || !same_bits(their_places_[v], base_places_[b])) conflict_at(b, kMovedGone);
        if (has_new_values(AttributeOf::vertex, b, theirs_.attributes, v) ||
            has_new_values(AttributeOf::vertex, b, ours_.mesh.attributes, our_vertex_[b]))
          conflict_at(b, kValueGone);
        continue;
      }
      vertex_[v] = builder_.add_vertex(v, place_of(v));
      merge_vertex_values(v);
    }
    for (std::uint32_t b = 0; b < base_.points.size(); ++b)
      if (our_vertex_[b] != kNew && their_vertex_[b] == kNew) {
        if (moved_by_us(b)) conflict_at(b, kMovedGone);
        if (has_new_values(AttributeOf::vertex, b, ours_.mesh.attributes, our_vertex_[b])) conflict_at(b, kValueGone);
      }
    expect_isolated_vertices();
    our_new_vertex_.assign(ours_.vertex_source.size(), kNew);
    new_vertices_ = our_new_vertex_;
    for (std::uint32_t v = 0; v < ours_.vertex_source.size(); ++v)
      if (ours_.vertex_source[v] == kNew) {
        if (alike_.vertex[v] != kNew) {
          our_new_vertex_[v] = vertex_[alike_.vertex[v]];
          continue;
        }
        new_vertices_[v] = our_new_vertex_[v] = builder_.add_vertex(kNew, our_places_[v]);
      }
  }

  /// Where both sides lack a vertex without faces, and theirs has new ones, it may have moved to one of these: nothing
  /// else tells who it is.
  void expect_isolated_vertices() {
    const std::vector<bool> of_base = with_faces(base_), of_theirs = with_faces(theirs_);
    bool has_new = false;
    for (std::uint32_t v = 0; v < base_vertex_.size(); ++v)
      has_new = has_new || (base_vertex_[v] == kNew && !of_theirs[v]);
    for (std::uint32_t b = 0; has_new && b < of_base.size(); ++b)
      if (!of_base[b] && our_vertex_[b] == kNew && their_vertex_[b] == kNew) conflict_at(b, kMovedGone);
  }

  [[nodiscard]] static std::vector<bool> with_faces(const RegionMesh& mesh) {
    std::vector<bool> has_face(mesh.points.size(), false);
    for (const Triangle& t : mesh.faces)
      for (const std::uint32_t v : t) has_face[v] = true;
    return has_face;
  }

  [[nodiscard]] bool moved_by_us(std::uint32_t base_vertex) const {
    return !same_bits(our_places_[our_vertex_[base_vertex]], base_places_[base_vertex]);
  }

  [[nodiscard]] const Point& place_of(std::uint32_t v) {
    const std::uint32_t b = base_vertex_[v];
    if (b == kNew || our_vertex_[b] == kNew || !moved_by_us(b)) return their_places_[v];
    const Point& ours = our_places_[our_vertex_[b]];
    if (!same_bits(their_places_[v], base_places_[b]) && !same_bits(their_places_[v], ours))
      conflict_at(b, "both sides moved a vertex to different places");
    return ours;
  }

  /// Of a value that both know, what either side made of it.
  void merge_value(std::size_t a, std::size_t theirs, std::size_t base, std::size_t ours, std::uint32_t base_vertex) {
    const std::size_t components = values_[a].info.components;
    for (std::size_t k = 0; k < components; ++k) {
      const double before = base_.attributes[a].values[base * components + k];
      const double mine = ours_.mesh.attributes[a].values[ours * components + k];
      double& value = values_[a].values[theirs * components + k];
      if (same_bits(mine, before)) continue;
      if (!same_bits(value, before) && !same_bits(value, mine)) conflict_at(base_vertex, "both sides changed a value");
      value = mine;
    }
  }

  /// Whether one side changed a value of a vertex, face or corner of the base.
  [[nodiscard]] bool has_new_values(AttributeOf of, std::size_t base, const std::vector<Attribute>& side,
                                    std::size_t there) const {
    return !same_values(of, side, there, base_.attributes, base);
  }
  [[nodiscard]] bool has_new_values(FaceMatch base, const std::vector<Attribute>& side, std::uint32_t face) const {
    bool found = has_new_values(AttributeOf::face, base.face, side, face);
    for (std::uint32_t i = 0; i < 3; ++i)
      found = found || has_new_values(AttributeOf::corner, 3 * std::size_t{base.face} + (i + base.turn) % 3, side,
                                      3 * std::size_t{face} + i);
    return found;
  }

  void merge_vertex_values(std::uint32_t v) {
    const std::uint32_t b = base_vertex_[v];
    if (b == kNew || our_vertex_[b] == kNew) return;
    for (std::size_t a = 0; a < values_.size(); ++a)
      if (values_[a].info.of == AttributeOf::vertex) merge_value(a, v, b, our_vertex_[b], b);
  }

  void merge_face_values(std::uint32_t f) {
    const FaceMatch base = base_face_[f];
    const std::uint32_t vertex = base_.faces[base.face][0], ours = our_face_[base.face];
    for (std::size_t a = 0; a < values_.size(); ++a) {
      if (values_[a].info.of == AttributeOf::face) merge_value(a, f, base.face, ours, vertex);
      for (std::uint32_t i = 0; values_[a].info.of == AttributeOf::corner && i < 3; ++i) {
        const std::uint32_t turned = (i + base.turn) % 3;
        merge_value(a, 3 * f + i, 3 * base.face + turned, 3 * ours + turned, vertex);
      }
    }
  }

  /// Values that one side changed of faces that the other does not have any more.
  void expect_faces_of_values() {
    for (std::uint32_t f = 0; f < base_.faces.size(); ++f) {
      const std::uint32_t ours = our_face_[f], theirs = their_face_[f];
      if ((ours == kNew) == (theirs == kNew)) continue;
      if (theirs == kNew ? has_new_values(FaceMatch{f, 0}, ours_.mesh.attributes, ours)
                         : has_new_values(base_face_[theirs], theirs_.attributes, theirs))
        conflict_at(base_.faces[f][0], kValueGone);
    }
  }

  void add_faces() {
    for (std::uint32_t f = 0; f < theirs_.faces.size(); ++f) {
      if (is_taken_away(f)) continue;
      const Triangle& t = theirs_.faces[f];
      builder_.add_face({vertex_[t[0]], vertex_[t[1]], vertex_[t[2]]}, f);
      if (base_face_[f].face != kNew) merge_face_values(f);
    }
  }

  /// The merged vertex that a vertex of ours is.
  [[nodiscard]] std::uint32_t merged_vertex(std::uint32_t our_vertex) {
    const std::uint32_t b = ours_.vertex_source[our_vertex];
    if (b == kNew) return our_new_vertex_[our_vertex];
    if (their_vertex_[b] == kNew) {
      conflict_at(b, "a vertex that one side uses was removed by the other");
      return 0;
    }
    if (guessed_[b]) conflict_at(b, "vertices without faces were moved by one side and got faces from the other");
    return vertex_[their_vertex_[b]];
  }

  void add_new_faces() {
    new_faces_.assign(ours_.face_source.size(), kNew);
    for (std::uint32_t f = 0; f < ours_.face_source.size(); ++f) {
      if (ours_.face_source[f] != kNew || alike_.faces[f]) continue;
      const Triangle& t = ours_.mesh.faces[f];
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = ours_.vertex_source[t[i]], b = ours_.vertex_source[t[(i + 1) % 3]];
        if (a != kNew && b != kNew && their_new_edges_.contains({std::min(a, b), std::max(a, b)}))
          conflict_at(a, "both sides changed the faces here");
      }
      new_faces_[f] = builder_.add_face({merged_vertex(t[0]), merged_vertex(t[1]), merged_vertex(t[2])}, kNew);
    }
  }

  const RegionMesh& base_;
  const EditedRegion& ours_;
  const RegionMesh& theirs_;
  std::span<const ChartId> equal_;
  const Lattice& lattice_;
  std::vector<Point> base_places_, our_places_, their_places_;
  std::vector<Attribute> values_;  ///< in the numbering of theirs
  EditedRegionBuilder builder_;
  MergedEdit merged_;
  AlikeAdditions alike_;
  std::set<std::uint32_t> told_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> their_new_edges_;
  std::vector<bool> guessed_;               ///< per vertex of the base: which of theirs it is, is not sure
  std::vector<std::uint32_t> base_vertex_;  ///< theirs -> base
  std::vector<FaceMatch> base_face_;        ///< theirs -> base
  std::vector<std::uint32_t> their_vertex_, their_face_, our_vertex_, our_face_;  ///< base -> theirs, ours
  std::vector<std::uint32_t> vertex_;                                             ///< theirs -> merged
  std::vector<std::uint32_t> our_new_vertex_;                                     ///< ours -> merged
  std::vector<std::uint32_t> new_vertices_, new_faces_;  ///< ours -> merged, of what ours alone added
};

}  // namespace

MergedEdit merge_edits(const Snapshot::Impl& tip, const RegionMesh& base, const EditedRegion& ours,
                       const RegionMesh& theirs, std::span<const ChartId> equal) {
  return ThreeWayMerge(tip, base, ours, theirs, equal).run();
}

}  // namespace ramcdb::detail
