#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <limits>
#include <locale>

#include "ramcdb/error.h"
#include "tests/api/mesh_file/files.h"
#include "tests/support/meshes.h"

/// What the writer wrote, the reader reads: every bit of every coordinate.
namespace ramcdb::test {
namespace {

using mesh_file::Format;
using mesh_file::MeshData;
using mesh_file::MeshOutput;
using mesh_file::Scalar;

/// Numbers that are hard to print: small, large, with all digits, signed zeros; floats when asked.
TestMesh hard_numbers(Scalar scalar) {
  TestMesh mesh = terrain(20, 30);
  std::uint64_t state = 1;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    for (int a = 0; a < 3; ++a) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      const double any = std::bit_cast<double>((state & 0x800fffffffffffffU) | (0x3c0 + (state >> 20) % 0x80) << 52);
      double& value = mesh.positions[i][a];
      if (i % 2) value = any;
      if (scalar == Scalar::float32) value = static_cast<float>(value);
    }
  using F = std::numeric_limits<float>;
  using D = std::numeric_limits<double>;
  if (scalar == Scalar::float32) {
    mesh.positions[0] = {-0.0, F::denorm_min(), F::max()};
    mesh.positions[1] = {0.0, -F::min(), -F::max()};
  } else {
    mesh.positions[0] = {-0.0, D::denorm_min(), D::max()};
    mesh.positions[1] = {0.0, -D::min(), -D::max()};
  }
  return mesh;
}

/// What a program that keeps float32 makes of these.
std::vector<Point> as_floats(std::vector<Point> points) {
  for (Point& p : points)
    for (int a = 0; a < 3; ++a) p[a] = static_cast<double>(static_cast<float>(p[a]));
  return points;
}

struct Case {
  const char* name;
  Scalar scalar;
  bool ascii;
};

class RoundTrip : public testing::TestWithParam<Case> {};

TEST_P(RoundTrip, KeepsEveryBit) {
  const auto [name, scalar, ascii] = GetParam();
  const TestMesh mesh = hard_numbers(scalar);
  const MeshData read = write_and_read(name, output_of(mesh.positions, mesh.faces, scalar), ascii);
  EXPECT_TRUE(is_sound(read));
  const bool text = ascii || mesh_file::format_of(name) != Format::ply;
  EXPECT_EQ(bits(text && scalar == Scalar::float32 ? as_floats(read.positions) : read.positions), bits(mesh.positions));
  EXPECT_EQ(triangles(read), mesh.faces);
  EXPECT_TRUE(read.face_sizes.empty());
  EXPECT_TRUE(read.dropped.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Files, RoundTrip,
    testing::Values(Case{"binary_float.ply", Scalar::float32, false}, Case{"binary_double.ply", Scalar::float64, false},
                    Case{"ascii_float.ply", Scalar::float32, true}, Case{"ascii_double.ply", Scalar::float64, true},
                    Case{"float.obj", Scalar::float32, false}, Case{"double.obj", Scalar::float64, false},
                    Case{"float.off", Scalar::float32, false}, Case{"double.off", Scalar::float64, false}),
    [](const auto& test) {
      std::string name = test.param.name;
      name[name.size() - 4] = '_';
      return name;
    });

TEST(RoundTripText, ShortDoublesStayDoubles) {
  const std::vector<Triangle> faces{{0, 1, 2}};
  const std::vector<Point> tenths{{0.5, 0, 0}, {0.1, 0.2, 562345.1}, {0, std::nextafter(0.5, 1), 0.3}};
  const std::vector<Point> rounds_well{{128.602, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}};  // 128.602 with %.17g
  for (const auto& positions : {tenths, rounds_well})
    for (const char* name : {"a.obj", "a.off", "a.ply"}) {
      const MeshData read = write_and_read(name, output_of(positions, faces, Scalar::float64), true);
      EXPECT_EQ(bits(read.positions), bits(positions)) << name;
    }
}

TEST(ForeignText, NumbersAreTheNearestDoublesInEveryFormat) {
  const std::vector<Point> expected{{562345.1, 0.1, 1e-310}, {123456789.123456789, -562345.1, 0}, {-0.1, 1, -1e-310}};
  const std::string lines[] = {"562345.1 0.1 1e-310\n", "123456789.123456789 -562345.1 0\n", "-0.1 1 -1e-310\n"};
  std::string rows, v_rows, vertex_rows;
  for (const std::string& line : lines) {
    rows += line;
    v_rows += "v " + line;
    vertex_rows += "vertex " + line;
  }
  const auto ply = [&](const std::string& type) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty " + type + " x\nproperty " + type + " y\nproperty " +
           type + " z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n" + rows + "3 0 1 2\n";
  };
  const std::pair<const char*, std::string> all[] = {
      {"float.ply", ply("float")},
      {"double.ply", ply("double")},
      {"a.obj", v_rows + "f 1 2 3\n"},
      {"a.off", "OFF\n3 1 0\n" + rows + "3 0 1 2\n"},
      {"a.stl", "solid\nfacet normal 0 0 1\nouter loop\n" + vertex_rows + "endloop\nendfacet\nendsolid\n"}};
  for (const auto& [name, text] : all) EXPECT_EQ(bits(read_text(name, text).positions), bits(expected)) << name;
}

TEST(RoundTripStl, KeepsEveryCorner) {
  const TestMesh mesh = hard_numbers(Scalar::float32);
  const MeshData read = write_and_read("a.stl", output_of(mesh.positions, mesh.faces, Scalar::float32), false);
  ASSERT_EQ(read.face_count(), mesh.faces.size());
  EXPECT_TRUE(read.soup);
  EXPECT_TRUE(read.dropped.empty());
  std::vector<Point> expected;
  for (const Triangle& t : mesh.faces)
    for (const std::uint32_t v : t) expected.push_back(mesh.positions[v]);
  EXPECT_EQ(bits(read.positions), bits(expected));
}

TEST(RoundTripIds, EveryBitOfAnIdStays) {
  const TestMesh mesh = boxes(3);
  std::vector<std::uint64_t> ids(mesh.positions.size());
  for (std::size_t v = 0; v < ids.size(); ++v) ids[v] = 0xfedcba9876543210U * (v + 1);
  ids[0] = 0;
  ids[1] = ~std::uint64_t{0};
  for (const bool ascii : {false, true}) {
    MeshOutput out = output_of(mesh.positions, mesh.faces, Scalar::float64);
    out.vertex_ids = ids;
    const MeshData read = write_and_read("ids.ply", out, ascii);
    EXPECT_EQ(read.vertex_ids, ids);
    EXPECT_EQ(bits(read.positions), bits(mesh.positions));
    EXPECT_EQ(triangles(read), mesh.faces);
  }
}

TEST(RoundTripIds, FloatsKeepTheirIds) {
  const TestMesh mesh = hard_numbers(Scalar::float32);
  const std::vector<std::uint64_t> ids(mesh.positions.size(), 0xfffffffffffffffdU);
  MeshOutput out = output_of(mesh.positions, mesh.faces, Scalar::float32);
  out.vertex_ids = ids;
  const MeshData read = write_and_read("ids.ply", out, false);
  EXPECT_EQ(read.vertex_ids, ids);
  EXPECT_EQ(bits(read.positions), bits(mesh.positions));
}

TEST(RoundTripColors, FaceColoursComeBackFromPly) {
  const TestMesh mesh = boxes(2);
  const std::vector<mesh_file::FaceColor> colors(mesh.faces.size(), {1, 200, 255});
  MeshOutput out = output_of(mesh.positions, mesh.faces, Scalar::float32);
  out.face_colors = colors;
  Attribute color = attribute("color", AttributeOf::face, NumberType::uint8, 3, Meaning::color, {});
  for (std::size_t f = 0; f < colors.size(); ++f) color.values.insert(color.values.end(), {1, 200, 255});
  for (const bool ascii : {false, true}) {
    const MeshData read = write_and_read("colors.ply", out, ascii);
    EXPECT_EQ(triangles(read), mesh.faces);
    expect_same(read.attributes, {color});
  }
}

/// A locale with a decimal comma, also where none is installed.
class CommaLocale {
 public:
  CommaLocale() {
    struct Comma : std::numpunct<char> {
      char do_decimal_point() const override { return ','; }
      char do_thousands_sep() const override { return '.'; }
      std::string do_grouping() const override { return "\3"; }
    };
    std::locale::global(std::locale(std::locale::classic(), new Comma));
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8"})
      if (!installed_ && std::setlocale(LC_ALL, name)) installed_ = name;
  }
  ~CommaLocale() {
    std::locale::global(std::locale::classic());
    std::setlocale(LC_ALL, "C");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  [[nodiscard]] const char* installed() const { return installed_; }

 private:
  const char* installed_ = nullptr;
};

TEST(RoundTripLocale, DecimalCommaDoesNotMatter) {
  const CommaLocale locale;
  if (!locale.installed()) std::printf("no C locale with a decimal comma is installed: only the C++ one was set\n");
  const TestMesh mesh = hard_numbers(Scalar::float64);
  for (const char* name : {"a.ply", "a.obj", "a.off"}) {
    const MeshData read = write_and_read(name, output_of(mesh.positions, mesh.faces, Scalar::float64), true);
    EXPECT_EQ(bits(read.positions), bits(mesh.positions)) << name;
    EXPECT_EQ(triangles(read), mesh.faces) << name;
  }
}

TEST(Writer, RefusesCoordinatesThatTheFileCannotHold) {
  const TempFolder scratch;
  const auto file = scratch / "large.stl";
  write_bytes(file, "what was there");
  const std::vector<Triangle> faces{{0, 1, 2}};
  for (const double wrong : {1e39, -1e300, std::nan(""), HUGE_VAL}) {
    const std::vector<Point> positions{{0, 0, 0}, {1, 0, 0}, {0, wrong, 0}};
    for (const Format format : {Format::ply, Format::obj, Format::off, Format::stl})
      EXPECT_THROW(mesh_file::write_mesh(file, format, output_of(positions, faces, Scalar::float32)), Error) << wrong;
  }
  EXPECT_EQ(read_bytes(file), "what was there");
}

TEST(Writer, RefusesFacesAndAttributesThatAreNone) {
  const TempFolder scratch;
  const MeshData good = polygon_grid(2);
  const std::size_t v = good.positions.size(), c = good.corners.size();
  const auto with = [&](Attribute attribute) {
    MeshData mesh = good;
    mesh.attributes = {std::move(attribute)};
    return mesh;
  };
  const auto values = [](AttributeOf of, NumberType type, std::vector<double> numbers) {
    return attribute("a", of, type, 1, Meaning::other, std::move(numbers));
  };
  std::vector<MeshData> wrong{with(values(AttributeOf::vertex, NumberType::float32, std::vector<double>(v - 1, 0))),
                              with(values(AttributeOf::corner, NumberType::float32, std::vector<double>(c + 1, 0))),
                              with(values(AttributeOf::face, NumberType::float32, std::vector<double>(v, 0))),
                              with(values(AttributeOf::vertex, NumberType::uint8, std::vector<double>(v, 256))),
                              with(values(AttributeOf::vertex, NumberType::int8, std::vector<double>(v, -129))),
                              with(values(AttributeOf::vertex, NumberType::uint32, std::vector<double>(v, 0.5))),
                              with(values(AttributeOf::vertex, NumberType::int32, std::vector<double>(v, HUGE_VAL))),
                              with(values(AttributeOf::vertex, NumberType::float32, std::vector<double>(v, 0.1))),
                              with(values(AttributeOf::vertex, NumberType::float32, std::vector<double>(v, 1e300))),
                              good,
                              good,
                              good,
                              good,
                              good,
                              good,
                              good};
  wrong[9].attributes = {attribute("a", AttributeOf::vertex, NumberType::uint8, 0, Meaning::other, {})};
  wrong[10].attributes = {
      attribute("a", AttributeOf::vertex, NumberType::uint8, 17, Meaning::other, std::vector<double>(17 * v, 0))};
  wrong[11].attributes = {values(AttributeOf::vertex, NumberType::uint8, std::vector<double>(v, 0))};
  wrong[11].attributes[0].info.fields = {"a", "b"};
  wrong[12].attributes = {values(AttributeOf::vertex, NumberType::uint8, std::vector<double>(v, 1))};
  wrong[12].attributes[0].info.names = {"only"};
  wrong[13].corners.pop_back();
  wrong[14].corners[5] = static_cast<std::uint32_t>(v);
  wrong[15].face_sizes[0] = 2;
  wrong[15].face_sizes[1] = 5;
  for (std::size_t i = 0; i < wrong.size(); ++i)
    for (const Format format : {Format::ply, Format::obj, Format::off, Format::stl})
      EXPECT_THROW(mesh_file::write_mesh(scratch / "a", format, output_of(wrong[i], Scalar::float64)), Error) << i;
  EXPECT_FALSE(std::filesystem::exists(scratch / "a"));
}

TEST(Writer, LeavesNothingBehindWhereItCannotWrite) {
  const TempFolder scratch;
  const TestMesh mesh = boxes(1);
  EXPECT_THROW(mesh_file::write_mesh((scratch / "none") / "a.ply", Format::ply,
                                     output_of(mesh.positions, mesh.faces, Scalar::float32)),
               Error);
  std::filesystem::create_directory(scratch / "a.ply");
  EXPECT_THROW(
      mesh_file::write_mesh(scratch / "a.ply", Format::ply, output_of(mesh.positions, mesh.faces, Scalar::float32)),
      Error);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.folder()), {}), 1);
}

TEST(Writer, ReplacesTheFileAndLeavesNoOther) {
  const TempFolder scratch;
  const TestMesh mesh = boxes(1);
  const auto file = scratch / "a.ply";
  write_bytes(file, "older");
  mesh_file::write_mesh(file, Format::ply, output_of(mesh.positions, mesh.faces, Scalar::float32));
  EXPECT_EQ(mesh_file::read_mesh(file).face_count(), mesh.faces.size());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.folder()), {}), 1);
}

}  // namespace
}  // namespace ramcdb::test
