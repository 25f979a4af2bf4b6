#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/world/point_cloud.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

using test::TemporaryFolder;

std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                   int points, const std::string& data) {
  const std::string count = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
         sizes + "\nTYPE " + types + "\nWIDTH " + count +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA " + data + "\n";
}

template <typename Number>
std::string bytes(Number number) {
  std::string out(sizeof number, '\0');
  std::memcpy(out.data(), &number, sizeof number);
  return out;
}

std::string error_text(const std::filesystem::path& path) {
  try {
    load_point_cloud(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), path.string());
    return error.what();
  }
  ADD_FAILURE() << path << " was accepted";
  return "";
}

TEST(PointCloud, ReadsTextWithOtherFieldsInAnyPlace) {
  const TemporaryFolder folder;
  const auto points = load_point_cloud(
      folder.write("a.pcd", header("rgb z label x y", "4 4 4 4 8", "F F U F F", 3, "ascii") +
                                "0 3 9 1 2\n\n1e-3 -1.5 9 +4 nan\r\n7 6.5 9 4 5.25\n"));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(points[1], Eigen::Vector3d(4, 5.25, 6.5));
}

TEST(PointCloud, ReadsBinaryOfFloatsAndDoublesWithoutPointsThatAreNotFinite) {
  const TemporaryFolder folder;
  std::string data;
  for (const double x : {0.5, std::nan(""), 1.0 / 3.0}) {
    data += bytes<std::uint16_t>(7) + bytes(x) + bytes(2.5f) + bytes(-1.0f);
  }
  const std::string text = header("ring x y z", "2 8 4 4", "U F F F", 3, "binary");
  const auto points = load_point_cloud(folder.write("a.pcd", text + data));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0], Eigen::Vector3d(0.5, 2.5, -1.0));
  EXPECT_EQ(points[1].x(), 1.0 / 3.0);
  for (std::size_t size = 0; size < data.size(); size += 7) {
    EXPECT_NE(error_text(folder.write("cut.pcd", text + data.substr(0, size))).find("truncated"),
              std::string::npos);
  }
}

// Two points (1, 2, 2), field after field: x as literals, the rest as copies of what is out.
std::string compressed() {
  const std::string x = bytes(1.0f) + bytes(1.0f), two = bytes(2.0f);
  std::string lzf = std::string(1, 7) + x + std::string(1, 3) + two;
  lzf += std::string("\xe0\x03\x03", 3);  // 7 + 3 + 2 = 12 bytes from 4 back
  return bytes<std::uint32_t>(static_cast<std::uint32_t>(lzf.size())) + bytes<std::uint32_t>(24) +
         lzf;
}

TEST(PointCloud, ReadsCompressedDataWithCopiesThatOverlap) {
  const TemporaryFolder folder;
  const std::string text = header("x y z", "4 4 4", "F F F", 2, "binary_compressed");
  const auto points = load_point_cloud(folder.write("a.pcd", text + compressed()));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0], Eigen::Vector3d(1, 2, 2));
  EXPECT_EQ(points[1], Eigen::Vector3d(1, 2, 2));
}

TEST(PointCloud, DamagedCompressedDataIsAnErrorWhateverByteItIs) {
  const TemporaryFolder folder;
  const std::string text = header("x y z", "4 4 4", "F F F", 2, "binary_compressed");
  const std::string data = compressed();
  for (std::size_t size = 0; size < data.size(); ++size) {
    error_text(folder.write("cut.pcd", text + data.substr(0, size)));
  }
  for (std::size_t i = 0; i < data.size(); ++i) {
    std::string damaged = data;
    damaged[i] = static_cast<char>(0xff);
    try {
      load_point_cloud(folder.write("damaged.pcd", text + damaged));
    } catch (const Error&) {
      continue;
    }
  }
  std::string bomb =
      bytes<std::uint32_t>(4) + bytes<std::uint32_t>(0xfffffff0u) + "\xff\xff\xff\xff";
  EXPECT_NE(error_text(folder.write("bomb.pcd", header("x y z", "4 4 4", "F F F", 357913940,
                                                       "binary_compressed") +
                                                    bomb))
                .find("damaged"),
            std::string::npos);
}

