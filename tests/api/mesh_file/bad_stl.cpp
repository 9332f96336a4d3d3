#include <limits>

#include "tests/api/mesh_file/bad_files.h"
#include "tests/api/mesh_file/files.h"

/// Broken STL, text and binary.
namespace ramcdb::test {
namespace {

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

/// A solid with these lines from line 2 on.
std::string solid(const std::string& lines) { return "solid a\n" + lines + "endsolid a\n"; }

/// A facet whose second vertex line, line 5, is this one.
std::string with_vertex(const std::string& line) {
  return solid("facet normal 0 0 1\nouter loop\nvertex 0 0 0\n" + line + "\nvertex 0 1 0\nendloop\nendfacet\n");
}

/// 84 bytes: a title and a count.
std::string header(const std::string& title, std::uint32_t count) {
  std::string bytes = title;
  bytes.resize(80, ' ');
  return bytes + bytes_of(count);
}

/// 50 bytes; the first corner is at x.
std::string facet(float x = 0, std::uint16_t attribute = 0) {
  std::string bytes;
  for (const float value : {0.F, 0.F, 1.F, x, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) bytes += bytes_of(value);
  return bytes + bytes_of(attribute);
}

std::vector<BadFile> texts() {
  return {
      {"solid-only", "solid", "the file is cut off: no 'endsolid' (a.stl:1)"},
      {"solid-empty", solid(""), "the file holds no facet (a.stl:2)"},
      {"solid-without-end", "solid a\n" + kFacet, "the file is cut off: no 'endsolid' (a.stl:8)"},
      {"cut-in-facet", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
       "the file is cut off: no 'endfacet' (a.stl:4)"},
      {"cut-in-number", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0", "a coordinate is missing (a.stl:4)"},
      {"facet-in-facet", solid("facet normal 0 0 1\n" + kFacet), "a facet begins inside another (a.stl:3)"},
      {"facet-of-two", solid("facet\nvertex 0 0 0\nvertex 1 0 0\nendfacet\n"), "a facet has 2 vertices (a.stl:5)"},
      {"facet-of-none", solid("facet\nendfacet\n"), "a facet has 0 vertices (a.stl:3)"},
      {"facet-of-four", solid("facet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 1 0\nendfacet\n"),
       "a facet has more than three vertices (a.stl:6)"},
      {"vertex-outside", solid("vertex 0 0 0\n"), "a vertex stands outside a facet (a.stl:2)"},
      {"endfacet-outside", solid("endfacet\n"), "an 'endfacet' without a facet (a.stl:2)"},
      {"end-in-facet", solid("facet normal 0 0 1\nouter loop\nvertex 0 0 0\n"),
       "the file is cut off: no 'endfacet' (a.stl:5)"},
      {"vertex-empty", with_vertex("vertex"), "a coordinate is missing (a.stl:5)"},
      {"vertex-two", with_vertex("vertex 1 0"), "a coordinate is missing (a.stl:5)"},
      {"vertex-four", with_vertex("vertex 1 0 0 0"), "reads 3 1; further words behind coordinates x1"},
      {"vertex-word", with_vertex("vertex 1 x 0"), "a coordinate is no number: 'x' (a.stl:5)"},
      {"vertex-nan", with_vertex("vertex nan 0 0"), "a coordinate is not finite: 'nan' (a.stl:5)"},
      {"vertex-inf", with_vertex("vertex 0 inf 0"), "a coordinate is not finite: 'inf' (a.stl:5)"},
      {"vertex-ind", with_vertex("vertex -1.#IND 0 0"), "a coordinate is no number: '-1.#IND' (a.stl:5)"},
      {"vertex-huge", with_vertex("vertex 1e999 0 0"), "a coordinate is too large: '1e999' (a.stl:5)"},
      {"vertex-tiny", with_vertex("vertex 1e-999 0 0"), "reads 3 1"},
      {"vertex-beyond-float", with_vertex("vertex 1e300 0 0"), "reads 3 1"},
      {"vertex-comma", with_vertex("vertex 1,0 0,0 0,0"), "a coordinate is no number: '1,0' (a.stl:5)"},
      {"vertex-nul", with_vertex(std::string("vertex \0 0 0", 12)), "a coordinate is no number: '\\x00' (a.stl:5)"},
      {"vertex-long", with_vertex("vertex " + std::string(50000, '1') + " 0 0"),
       "a coordinate is too large: '1111111111111111111111111111111111111111' (a.stl:5)"},
      {"vertex-hex", with_vertex("vertex 0x1 0 0"), "a coordinate is no number: '0x1' (a.stl:5)"},
      {"word-unknown", solid("face normal 0 0 1\n"), "'face' is not STL (a.stl:2)"},
      {"word-long", solid(std::string(100000, 'f') + "\n"), "is not STL (a.stl:2)"},
      {"word-binary", solid("\x01\x02\xff\n"), "'\\x01\\x02\\xff' is not STL (a.stl:2)"},
      {"normal-nan",
       solid("facet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
             "endfacet\n"),
       "reads 3 1"},
      {"normal-missing", solid("facet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n"), "reads 3 1"},
      {"facet-of-a-point", solid("facet\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nendfacet\n"), "reads 3 1"},
      {"capitals",
       "SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\n"
       "ENDFACET\nENDSOLID A\n",
       "reads 3 1"},
      {"two-solids", solid(kFacet) + solid(kFacet), "reads 6 2"},
      {"solid-in-solid", "solid a\n" + kFacet + solid(kFacet), "reads 6 2"},
      {"solid-name-non-ascii", "solid K\xc3\xb6rper\n" + kFacet + "endsolid\n", "reads 3 1"},
      {"solid-name-long", "solid " + std::string(100000, 'a') + "\n" + kFacet + "endsolid\n", "reads 3 1"},
      {"no-newline", "solid a\n" + kFacet + "endsolid", "reads 3 1"},
      {"byte-order-mark", "\xef\xbb\xbf" + solid(kFacet), "reads 3 1"},
      {"blank-first", "\n\n  " + solid(kFacet), "reads 3 1"},
      {"one-line", "solid a facet normal 0 0 1 outer loop vertex 0 0 0 endloop endfacet endsolid a",
       "the file is cut off: no 'endsolid' (a.stl:1)"},
      {"cr-only", "solid a\rfacet normal 0 0 1\router loop\rvertex 0 0 0\rendsolid a\r",
       "the file is cut off: no 'endfacet' (a.stl:5)"},
      {"solid-glued", "solidworks\n" + kFacet, "'solidworks' is not STL (a.stl:1)"},
  };
}

std::vector<BadFile> binaries() {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  std::string big = header("big endian", 0);
  big.resize(80);
  big += bytes_of(std::uint32_t{1}, true) + facet();
  return {
      {"empty", "", "the file is too short for STL (a.stl, byte 0)"},
      {"one-byte", "s", "the file is too short for STL (a.stl, byte 1)"},
      {"title-only", std::string(80, 'x'), "the file is too short for STL (a.stl, byte 80)"},
      {"count-cut-off", std::string(83, 'x'), "the file is too short for STL (a.stl, byte 83)"},
      {"html", "<!DOCTYPE html>\n<html>404</html>\n", "the file is too short for STL"},
      {"no-facet", header("none", 0), "the file holds no vertex (a.stl)"},
      {"all-zero", std::string(200, '\0'), "the file holds no vertex (a.stl)"},
      {"all-ones", std::string(200, '\xff'),
       "the file is cut off: 4294967295 triangles announced, room for 2 (a.stl, byte 80)"},
      {"count-2-32", header("huge", 0xffffffffU) + facet(),
       "the file is cut off: 4294967295 triangles announced, room for 1 (a.stl, byte 80)"},
      {"count-one-more", header("more", 2) + facet(),
       "the file is cut off: 2 triangles announced, room for 1 (a.stl, byte 80)"},
      {"count-one-fewer", header("fewer", 1) + facet() + facet(), "reads 3 1; bytes behind the last facet x50"},
      {"count-zero", header("zero", 0) + facet(), "the file holds no vertex (a.stl)"},
      {"count-big-endian", big, "the file is cut off: 16777216 triangles announced, room for 1 (a.stl, byte 80)"},
      {"facet-cut-off", header("cut", 1) + facet().substr(0, 49), "1 triangles announced, room for 0 (a.stl, byte 80)"},
      {"bytes-behind", header("behind", 1) + facet() + "\n", "reads 3 1; bytes behind the last facet x1"},
      {"solid-binary", header("solid but binary", 1) + facet(), "reads 3 1"},
      {"solid-binary-count-more", header("solid but binary", 2) + facet(),
       "the file is cut off: 2 triangles announced, room for 1 (a.stl, byte 80)"},
      {"solid-binary-count-fewer", header("solid but binary", 1) + facet() + facet(),
       "reads 3 1; bytes behind the last facet x50"},
      {"solid-binary-empty", header("solid", 0), "the file holds no vertex (a.stl)"},
      {"binary-nan", header("nan", 1) + facet(nan), "vertex 0 has a coordinate that is not finite (a.stl)"},
      {"binary-inf", header("inf", 1) + facet(inf), "vertex 0 has a coordinate that is not finite (a.stl)"},
      {"binary-largest", header("max", 1) + facet(std::numeric_limits<float>::max()), "reads 3 1"},
      {"binary-denormal", header("min", 1) + facet(std::numeric_limits<float>::denorm_min()), "reads 3 1"},
      {"binary-attribute", header("color", 2) + facet(0, 0) + facet(0, 0xffff), "reads 6 2"},
      {"magics-color", header("COLOR=\x01\x02\x03\x04,MATERIAL=", 1) + facet(0, 0x8000), "reads 3 1"},
      {"zip", "PK\x03\x04" + std::string(100, '\x05'), "(a.stl, byte 80)"},
  };
}

}  // namespace

std::vector<BadFile> bad_stl_files() {
  std::vector<BadFile> all = texts();
  const auto more = binaries();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace ramcdb::test
