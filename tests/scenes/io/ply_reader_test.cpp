#include "scenes/io/ply/ply_reader.h"

#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/scenes/io/expect_input_error.h"
#include "tests/support/temp_folder.h"

namespace reemit {
namespace {

using test::expect_input_error;
using test::TempFolder;

Surface read_ply_text(const std::string& text) {
  const TempFolder folder;
  return read_ply(folder.write("mesh.ply", text)).surface;
}

constexpr const char* kHeader =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty double x\nproperty double y\n"
    "property double z\nproperty uchar red\nelement face 2\nproperty list uchar int vertex_indices\n"
    "property list uchar float weights\nelement edge 1\nproperty int vertex1\nend_header\n";
constexpr const char* kBody =
    "0 0 0 9\n1.00000000000001 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3 0\n3 0 2 1 2 5 6\n7\n";

TEST(PlyReader, ReadsPolygonsInDoublePrecisionAndSkipsTheRest) {
  const Surface surface = read_ply_text(std::string(kHeader) + kBody);
  ASSERT_EQ(surface.faces.size(), 2u);
  EXPECT_EQ(surface.faces[0].outer, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(surface.faces[1].outer, (std::vector<std::uint32_t>{0, 2, 1}));
  EXPECT_EQ(surface.positions[1].x(), 1.00000000000001);
  EXPECT_EQ(surface.faces[0].source_line, 19u);
  EXPECT_TRUE(surface.faces[0].normals.empty());
}

/// A triangle in binary, with every number in the byte order asked for.
std::string binary_triangle(bool big_endian) {
  std::string bytes = std::string("ply\nformat ") +
                      (big_endian ? "binary_big_endian" : "binary_little_endian") +
                      " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty double z\n"
                      "property float nx\nproperty float ny\nproperty float nz\n"
                      "element face 1\nproperty list uchar ushort vertex_index\nend_header\n";
  const auto put = [&](auto value) {
    char raw[sizeof(value)];
    std::memcpy(raw, &value, sizeof(value));
    if (big_endian) std::reverse(std::begin(raw), std::end(raw));
    bytes.append(raw, sizeof(value));
  };
  for (int i = 0; i < 3; ++i) {
    put(i == 1 ? 1.0f : 0.0f);
    put(i == 2 ? 1.0f : 0.0f);
    put(0.25);
    put(0.0f);
    put(0.0f);
    put(2.0f);
  }
  put(std::uint8_t{3});
  for (std::uint16_t i = 0; i < 3; ++i) put(i);
  return bytes;
}

TEST(PlyReader, ReadsBothByteOrdersAndNormals) {
  for (const bool big_endian : {false, true}) {
    const Surface surface = read_ply_text(binary_triangle(big_endian));
    ASSERT_EQ(surface.faces.size(), 1u);
    EXPECT_EQ(surface.positions[2], Vec3(0, 1, 0.25));
    ASSERT_EQ(surface.normals.size(), 3u);
    EXPECT_EQ(surface.normals[0], Vec3(0, 0, 1));
    EXPECT_EQ(surface.faces[0].normals, surface.faces[0].outer);
  }
}

TEST(PlyReader, LeavesOutWhatIsNoFaceAndSaysSo) {
  const TempFolder folder;
  const std::string text =
      "ply\nCreated by an old program\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
      "y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face "
      "2\nproperty list uchar int vertex_indices\nproperty uchar red\nend_header\n0 0 0 nan nan nan\n1 0 0 "
      "nan "
      "nan nan\n0 1 0 nan nan nan\n2 0 1 255\n3 0 1 2 255\n";
  const PlyMesh mesh = read_ply(folder.write("mesh.ply", text));
  ASSERT_EQ(mesh.surface.faces.size(), 1U);
  EXPECT_TRUE(mesh.surface.faces[0].normals.empty());
  EXPECT_THAT(mesh.warnings, testing::ElementsAre(testing::HasSubstr("the first is face 0"),
                                                  testing::HasSubstr("colours of faces")));
}

TEST(PlyReader, ReadsTriangleStrips) {
  const Surface surface = read_ply_text(
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float "
      "z\nelement "
      "tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n"
      "8 0 1 2 3 -1 1 4 3\n");
  ASSERT_EQ(surface.faces.size(), 3U);
  for (const Face& face : surface.faces) {
    const Vec3 a = surface.positions[face.outer[0]];
    const Vec3 b = surface.positions[face.outer[1]];
    const Vec3 c = surface.positions[face.outer[2]];
    EXPECT_GT((b - a).cross(c - a).z(), 0) << "all face the same way";
  }
}

TEST(PlyReader, AnyNumberBelowZeroBeginsAStrip) {
  const Surface surface = read_ply_text(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int double vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
      "7 0 1 -1e300 -inf 0 1 2\n");
  EXPECT_EQ(surface.faces.size(), 1U);
}

TEST(PlyReader, RefusesDamage) {
  const auto refused = [](const std::string& text, std::initializer_list<const char*> parts) {
    expect_input_error([&] { read_ply_text(text); }, parts);
  };
  refused("obj\n", {"mesh.ply:1", "does not start with"});
  refused("ply\nformat ascii 1.0\nelement vertex 3\n", {"does not end"});
  refused("ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n0\n",
          {"do not fit"});
  refused("ply\nformat ascii 1.0\nelement vertex 18446744073709551615\nproperty float x\nend_header\n0\n",
          {"do not fit"});
  refused("ply\nformat ascii 1.0\nelement vertex -1\nproperty float x\nend_header\n0\n", {"no count"});
  refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n0\n",
          {"mesh.ply:4", "no PLY type"});
  std::string text = std::string(kHeader) + kBody;
  refused(std::string(text).replace(text.find("4 0 1 2 3"), 9, "4 0 1 2 4"), {"mesh.ply:19", "vertex 4"});
  refused(std::string(text).replace(text.find("4 0 1 2 3"), 9, "4 0 1 2 x"), {"expected a number"});
  refused(std::string(text).replace(text.find("1 1 0 9"), 7, "1 nan 0 9"), {"not finite"});
  refused(std::string(text).replace(text.find("4 0 1 2 3 0\n"), 12, "99999 0 1 2\n"), {"does not fit"});
  refused(
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n0 0 0\n",
      {"no faces"});
  std::string little = binary_triangle(false);
  const std::size_t list = little.size() - 7;
  little[list] = static_cast<char>(250);
  refused(little, {"length 250"});
}

TEST(PlyReader, EveryTruncationIsRefused) {
  const TempFolder folder;
  for (const std::string& whole : {std::string(kHeader) + kBody, binary_triangle(false)}) {
    const std::size_t last = whole.back() == '\n' ? whole.size() - 2 : whole.size() - 1;
    for (std::size_t length = 1; length <= last; ++length) {
      const auto file = folder.write("cut.ply", whole.substr(0, length));
      EXPECT_THROW(read_ply(file), InputError) << length;
      std::filesystem::remove(file);
    }
  }
}

}  // namespace
}  // namespace reemit