TEST(PointCloud, HeadersThatLieAreErrorsWithTheirLine) {
  const TemporaryFolder folder;
  const std::string good = header("x y z", "4 4 4", "F F F", 1, "ascii");
  const auto error_with = [&](const std::string& old, const std::string& by) {
    std::string text = good;
    text.replace(text.find(old), old.size(), by);
    return error_text(folder.write("bad.pcd", text + "1 2 3\n"));
  };
  const auto expect = [&](const std::string& old, const std::string& by, const std::string& line,
                          const std::string& what) {
    const std::string text = error_with(old, by);
    EXPECT_NE(text.find("bad.pcd:" + line + ":"), std::string::npos) << text;
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  expect("FIELDS x y z", "FIELDS x y w", "3", "no field z");
  expect("FIELDS x y z", "FIELDS x x z", "3", "several fields x");
  expect("SIZE 4 4 4", "SIZE 4 4", "4", "SIZE of 2 fields");
  expect("SIZE 4 4 4", "SIZE 4 2 4", "3", "field y");
  expect("SIZE 4 4 4", "SIZE 4 3 4", "4", "SIZE 3");
  expect("SIZE 4 4 4", "SIZE 4 99999999999999999999 4", "4", "SIZE 9999");
  expect("TYPE F F F", "TYPE F F I", "3", "field z");
  expect("TYPE F F F", "TYPE F F D", "5", "TYPE D");
  expect("WIDTH 1\n", "COUNT 1 1 0\nWIDTH 1\n", "6", "COUNT 0");
  expect("WIDTH 1\n", "COUNT 1 1 888888888888\nWIDTH 1\n", "6", "COUNT 888888888888");
  expect("WIDTH 1\n", "WIDTH -1\n", "6", "unreadable WIDTH");
  expect("WIDTH 1\n", "WIDTH 2\nWIDTH 1\n", "7", "second WIDTH");
  expect("HEIGHT 1\n", "HEIGHT 0\n", "9", "POINTS is not");
  expect("HEIGHT 1\n", "HIGHT 1\n", "7", "unknown header entry 'HIGHT'");
  expect("HEIGHT 1\n", "", "9", "no HEIGHT");
  expect("POINTS 1\n", "POINTS 18446744073709551615\n", "9", "POINTS is not");
  expect("DATA ascii", "DATA ply", "10", "unknown kind of data");
  expect("WIDTH 1\nHEIGHT 1", "WIDTH 18446744073709551615\nHEIGHT 2", "7", "more than any file");
}

TEST(PointCloud, PromisesOfTheHeaderAreNotBelieved) {
  const TemporaryFolder folder;
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    const std::string text = header("x y z", "8 8 8", "F F F", 2147483647, data);
    const std::string error = error_text(folder.write("huge.pcd", text + "1 2 3\n"));
    EXPECT_NE(error.find("truncated"), std::string::npos) << error;
  }
}

TEST(PointCloud, BadTextIsAnErrorWithItsLine) {
  const TemporaryFolder folder;
  const std::string text = header("x y z", "4 4 4", "F F F", 2, "ascii");
  const auto expect = [&](const std::string& data, const std::string& line,
                          const std::string& what) {
    const std::string error = error_text(folder.write("bad.pcd", text + data));
    EXPECT_NE(error.find("bad.pcd:" + line + ": " + what), std::string::npos) << error;
  };
  expect("1 2 3\n1 2\n", "12", "a point of 2 numbers, expected 3");
  expect("1 2 3\n1 2 3m\n", "12", "unreadable coordinate '3m'");
  expect("1 2 3\n", "11", "truncated: 1 points");
  expect("1 2 3\n1 2 3\n\n1 2 3\n", "14", "more points than the header says");
}

TEST(PointCloud, FilesWithoutAPointAndForeignOnesAreErrors) {
  const TemporaryFolder folder;
  const auto has = [&](const std::string& text, const std::string& what) {
    const std::string error = error_text(folder.write("a.pcd", text));
    EXPECT_NE(error.find(what), std::string::npos) << error;
  };
  has("", "is empty");
  has("solid", "not a PCD file");
  has("VERSION 0.7\nFIELDS x y z\n", "truncated in the header");
  has(header("x y z", "4 4 4", "F F F", 0, "ascii"), "holds no finite point");
  has(header("x y z", "4 4 4", "F F F", 1, "ascii") + "nan nan nan\n", "holds no finite point");
  EXPECT_NE(error_text(folder.file("none.pcd")).find("cannot be opened"), std::string::npos);
}

