#include "tests/api/mesh_file/bad_files.h"

/// Broken OFF. Counts stand in line 2, vertices in lines 3 to 5, the face in line 6.
namespace ramcdb::test {
namespace {

const std::string kCounts = "3 1 0\n";
const std::string kBody = "0 0 0\n1 0 0\n0 1 0\n";
const std::string kFace = "3 0 1 2\n";

std::string with_counts(const std::string& counts) { return "OFF\n" + counts + "\n" + kBody + kFace; }
std::string with_face(const std::string& face) { return "OFF\n" + kCounts + kBody + face; }
std::string with_vertex(const std::string& vertex, const std::string& keyword = "OFF") {
  return keyword + "\n1 0 0\n" + vertex + "\n";
}

std::vector<BadFile> headers() {
  return {
      {"empty", "", "the number of vertices is missing"},
      {"blank", " \n\t\n", "the number of vertices is missing"},
      {"nuls", std::string(40, '\0'), "this is not OFF: it begins with '\\x00"},
      {"only-keyword", "OFF", "the number of vertices is missing (a.off:1)"},
      {"only-comment", "# OFF\n", "the number of vertices is missing"},
      {"html", "<!DOCTYPE html>\n", "this is not OFF: it begins with '<!DOCTYPE' (a.off:1)"},
      {"lower-case", "off\n" + kCounts + kBody + kFace, "this is not OFF: it begins with 'off' (a.off:1)"},
      {"keyword-glued", "OFF" + kCounts + kBody + kFace, "reads 3 1"},
      {"keyword-glued-word", "OFFICE\n" + kCounts, "this is not OFF: it begins with 'OFFICE' (a.off:1)"},
      {"no-keyword", kCounts + kBody + kFace, "reads 3 1"},
      {"4off", "4OFF\n" + kCounts, "'4OFF' is a kind of OFF that is not read (a.off:1)"},
      {"noff-dimensions", "nOFF\n3\n" + kCounts, "'nOFF' is a kind of OFF that is not read (a.off:1)"},
      {"prefix-unknown", "XOFF\n" + kCounts, "'XOFF' is a kind of OFF that is not read (a.off:1)"},
      {"prefix-long", std::string(100000, 'N') + "XOFF\n" + kCounts, "is a kind of OFF that is not read (a.off:1)"},
      {"prefix-repeats", "CCCCOFF\n" + kCounts + kBody + kFace, "reads 3 1"},
      {"binary-empty", "OFF BINARY\n" + std::string(60, '\0'), "the file holds no vertex (a.off)"},
      {"count-words", with_counts("three one"), "the number of vertices is no whole number: 'three' (a.off:2)"},
      {"count-fraction", with_counts("3.5 1 0"), "no whole number: '3.5' (a.off:2)"},
      {"count-negative", with_counts("-3 1 0"), "the number of vertices is negative: -3 (a.off:2)"},
      {"count-zero", with_counts("0 0 0"), "the file holds no vertex (a.off)"},
      {"count-huge", with_counts("4294967295 1 0"), "the file is too short for 4294967295 vertices (a.off:2)"},
      {"count-largest", with_counts("9223372036854775807 1 0"),
       "the file is too short for 9223372036854775807 vertices (a.off:2)"},
      {"count-overflows", with_counts("18446744073709551617 1 0"), "no whole number: '18446744073709551617' (a.off:2)"},
      {"count-comma", with_counts("3,1,0"), "no whole number: '3,1,0' (a.off:2)"},
      {"faces-missing", "OFF\n3", "the file is too short for 3 vertices (a.off:2)"},
      {"faces-negative", with_counts("3 -1 0"), "the number of faces is negative: -1 (a.off:2)"},
      {"faces-huge", with_counts("3 4294967295 0"), "the file is too short for 4294967295 faces (a.off:2)"},
      {"faces-largest", with_counts("3 9223372036854775807 0"),
       "the file is too short for 9223372036854775807 faces (a.off:2)"},
      {"edges-word", with_counts("3 1 none"), "reads 3 1"},
      {"edges-negative", with_counts("3 1 -7"), "reads 3 1"},
      {"edges-missing", with_counts("3 1"), "reads 3 1"},
      {"count-line-long", with_counts("3 1 0 " + std::string(50000, '1')),
       "a coordinate is too large: '1111111111111111111111111111111111111111' (a.off:2)"},
      {"byte-order-mark", "\xef\xbb\xbf" + with_counts("3 1 0"), "reads 3 1"},
      {"crlf", "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n", "reads 3 1"},
      {"cr-only", "OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r", "reads 3 1"},
      {"utf-16", std::string("\xff\xfeO\0F\0F\0\n\0", 10), "this is not OFF: it begins with '\\xff\\xfeO"},
  };
}

std::vector<BadFile> vertices() {
  return {
      {"vertices-missing", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "missing"},
      {"vertex-short", "OFF\n2 0 0\n0 0 0\n0 0", "a coordinate is missing (a.off:4)"},
      {"vertex-word", with_vertex("0 zero 0"), "a coordinate is no number: 'zero' (a.off:3)"},
      {"vertex-nan", with_vertex("0 nan 0"), "a coordinate is not finite: 'nan' (a.off:3)"},
      {"vertex-inf", with_vertex("0 0 -infinity"), "a coordinate is not finite: '-infinity' (a.off:3)"},
      {"vertex-huge", with_vertex("1e999 0 0"), "a coordinate is too large: '1e999' (a.off:3)"},
      {"vertex-tiny", with_vertex("1e-999 0 0"), "reads 1 0"},
      {"vertex-largest", with_vertex("1e308 -1e308 1e-320"), "reads 1 0"},
      {"vertex-comma", with_vertex("0,5 0 0"), "a coordinate is no number: '0,5' (a.off:3)"},
      {"vertex-nul", with_vertex(std::string("0 \0 0", 5)), "a coordinate is no number: '\\x00' (a.off:3)"},
      {"vertex-binary", "OFF\n1 0 0\n\x01\x02\x03\x04 0 0\n",
       "a coordinate is no number: '\\x01\\x02\\x03\\x04' (a.off:3)"},
      {"vertex-more", with_vertex("0 0 0 5"),
       "reads 1 0; vertices with more or fewer numbers than the file's first word says x1"},
      {"vertex-fewer", with_vertex("0 0 0 1", "NOFF"),
       "reads 1 0; vertices with more or fewer numbers than the file's first word says x1"},
      {"vertex-long", with_vertex("0 0 0" + std::string(100000, ' ') + "1"),
       "reads 1 0; vertices with more or fewer numbers than the file's first word says x1"},
      {"color-beyond", with_vertex("0 0 0 256 0 0", "COFF"), "reads 1 0; colours beyond 0..255 x1"},
      {"color-negative", with_vertex("0 0 0 -1 0 0", "COFF"), "reads 1 0; colours beyond 0..255 x1"},
      {"color-word", with_vertex("0 0 0 red 0 0", "COFF"), "a value is no number: 'red' (a.off:3)"},
      {"color-huge", with_vertex("0 0 0 1e999 0 0", "COFF"), "a value is too large for its type: '1e999' (a.off:3)"},
      {"color-nan", with_vertex("0 0 0 nan nan nan", "COFF"), "reads 1 0"},
      {"normal-inf", with_vertex("0 0 0 inf 0 0", "NOFF"), "reads 1 0"},
  };
}

std::vector<BadFile> faces() {
  return {
      {"face-missing", with_face(""), "the number of corners of a face is missing"},
      {"face-cut-off", with_face("3 0 1"), "a vertex index is missing (a.off:6)"},
      {"face-none", with_face("0\n"), "a face has 0 corners (a.off:6)"},
      {"face-one", with_face("1 0\n"), "a face has 1 corners (a.off:6)"},
      {"face-two", with_face("2 0 1\n"), "a face has 2 corners (a.off:6)"},
      {"face-negative", with_face("-3 0 1 2\n"), "a face has -3 corners (a.off:6)"},
      {"face-huge", with_face("4294967299 0 1 2\n"), "a face has more corners than the file has bytes (a.off:6)"},
      {"face-corners-missing", with_face("6 0 1 2 0 1\n"), "a vertex index is missing"},
      {"face-word", with_face("3 0 1 b\n"), "a vertex index is no whole number: 'b' (a.off:6)"},
      {"face-fraction", with_face("3 0.0 1 2\n"), "a vertex index is no whole number: '0.0' (a.off:6)"},
      {"index-high", with_face("3 0 1 3\n"), "vertex index 3 does not exist (3 vertices) (a.off:6)"},
      {"index-negative", with_face("3 0 1 -1\n"), "vertex index -1 does not exist (3 vertices) (a.off:6)"},
      {"index-2-32", with_face("3 0 1 4294967296\n"), "vertex index 4294967296 does not exist"},
      {"index-2-64", with_face("3 0 1 18446744073709551616\n"), "no whole number"},
      {"index-from-one", with_face("3 1 2 3\n"), "vertex index 3 does not exist (3 vertices) (a.off:6)"},
      {"face-repeats", with_face("3 2 2 2\n"), "reads 3 1"},
      {"face-of-four", with_face("4 0 1 2 0\n"), "reads 3 1"},
      {"face-color-map", with_face("3 0 1 2 7\n"), "reads 3 1; face colours that are numbers of a colour map x1"},
      {"face-two-behind", with_face("3 0 1 2 7 7\n"), "reads 3 1; further numbers behind faces x1"},
      {"face-color-word", with_face("3 0 1 2 red 0 0\n"), "a value is no number: 'red' (a.off:6)"},
      {"face-color-beyond", with_face("3 0 1 2 0 999 0\n"), "reads 3 1; colours beyond 0..255 x1"},
      {"text-behind", with_face(kFace + "3 0 1 2\n"), "reads 3 1; text behind the last face x1"},
      {"nuls-behind", with_face(kFace + std::string(20, '\0')), "reads 3 1; text behind the last face x1"},
      {"face-before-counts", "OFF\n" + kFace + kCounts, "missing"},
  };
}

}  // namespace

std::vector<BadFile> bad_off_files() {
  std::vector<BadFile> all = headers();
  for (const auto& more : {vertices(), faces()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace ramcdb::test
