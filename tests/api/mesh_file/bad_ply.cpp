#include <limits>

#include "tests/api/mesh_file/bad_files.h"
#include "tests/api/mesh_file/files.h"

/// Broken PLY. What lies behind the header begins in line 9 when there are vertices with x, y, z and faces.
namespace ramcdb::test {
namespace {

const std::string kAscii = "ply\nformat ascii 1.0\n";
const std::string kLittle = "ply\nformat binary_little_endian 1.0\n";
const std::string kBig = "ply\nformat binary_big_endian 1.0\n";
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kVertices = "element vertex 3\n" + kXyz;
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kEnd = "end_header\n";
const std::string kBody = "0 0 0\n1 0 0\n0 1 0\n";

/// Three vertices and a face in text; `header` behind the face's list.
std::string text(const std::string& lines, const std::string& header = "") {
  return kAscii + kVertices + kFace + header + kEnd + kBody + lines;
}

/// Text with these vertex lines and no face.
std::string vertices(const std::string& lines, const std::string& header = "") {
  return kAscii + "element vertex 1\n" + kXyz + header + kEnd + lines;
}

/// The nine coordinates of three vertices.
std::string corners(bool big_endian = false) {
  std::string bytes;
  for (const float value : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) bytes += bytes_of(value, big_endian);
  return bytes;
}

std::string indices(std::int32_t a, std::int32_t b, std::int32_t c) {
  return '\x03' + bytes_of(a) + bytes_of(b) + bytes_of(c);
}

std::string binary(const std::string& faces, const std::string& header = kFace) {
  return kLittle + kVertices + header + kEnd + corners() + faces;
}

std::string list(const std::string& types) { return "element face 1\nproperty list " + types + " vertex_indices\n"; }

const float kFloatNan = std::numeric_limits<float>::quiet_NaN();

std::vector<BadFile> headers() {
  return {
      {"empty", "", "this is not PLY (a.ply:0)"},
      {"one-nul", std::string(1, '\0'), "this is not PLY (a.ply:1)"},
      {"only-magic", "ply", "the header does not end (a.ply:1)"},
      {"other-magic", "plyx\nformat ascii 1.0\n" + kVertices + kEnd, "this is not PLY (a.ply:1)"},
      {"magic-in-capitals", "PLY\nformat ascii 1.0\n" + kVertices + kEnd + kBody, "this is not PLY (a.ply:1)"},
      {"html", "<!DOCTYPE html>\n<html>404</html>\n", "this is not PLY (a.ply:1)"},
      {"gzip", "\x1f\x8b\x08\x00", "this is not PLY (a.ply:1)"},
      {"utf-16", std::string("\xff\xfep\0l\0y\0\n\0", 10), "this is not PLY (a.ply:1)"},
      {"no-end", kAscii + kVertices, "the header does not end (a.ply:6)"},
      {"end-in-capitals", kAscii + kVertices + "END_HEADER\n", "unknown header line 'END_HEADER' (a.ply:7)"},
      {"no-format", "ply\n" + kVertices + kEnd + kBody, "the header names no format (a.ply:6)"},
      {"format-twice", kAscii + "format ascii 1.0\n" + kVertices + kEnd + kBody, "the format stands twice (a.ply:3)"},
      {"format-unknown", "ply\nformat binary 1.0\n" + kVertices + kEnd, "unknown encoding 'binary' (a.ply:2)"},
      {"format-empty", "ply\nformat\n" + kVertices + kEnd, "unknown encoding '' (a.ply:2)"},
      {"format-2", "ply\nformat ascii 2.0\n" + kVertices + kEnd + kBody, "reads 3 0"},
      {"format-after-elements", "ply\n" + kVertices + "format ascii 1.0\n" + kEnd + kBody, "reads 3 0"},
      {"no-vertex", kAscii + kFace + kEnd + "3 0 1 2\n", "the file has no element 'vertex' (a.ply:5)"},
      {"no-elements", kAscii + kEnd, "the file has no element 'vertex' (a.ply:3)"},
      {"no-z", kAscii + "element vertex 1\nproperty float x\nproperty float y\n" + kEnd + "0 0\n",
       "vertices have no x, y and z (a.ply:6)"},
      {"z-is-a-list",
       kAscii + "element vertex 1\nproperty float x\nproperty float y\nproperty list uchar float z\n" + kEnd + "0 0 0",
       "vertices have no x, y and z (a.ply:7)"},
      {"xyz-in-capitals",
       kAscii + "element vertex 1\nproperty float X\nproperty float Y\nproperty float Z\n" + kEnd + "0 0 0\n",
       "vertices have no x, y and z (a.ply:7)"},
      {"x-twice", kAscii + "element vertex 1\nproperty float x\n" + kXyz + kEnd + "0 0 0 0\n",
       "property 'x' stands twice (a.ply:5)"},
      {"value-twice", vertices("0 0 0 1 2\n", "property float q\nproperty float q\n"), "reads 1 0"},
      {"indices-twice",
       kAscii + kVertices + kFace + "property list uchar int vertex_index\n" + kEnd + kBody + "3 0 1 2 3 0 1 2\n",
       "property 'vertex_index' stands twice (a.ply:9)"},
      {"element-twice", kAscii + kVertices + kVertices + kEnd + kBody + kBody,
       "element 'vertex' stands twice (a.ply:7)"},
      {"element-without-count", kAscii + "element vertex\n" + kXyz + kEnd,
       "the count of an element is missing (a.ply:3)"},
      {"element-without-name", kAscii + "element\n" + kXyz + kEnd, "the count of an element is missing (a.ply:3)"},
      {"count-no-number", kAscii + "element vertex many\n" + kXyz + kEnd,
       "the count of an element is no whole number: 'many' (a.ply:3)"},
      {"count-fraction", kAscii + "element vertex 3.5\n" + kXyz + kEnd, "no whole number: '3.5' (a.ply:3)"},
      {"count-hex", kAscii + "element vertex 0x3\n" + kXyz + kEnd, "no whole number: '0x3' (a.ply:3)"},
      {"count-negative", kAscii + "element vertex -1\n" + kXyz + kEnd, "the count of an element is negative (a.ply:3)"},
      {"count-overflows", kAscii + "element vertex 18446744073709551617\n" + kXyz + kEnd, "no whole number"},
      {"count-huge", kAscii + "element vertex 9223372036854775807\n" + kXyz + kEnd + kBody,
       "the file is cut off: no room for 9223372036854775807 of 'vertex' (a.ply, byte"},
      {"count-huge-wraps", kLittle + "element vertex 1537228672809129302\n" + kXyz + kEnd + corners(),
       "no room for 1537228672809129302 of 'vertex'"},
      {"faces-huge",
       kAscii + kVertices + "element face 4294967295\nproperty list uchar int vertex_indices\n" + kEnd + kBody +
           "3 0 1 2\n",
       "no room for 4294967295 of 'face'"},
      {"other-huge", kAscii + kVertices + "element camera 999999999999\nproperty float a\n" + kEnd + kBody,
       "no room for 999999999999 of 'camera'"},
      {"other-without-properties", kAscii + kVertices + "element camera 999999999999\n" + kEnd + kBody,
       "element 'camera' has no property (a.ply:8)"},
      {"vertex-zero", kAscii + "element vertex 0\n" + kXyz + kEnd, "the file holds no vertex (a.ply)"},
      {"vertex-zero-face-one", kAscii + "element vertex 0\n" + kXyz + kFace + kEnd + "3 0 0 0\n",
       "vertex index 0 does not exist (0 vertices) (a.ply:10)"},
      {"face-zero-no-list", kAscii + kVertices + "element face 0\n" + kEnd + kBody, "reads 3 0"},
      {"face-no-list", kAscii + kVertices + "element face 1\nproperty int vertex_indices\n" + kEnd + kBody + "3\n",
       "faces have no list vertex_indices of integers (a.ply:9)"},
      {"face-list-of-floats", kAscii + kVertices + list("uchar float") + kEnd + kBody + "3 0 1 2\n",
       "faces have no list vertex_indices of integers (a.ply:9)"},
      {"face-count-float", kAscii + kVertices + list("float int") + kEnd + kBody + "3 0 1 2\n",
       "the count type of a list must be an integer (a.ply:8)"},
      {"type-unknown", kAscii + "element vertex 1\nproperty quad x\n" + kEnd, "unknown type 'quad' (a.ply:4)"},
      {"type-missing", kAscii + "element vertex 1\nproperty\n" + kEnd, "unknown type '' (a.ply:4)"},
      {"type-non-ascii", kAscii + "element vertex 1\nproperty fl\xc3\xb6t x\n" + kEnd,
       "unknown type 'fl\\xc3\\xb6t' (a.ply:4)"},
      {"list-of-list", kAscii + kVertices + list("uchar list uchar int") + kEnd, "unknown type 'list' (a.ply:8)"},
      {"name-missing", kAscii + "element vertex 1\nproperty float\n" + kEnd, "a property has no name (a.ply:4)"},
      {"name-control", kAscii + "element vertex 1\nproperty uint ramcdb_id\x1fhi\n" + kEnd,
       "the name of a property holds a control character: 'ramcdb_id\\x1fhi' (a.ply:4)"},
      {"property-first", kAscii + "property float x\n" + kVertices + kEnd,
       "a property stands before any element (a.ply:3)"},
      {"strips",
       kAscii + kVertices + "element tristrips 1\nproperty list int int vertex_indices\n" + kEnd + kBody +
           "4 0 1 2 -1\n",
       "triangle strips are not read: convert them to faces (a.ply:9)"},
      {"line-unknown", kAscii + "obj_infos\n" + kVertices + kEnd, "unknown header line 'obj_infos' (a.ply:3)"},
      {"line-nul", kAscii + std::string("a\0b\n", 4) + kVertices + kEnd, "unknown header line 'a\\x00b' (a.ply:3)"},
      {"line-long", kAscii + std::string(100000, 'z') + "\n" + kVertices + kEnd,
       "unknown header line '" + std::string(40, 'z') + "' (a.ply:3)"},
      {"comment-long", kAscii + "comment " + std::string(100000, 'z') + "\n" + kVertices + kEnd + kBody, "reads 3 0"},
      {"crlf",
       "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\n"
       "property float z\r\nend_header\r\n1 2 3\r\n",
       "reads 1 0"},
      {"cr-only", "ply\rformat ascii 1.0\relement vertex 1\rproperty float x\rend_header\r1 2 3\r",
       "vertices have no x, y and z (a.ply:5)"},
      {"byte-order-mark", "\xef\xbb\xbf" + text("3 0 1 2\n"), "reads 3 1"},
      {"crlf-binary",
       "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 3\r\nproperty float x\r\n"
       "property float y\r\nproperty float z\r\nend_header\r\n" +
           corners(),
       "reads 3 0"},
  };
}

std::vector<BadFile> text_bodies() {
  std::string thousand;
  for (int i = 0; i < 300; ++i) thousand += "property float p" + std::to_string(i) + "\n";
  return {
      {"body-missing", kAscii + kVertices + kEnd, "no room for 3 of 'vertex'"},
      {"body-short", text(""), "no room for 1 of 'face'"},
      {"body-cut-in-face", text("3 0 1   \n"), "a value is missing (a.ply:13)"},
      {"face-one-corner", text("1 0 0 0 0 0\n"), "a face has 1 corners (a.ply:13)"},
      {"face-no-corner", text("0 0 0 0 0 0\n"), "a face has 0 corners (a.ply:13)"},
      {"face-negative-corners", text("-3 0 1 2\n"), "-3 is negative (a.ply:13)"},
      {"face-huge-corners", text("4294967295 0 1 2\n"),
       "the file is cut off: no room for the 4294967295 corners of a face (a.ply:13)"},
      {"face-fraction-corners", text("3.0 0 1 2\n"), "a value is no whole number: '3.0' (a.ply:13)"},
      {"index-high", text("3 0 1 3\n"), "vertex index 3 does not exist (3 vertices) (a.ply:13)"},
      {"index-negative", text("3 0 1 -1\n"), "-1 is negative (a.ply:13)"},
      {"index-2-32", text("3 0 1 4294967296\n"), "vertex index 4294967296 does not exist"},
      {"index-2-64", text("3 0 1 18446744073709551616\n"), "no whole number"},
      {"index-word", text("3 0 1 two\n"), "a value is no whole number: 'two' (a.ply:13)"},
      {"face-of-four", text("4 0 1 2 0\n"), "reads 3 1"},
      {"face-repeats", text("3 1 1 1\n"), "reads 3 1"},
      {"behind", text("3 0 1 2\n3 0 1 2\n"), "reads 3 1; bytes behind the last element x1"},
      {"nan", vertices("0 nan 0\n"), "a value is not finite: 'nan' (a.ply:8)"},
      {"inf", vertices("0 -inf 0\n"), "a value is not finite: '-inf' (a.ply:8)"},
      {"too-large", vertices("1e999 0 0\n"), "a value is too large: '1e999' (a.ply:8)"},
      {"too-small", vertices("1e-999 0 0\n"), "reads 1 0"},
      {"beyond-float", vertices("1e300 0 0\n"), "reads 1 0"},
      {"comma", vertices("0,5 1 2\n"), "a value is no number: '0,5' (a.ply:8)"},
      {"hex", vertices("0x10 0 0\n"), "a value is no number: '0x10' (a.ply:8)"},
      {"binary-in-ascii", kAscii + kVertices + kEnd + corners(), "a value is no number"},
      {"nul-in-number", vertices(std::string("0 \0\x31 0\n", 7)), "a value is no number: '\\x001' (a.ply:8)"},
      {"digits-many", vertices("0." + std::string(50000, '3') + " 0 0\n"), "reads 1 0"},
      {"one-line", vertices("0 0 0"), "reads 1 0"},
      {"uchar-256", vertices("0 0 0 256\n", "property uchar q\n"),
       "'256' is no number of the type of its property (a.ply:9)"},
      {"uchar-negative", vertices("0 0 0 -1\n", "property uchar q\n"), "'-1' is no number of the type of its property"},
      {"uchar-nan", vertices("0 0 0 nan\n", "property uchar q\n"), "(a.ply:9)"},
      {"float-huge", vertices("0 0 0 1e99\n", "property float q\n"),
       "a value is too large for its type: '1e99' (a.ply:9)"},
      {"list-of-vertex", vertices("0 0 0 2 7 7\n", "property list uchar int tail\n"),
       "reads 1 0; vertex property 'tail' (list of int) x1"},
      {"list-of-vertex-huge", vertices("0 0 0 9999999999 7 7\n", "property list uint int tail\n"),
       "the file is cut off (a.ply:9)"},
      {"texcoord-wrong", text("3 0 1 2 5 1 2 3 4 5\n", "property list uchar float texcoord\n"),
       "reads 3 1; lists 'texcoord' without two numbers per corner x1"},
      {"texcoord-huge", text("3 0 1 2 999999999 1 2\n", "property list uint float texcoord\n"),
       "the file is cut off: no room for the 999999999 numbers of a list 'texcoord' (a.ply:14)"},
      {"properties-many", vertices("0 0 0", thousand), "no room for 1 of 'vertex'"},
      {"id-too-large", vertices("0 0 0 4294967296 0\n", "property uint ramcdb_id_hi\nproperty uint ramcdb_id_lo\n"),
       "4294967296 is no half of a vertex id (a.ply:10)"},
  };
}

std::vector<BadFile> binary_bodies() {
  return {
      {"binary-short-vertices", kLittle + kVertices + kEnd + corners().substr(1), "no room for 3 of 'vertex'"},
      {"binary-short-face", binary(indices(0, 1, 2).substr(0, 12)), "no room for 1 of 'face'"},
      {"binary-corners-255", binary("\xff" + indices(0, 1, 2)),
       "the file is cut off: no room for the 255 corners of a face (a.ply, byte 206)"},
      {"binary-corners-negative", binary("\xff" + indices(0, 1, 2), list("char int")), "-1 is negative (a.ply, byte"},
      {"binary-corners-2-32", binary(bytes_of(0xffffffffU) + indices(0, 1, 2), list("uint int")),
       "the file is cut off: no room for the 4294967295 corners of a face (a.ply, byte"},
      {"binary-index-high", binary(indices(0, 1, 3)), "vertex index 3 does not exist (3 vertices) (a.ply, byte"},
      {"binary-index-negative", binary(indices(0, 1, -1)), "-1 is negative (a.ply, byte"},
      {"binary-face-of-two", binary("\x02" + bytes_of(0) + bytes_of(1) + bytes_of(2)),
       "a face has 2 corners (a.ply, byte"},
      {"binary-nan", kLittle + "element vertex 1\n" + kXyz + kEnd + bytes_of(0.F) + bytes_of(kFloatNan) + bytes_of(0.F),
       "vertex 0 has a coordinate that is not finite (a.ply)"},
      {"binary-big-read-as-little", kLittle + kVertices + kFace + kEnd + corners(true) + indices(0, 1, 2), "reads 3 1"},
      {"binary-little-read-as-big", kBig + kVertices + kFace + kEnd + corners() + indices(0, 1, 2),
       "vertex index 16777216 does not exist"},
      {"ascii-in-binary", kLittle + "element vertex 1\n" + kXyz + kEnd + "0.5 1.25 -1\n", "reads 1 0"},
      {"binary-behind", binary(indices(0, 1, 2) + "\n"), "reads 3 1; bytes behind the last element x1"},
      {"binary-face-first", kLittle + kFace + kVertices + kEnd + indices(0, 1, 2) + corners(), "reads 3 1"},
      {"binary-list-of-vertex-huge",
       kLittle + "element vertex 1\n" + kXyz + "property list uint double tail\n" + kEnd + std::string(12, '\0') +
           bytes_of(0xffffffffU),
       "the file is cut off (a.ply, byte"},
      {"binary-other-huge-lists",
       kLittle + kVertices + "element e 2\nproperty list uint int a\n" + kEnd + corners() + bytes_of(0x40000000U) +
           bytes_of(0x40000000U),
       "the file is cut off (a.ply, byte"},
      {"binary-texcoord-huge",
       binary(indices(0, 1, 2) + bytes_of(0xfffffff0U), kFace + "property list uint double texcoord\n"),
       "the file is cut off: no room for the 4294967280 numbers of a list 'texcoord' (a.ply, byte"},
  };
}

}  // namespace

std::vector<BadFile> bad_ply_files() {
  std::vector<BadFile> all = headers();
  for (const auto& more : {text_bodies(), binary_bodies()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace ramcdb::test