std::string organised(const std::string& viewpoint) {
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 3\n" + viewpoint +
         "DATA ascii\n1 2 3\nnan nan nan\n4 5 6\n7 nan 9\n1 inf 1\n0 0 0\n";
}

TEST(PointCloud, AnOrganisedCloudKeepsItsRowsAndItsHoles) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.pcd", organised(""));
  const PointCloud cloud = read_point_cloud(file);
  EXPECT_EQ(cloud.width, 2u);
  EXPECT_EQ(cloud.height, 3u);
  ASSERT_EQ(cloud.points.size(), 6u);
  EXPECT_EQ(cloud.points[2], Eigen::Vector3d(4, 5, 6));
  for (const std::size_t hole : {1u, 3u, 4u}) EXPECT_FALSE(cloud.points[hole].allFinite()) << hole;
  EXPECT_TRUE(cloud.viewpoint.matrix().isIdentity()) << "there is none in the file";
  EXPECT_EQ(load_point_cloud(file).size(), 3u);
}

TEST(PointCloud, ACloudOfHolesIsReadAndHasNoPoints) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("a.pcd", header("x y z", "4 4 4", "F F F", 1, "ascii") + "nan nan nan\n");
  EXPECT_EQ(read_point_cloud(file).points.size(), 1u);
  EXPECT_THROW(load_point_cloud(file), Error);
}

TEST(PointCloud, ACloudWithoutPointsIsReadAndHasNone) {
  const TemporaryFolder folder;
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    const std::string text = header("x y z", "4 4 4", "F F F", 0, data);
    EXPECT_TRUE(read_point_cloud(folder.write("a.pcd", text)).points.empty()) << data;
  }
  const std::string text = header("x y z", "4 4 4", "F F F", 0, "ascii") + "1 2 3\n";
  EXPECT_THROW(read_point_cloud(folder.write("a.pcd", text)), Error) << "more than it says";
}

TEST(PointCloud, TheViewpointIsReadWhereItIsAskedFor) {
  const TemporaryFolder folder;
  const double half = std::sqrt(0.5);
  const PointCloud cloud =
      read_point_cloud(folder.write("a.pcd", organised("VIEWPOINT 1 2 3 " + std::to_string(half) +
                                                       " 0 0 " + std::to_string(half) + "\n")));
  EXPECT_EQ(Eigen::Vector3d(cloud.viewpoint.translation()), Eigen::Vector3d(1, 2, 3));
  EXPECT_LT((cloud.viewpoint.linear().col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-6);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, 2, 3)) << "points are as stored";
  for (const char* viewpoint : {"", "0 0 0 1 0 0", "0 0 0 0 0 0 0", "0 0 0 2 0 0 0",
                                "0 0 nan 1 0 0 0", "0 0 0 1 0 0 x", "0 0 0 1 0 0 0 0"}) {
    const auto file =
        folder.write("bad.pcd", organised("VIEWPOINT " + std::string(viewpoint) + "\n"));
    try {
      read_point_cloud(file);
      ADD_FAILURE() << viewpoint << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.line(), 7) << error.what();
    }
    EXPECT_EQ(load_point_cloud(file).size(), 3u) << "surfaces need none";
  }
}

TEST(PointCloud, ReadsThePublicClouds) {
  const std::filesystem::path clouds =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "point_clouds";
  if (!std::filesystem::exists(clouds)) GTEST_SKIP() << clouds << " is missing";
  EXPECT_EQ(load_point_cloud(clouds / "table_scene_0.pcd").size(), 182292u);
  EXPECT_EQ(load_point_cloud(clouds / "table_scene_1.pcd").size(), 208763u);
  const PointCloud table = read_point_cloud(clouds / "table_scene_0.pcd");
  EXPECT_EQ(table.width, 640u);
  EXPECT_EQ(table.height, 480u);
  EXPECT_EQ(table.points.size(), 307200u);
  const auto terrain = load_point_cloud(clouds / "terrain_samp11.pcd");
  EXPECT_EQ(terrain.size(), 38010u);
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& point : terrain) bounds.extend(point);
  EXPECT_LT(bounds.sizes().maxCoeff(), 400.0);
  EXPECT_GT(bounds.min().y(), 5.4e6);
}

}  // namespace
}  // namespace locograph
