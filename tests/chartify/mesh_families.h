#pragma once

#include <ostream>
#include <vector>

#include "tests/support/meshes.h"

/// One small mesh of every kind, for tests that must hold for all of them.
namespace ramcdb::chartify::test {

struct Family {
  const char* name;
  ramcdb::test::TestMesh (*make)();
};
inline std::ostream& operator<<(std::ostream& out, const Family& family) { return out << family.name; }

inline std::vector<Family> all_families() {
  namespace make = ramcdb::test;
  return {{"Empty", [] { return make::TestMesh{}; }},
          {"OneFace",
           [] {
             return make::TestMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
           }},
          {"OnlyIsolated",
           [] {
             return make::TestMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
           }},
          {"Sphere", [] { return make::sphere(3000); }},
          {"Torus", [] { return make::torus(3000); }},
          {"Genus3", [] { return make::genus3(3000); }},
          {"Terrain", [] { return make::terrain(40, 40); }},
          {"Scan", [] { return make::scan(4000); }},
          {"Boxes", [] { return make::boxes(100); }},
          {"SeveralComponents", make::several_components},
          {"Moebius", make::moebius},
          {"TwoCubesSharingEdge", make::two_cubes_sharing_edge},
          {"Hourglass", make::hourglass},
          {"ThreeFacesOneEdge", make::three_faces_one_edge},
          {"DegenerateAndDuplicate", make::degenerate_and_duplicate_faces},
          {"IsolatedVertices", make::isolated_vertices}};
}

}  // namespace ramcdb::chartify::test
