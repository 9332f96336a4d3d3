#include "tests/api/mesh_file/bad_files.h"

/// Broken OBJ. Lines are counted from 1: three vertices, then what is wrong in line 4.
namespace ramcdb::test {
namespace {

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kFace = "f 1 2 3\n";

/// Three vertices, these lines, and a face.
std::string before_face(const std::string& lines) { return kVertices + lines + kFace; }

std::string behind_vertices(const std::string& lines) { return kVertices + lines; }

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

std::vector<BadFile> vertices() {
  return {
      {"empty", "", "the file holds no vertex (a.obj)"},
      {"blank-lines", "\n\n\n", "the file holds no vertex (a.obj)"},
      {"nuls", std::string(64, '\0'), "the file holds no vertex (a.obj)"},
      {"html", "<!DOCTYPE html>\n<html>404</html>\n", "the file holds no vertex (a.obj)"},
      {"only-comment", "# v 0 0 0", "the file holds no vertex (a.obj)"},
      {"only-face", kFace, "vertex index 3 does not exist (0 vertices) (a.obj:1)"},
      {"v-empty", "v\n", "a coordinate is missing (a.obj:1)"},
      {"v-one", "v 1\n", "a coordinate is missing (a.obj:1)"},
      {"v-two", "v 1 2\n", "a coordinate is missing (a.obj:1)"},
      {"v-weight", "v 1 2 3 1\n", "reads 1 0; vertex weights x1"},
      {"v-five", "v 1 2 3 4 5\n", "reads 1 0; further numbers behind coordinates x1"},
      {"v-color", "v 1 2 3 0.5 0.5 0.5\n", "reads 1 0"},
      {"v-color-alpha", "v 1 2 3 0.5 0.5 0.5 1\n", "reads 1 0; vertex colours x1; vertex weights x1"},
      {"v-many", "v 1 2 3 4 5 6 7 8 9 10 11\n", "reads 1 0; further numbers behind coordinates x1"},
      {"v-color-word", "v 1 2 3 red green blue\n", "a value is no number: 'red' (a.obj:1)"},
      {"v-color-nan", "v 1 2 3 nan nan nan\n", "reads 1 0"},
      {"v-weight-word", "v 1 2 3 w\n", "reads 1 0; vertex weights x1"},
      {"v-nan", "v 1 nan 3\n", "a coordinate is not finite: 'nan' (a.obj:1)"},
      {"v-inf", "v 1 inf 3\n", "a coordinate is not finite: 'inf' (a.obj:1)"},
      {"v-ind", "v -1.#IND 0 0\n", "a coordinate is no number: '-1.#IND' (a.obj:1)"},
      {"v-huge", "v 1e999 2 3\n", "a coordinate is too large: '1e999' (a.obj:1)"},
      {"v-exponent-huge", "v 1e99999999999999999999 2 3\n",
       "a coordinate is too large: '1e99999999999999999999' (a.obj:1)"},
      {"v-tiny", "v 1e-999 2 3\n", "reads 1 0"},
      {"v-largest", "v 1.7976931348623157e308 -1.7976931348623157e308 4.9e-324\n", "reads 1 0"},
      {"v-comma", "v 1,5 2,5 3,5\n", "a coordinate is no number: '1,5' (a.obj:1)"},
      {"v-hex", "v 0x1p3 2 3\n", "a coordinate is no number: '0x1p3' (a.obj:1)"},
      {"v-two-signs", "v +-1 2 3\n", "a coordinate is no number: '+-1' (a.obj:1)"},
      {"v-plus", "v +1 2 3\n", "reads 1 0"},
      {"v-digits-many", "v 0." + std::string(50000, '7') + " 2 3\n", "reads 1 0"},
      {"v-word-long", "v " + std::string(50000, 'x') + " 2 3\n", "a coordinate is no number: '" + std::string(40, 'x')},
      {"v-non-ascii", "v \xc2\xbd 2 3\n", "a coordinate is no number: '\\xc2\\xbd' (a.obj:1)"},
      {"v-nul", std::string("v \0 2 3\n", 8), "a coordinate is no number: '\\x00' (a.obj:1)"},
      {"v-cut-off", "v 1 2 3\nv 1 2", "a coordinate is missing (a.obj:2)"},
      {"v-comment", "v 1 2 # 3\n", "a coordinate is missing (a.obj:1)"},
      {"v-capital", "V 1 2 3\n", "the file holds no vertex (a.obj)"},
      {"vp", "v 1 2 3\nvp 1 2\n", "reads 1 0; 'vp' lines x1"},
  };
}

std::vector<BadFile> faces() {
  return {
      {"f-empty", behind_vertices("f\n"), "a face has 0 corners (a.obj:4)"},
      {"f-one", behind_vertices("f 1\n"), "a face has 1 corners (a.obj:4)"},
      {"f-two", behind_vertices("f 1 2\n"), "a face has 2 corners (a.obj:4)"},
      {"f-zero", behind_vertices("f 0 1 2\n"), "vertex index 0 does not exist (3 vertices so far) (a.obj:4)"},
      {"f-high", behind_vertices("f 1 2 4\n"), "vertex index 4 does not exist (3 vertices) (a.obj:4)"},
      {"f-high-first", behind_vertices("f 9 2 1\n" + kFace), "vertex index 9 does not exist (3 vertices) (a.obj:4)"},
      {"f-low", behind_vertices("f 1 2 -4\n"), "vertex index -4 does not exist (3 vertices so far) (a.obj:4)"},
      {"f-2-32", behind_vertices("f 1 2 4294967296\n"), "vertex index 4294967296 does not exist"},
      {"f-2-32-more", behind_vertices("f 1 2 4294967297\n"), "vertex index 4294967297 does not exist"},
      {"f-least", behind_vertices("f 1 2 -9223372036854775808\n"), "vertex index -9223372036854775808 does not exist"},
      {"f-2-64", behind_vertices("f 1 2 18446744073709551617\n"), "no whole number: '18446744073709551617' (a.obj:4)"},
      {"f-word", behind_vertices("f 1 2 c\n"), "a vertex index is no whole number: 'c' (a.obj:4)"},
      {"f-fraction", behind_vertices("f 1.0 2.0 3.0\n"), "no whole number: '1.0' (a.obj:4)"},
      {"f-slash-only", behind_vertices("f / / /\n"), "a vertex index is missing (a.obj:4)"},
      {"f-texture-only", behind_vertices("f /1 /2 /3\n"), "a vertex index is missing (a.obj:4)"},
      {"f-before-v", kFace + kVertices, "reads 3 1"},
      {"f-negative-before-v", "f -1 -2 -3\n" + kVertices,
       "vertex index -1 does not exist (0 vertices so far) (a.obj:1)"},
      {"f-repeats", behind_vertices("f 1 1 1\n"), "reads 3 1"},
      {"f-four", behind_vertices("f 1 2 3 1\n"), "reads 3 1"},
      {"f-thousands", behind_vertices("f" + repeated(" 1 2 3", 2000) + "\n"), "reads 3 1"},
      {"f-three-slashes", behind_vertices("vt 0 0\nvn 0 0 1\nf 1/1/1/1 2/1/1/1 3/1/1/1\n"),
       "a corner has more than three indices: it ends with '/1/1/1' (a.obj:6)"},
      {"f-slash-behind", behind_vertices("f 1/ 2/ 3/\n"), "reads 3 1"},
      {"f-slashes-behind", behind_vertices("f 1// 2// 3//\n"), "reads 3 1"},
      {"f-texture-word", behind_vertices("f 1/a 2/b 3/c\n"),
       "texture coordinates (vt): an index is no whole number: 'a' (a.obj:4)"},
      {"f-texture-missing", behind_vertices("f 1/1 2/2 3/3\n"),
       "reads 3 1; corners that name texture coordinates (vt) that do not exist x3"},
      {"f-normal-zero", behind_vertices("vn 0 0 1\nf 1//0 2//1 3//1\n"),
       "reads 3 1; corners that name normals (vn) that do not exist x1"},
      {"f-normal-low", behind_vertices("vn 0 0 1\nf 1//-2 2//-1 3//-1\n"),
       "reads 3 1; corners that name normals (vn) that do not exist x1"},
      {"f-normal-huge", behind_vertices("vn 0 0 1\nf 1//99999999999 2//1 3//1\n"),
       "reads 3 1; corners that name normals (vn) that do not exist x1"},
      {"f-normal-least", behind_vertices("f 1//-9223372036854775808 2 3\n"),
       "reads 3 1; corners that name normals (vn) that do not exist x1"},
      {"f-cut-off", behind_vertices("f 1 2"), "a face has 2 corners (a.obj:4)"},
      {"f-comment", behind_vertices("f 1 2 # 3\n"), "a face has 2 corners (a.obj:4)"},
      {"f-commas", behind_vertices("f 1,2,3\n"), "no whole number: '1,2,3' (a.obj:4)"},
  };
}

std::vector<BadFile> tables_and_names() {
  return {
      {"vt-empty", before_face("vt\n"), "texture coordinates (vt) with 0 numbers, not 1 (a.obj:4)"},
      {"vt-four", before_face("vt 1 2 3 4\n"),
       "reads 3 1; texture coordinates (vt) x1; further numbers of texture coordinates (vt) x1"},
      {"vt-word", before_face("vt a b\n"), "a value is no number: 'a' (a.obj:4)"},
      {"vt-nan", before_face("vt nan nan\n"), "reads 3 1; texture coordinates (vt) x1"},
      {"vt-huge", before_face("vt 1e999 0\n"), "a value is too large for its type: '1e999' (a.obj:4)"},
      {"vt-one", behind_vertices("vt 0.5\nf 1/1 2/1 3/1\n"), "reads 3 1"},
      {"vn-empty", before_face("vn\n"), "normals (vn) with 0 numbers, not 3 (a.obj:4)"},
      {"vn-two", before_face("vn 0 1\n"), "normals (vn) with 2 numbers, not 3 (a.obj:4)"},
      {"vn-four", before_face("vn 0 0 1 1\n"), "reads 3 1; normals (vn) x1; further numbers of normals (vn) x1"},
      {"lines-unknown", before_face("l 1 2\np 1\ncurv 0 1 2\n"),
       "reads 3 1; 'l' lines x1; 'p' lines x1; 'curv' lines x1"},
      {"lines-binary", before_face("\x01\x02\x03 abc\n"), "reads 3 1; '\\x01\\x02\\x03' lines x1"},
      {"line-long", before_face(std::string(100000, 'q') + "\n"), "reads 3 1; '" + std::string(40, 'q') + "' lines x1"},
      {"usemtl-empty", before_face("usemtl\n"), "reads 3 1"},
      {"usemtl-unused", before_face("usemtl a\nusemtl b\n"), "reads 3 1; materials (usemtl) x1"},
      {"usemtl-long", before_face("usemtl " + std::string(100000, 'm') + "\n"), "reads 3 1"},
      {"usemtl-nul", before_face(std::string("usemtl a\0b\n", 11)), "reads 3 1"},
      {"mtllib-far", before_face("mtllib ../../../etc/passwd\n"), "reads 3 1"},
      {"groups-many", kVertices + repeated("g a\nf 1 2 3\ng b\nf 1 2 3\n", 1000), "reads 3 2000"},
      {"smoothing-word", before_face("s on\n"), "reads 3 1; 's' lines x1"},
      {"smoothing-negative", before_face("s -1\n"), "reads 3 1; 's' lines x1"},
      {"smoothing-huge", before_face("s 4294967296\n"), "reads 3 1; 's' lines x1"},
      {"continued-at-end", kVertices + "f 1 2 3 \\", "no whole number: '\\' (a.obj:4)"},
      {"continued", kVertices + "f 1 \\\n 2 \\\n 3\n", "reads 3 1"},
      {"continued-often", kVertices + "f" + repeated(" 1 \\\n", 5000) + " 2\n", "reads 3 1"},
      {"continued-comment", kVertices + "# c:\\\nf 1 2 3\n", "reads 3 1"},
      {"crlf", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "reads 3 1"},
      {"cr-only", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", "reads 3 1"},
      {"byte-order-mark", "\xef\xbb\xbf" + kVertices + kFace, "reads 3 1"},
      {"utf-16", std::string("\xff\xfev\0 \0\x30\0 \0\x30\0 \0\x30\0\n\0", 18), "the file holds no vertex (a.obj)"},
      {"no-newline", kVertices + "f 1 2 3", "reads 3 1"},
      {"tabs", "v\t0\t0\t0\nv\t1\t0\t0\nv\t0\t1\t0\nf\t1\t2\t3\n", "reads 3 1"},
      {"binary-file",
       std::string("\x7f"
                   "ELF\x02\x01\x01\0\0\0\0\0\0\0\0\0\n\x03\0\n",
                   20),
       "the file holds no vertex (a.obj)"},
  };
}

}  // namespace

std::vector<BadFile> bad_obj_files() {
  std::vector<BadFile> all = vertices();
  for (const auto& more : {faces(), tables_and_names()}) all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace ramcdb::test
