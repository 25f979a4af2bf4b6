#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/clouds_folder.h>
#include <locograph/world/perception/depth_png.h>

#include "common/temporary_folder.h"
#include "planners/mistakes.h"
#include "world/perception/pcd_text.h"
#include "world/perception/png_by_hand.h"

namespace locograph {
namespace {

using test::pcd_text;
using test::TemporaryFolder;

const std::string kList =
    "time_s,camera,file\n"     // line 1
    "0,head,a.pcd\n"           // 2
    "0,pelvis,images/b.png\n"  // 3
    "0.1,head,holes.pcd\n";    // 4

/// 2 x 1 pixels each.
std::vector<DepthCamera> two_cameras() {
  return {depth_camera("head", 0, 2, 1, 1.0), depth_camera("pelvis", 1, 2, 1, 1.0)};
}

void write_clouds(const TemporaryFolder& folder, const std::string& list) {
  folder.write("clouds.csv", list);
  folder.write("a.pcd", pcd_text(2, 1, "-0.5 0 2\n0.1 0 0.2\n"));
  folder.write("holes.pcd", pcd_text(2, 1, "nan nan nan\nnan nan nan\n"));
  folder.write("moved.pcd", pcd_text(2, 1, "-0.5 0 2\nnan 0 2\n", "0 0 1.2 1 0 0 0"));
  folder.write("cut.pcd", pcd_text(3, 1, "-0.5 0 2\n"));
  folder.write("images/b.png", "");
  save_depth_png(folder.file("images/b.png"),
                 {.stamp_s = 0.0, .width = 2, .height = 1, .depth_mm = {7000, 100}},
                 two_cameras()[1]);
}

TEST(CloudsFolder, LoadsCloudsAndImagesInTheirOrder) {
  const TemporaryFolder folder;
  write_clouds(folder, kList);
  const CloudsFolder clouds(folder.path(), two_cameras());
  ASSERT_EQ(clouds.size(), 3);
  EXPECT_EQ(clouds.stamp_s(2), 0.1);
  EXPECT_EQ(clouds.camera(1), 1);
  const DepthImage first = clouds.load(0), second = clouds.load(1);
  EXPECT_EQ(first.camera, 0);
  EXPECT_EQ(first.depth_mm, (std::vector<std::uint16_t>{2000, 0}))
      << "20 cm are nearer than the range";
  EXPECT_EQ(second.camera, 1);
  EXPECT_EQ(second.depth_mm, (std::vector<std::uint16_t>{7000, 0}))
      << "7 m are beyond the range, and say that it is free";
}

TEST(CloudsFolder, ACloudOfHolesIsAnImageThatSeesNothing) {
  const TemporaryFolder folder;
  write_clouds(folder, kList);
  const DepthImage image = CloudsFolder(folder.path(), two_cameras()).load(2);
  EXPECT_EQ(image.stamp_s, 0.1);
  EXPECT_EQ(pixels_seen(image), 0);
}

TEST(CloudsFolder, ACloudWithoutPointsIsAnImageThatSeesNothing) {
  const TemporaryFolder folder;
  write_clouds(folder, kList);
  folder.write("holes.pcd", pcd_text(0, 1, ""));
  const DepthImage image = CloudsFolder(folder.path(), two_cameras()).load(2);
  EXPECT_EQ(image.depth_mm.size(), 2u);
  EXPECT_EQ(pixels_seen(image), 0);
}

TEST(CloudsFolder, TheFirstLineEmptyLinesAndBlanksMayBeThereOrNot) {
  const TemporaryFolder folder;
  write_clouds(folder, "\r\n 0 , head , a.pcd \r\n\n1e-1,pelvis,./images/../images/b.png");
  const CloudsFolder clouds(folder.path(), two_cameras());
  EXPECT_EQ(clouds.size(), 2);
  EXPECT_EQ(clouds.load(0).depth_mm[0], 2000);
}

class BadList : public testing::TestWithParam<Mistake> {};

TEST_P(BadList, IsRefusedWithItsLine) {
  const TemporaryFolder folder;
  write_clouds(folder, with(kList, GetParam().find, GetParam().replace));
  expect_refused(folder.file("clouds.csv"), GetParam(),
                 [&](const auto&) { CloudsFolder(folder.path(), two_cameras()); });
}

INSTANTIATE_TEST_SUITE_P(
    All, BadList,
    testing::Values(
        Mistake{"NothingInIt", kList.c_str(), "time_s,camera,file\n", 0, "lists no cloud"},
        Mistake{"OtherColumns", "time_s,camera,file", "camera,time_s,file", 1,
                "time_s is 'camera'"},
        Mistake{"TwoColumns", "0,head,a.pcd", "0,head", 2, "not three columns"},
        Mistake{"NoFile", "a.pcd", "", 2, "not three columns"},
        Mistake{"ATimeWithAUnit", "0.1,", "0.1s,", 4, "time_s is '0.1s'"},
        Mistake{"ATimeThatIsNone", "0.1,", "nan,", 4, "time_s is 'nan'"},
        Mistake{"ATimeSinceTheEpoch", "0.1,", "1700000000,", 4, "at most 1000000"},
        Mistake{"OutOfOrder", "0.1,", "-0.1,", 4, "is before that of the line above"},
        Mistake{"TwiceAtOneTime", "0.1,head", "0,head", 4, "a second image of 'head'"},
        Mistake{"AnUnknownCamera", "0.1,head", "0.1,haed", 4,
                "unknown camera 'haed', expected one of head, pelvis; did you mean 'head'?"},
        Mistake{"AMissingFile", "holes.pcd", "hole.pcd", 4, "there is no file 'hole.pcd'"},
        Mistake{"AFolder", "holes.pcd", "images.pcd", 4, "there is no file"},
        Mistake{"APathOutOfTheFolder", "a.pcd", "images/../../a.pcd", 2, "outside of the folder"},
        Mistake{"AnAbsolutePath", "a.pcd", "/tmp/a.pcd", 2, "outside of the folder"},
        Mistake{"AnotherKindOfFile", "a.pcd", "a.ply", 2, "expected .pcd or .png"}),
    mistake_name);

TEST(CloudsFolder, WithoutAListOrWithoutCamerasIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(CloudsFolder(folder.path(), two_cameras()), Error);
  write_clouds(folder, kList);
  EXPECT_THROW(CloudsFolder(folder.path(), {}), Error);
  EXPECT_THROW(CloudsFolder(folder.file("a.pcd"), two_cameras()), Error);
}

/// What is wrong with the first of the list.
std::string cloud_error(const TemporaryFolder& folder, const std::string& file) {
  const CloudsFolder clouds(folder.path(), two_cameras());
  try {
    clouds.load(0);
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), folder.file(file).string());
    return error.what();
  }
  ADD_FAILURE() << file << " was accepted";
  return "";
}

TEST(CloudsFolder, CloudsThatCannotBeItsCamerasAreErrorsWithTheirName) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& file, const std::string& what) {
    write_clouds(folder, "0.5,head," + file + "\n");
    const std::string error = cloud_error(folder, file);
    EXPECT_NE(error.find(what), std::string::npos) << error;
  };
  refused("cut.pcd", "truncated");
  refused("moved.pcd", "the viewpoint of the cloud is not 0 0 0 1 0 0 0");
  refused("images/b.png", "its own stamp is 0.000000 s");
  const auto saved = [&](const DepthCamera& camera) {
    save_depth_png(folder.file("c.png"),
                   {.stamp_s = 0.5, .width = 2, .height = 1, .depth_mm = {1000, 0}}, camera);
  };
  saved(two_cameras()[0]);
  write_clouds(folder, "0.5,head,c.png\n");
  EXPECT_EQ(CloudsFolder(folder.path(), two_cameras()).load(0).depth_mm[0], 1000);
  saved(two_cameras()[1]);
  refused("c.png", "an image of the camera 'pelvis', expected 'head'");
  saved(depth_camera("head", 0, 2, 1, 1.1));
  refused("c.png", "an image of another lens");
  folder.write("c.png", test::png_by_hand({.width = 3}, test::grey_row({1, 2, 3})));
  refused("c.png", "3 x 1 pixels, expected 2 x 1 of head");
}

TEST(CloudsFolder, ThePublicCloudsAreImages) {
  const std::filesystem::path data = std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "point_clouds";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is missing";
  const TemporaryFolder folder;
  for (const char* name : {"table_scene_0.pcd", "table_scene_1.pcd"}) {
    std::filesystem::create_symlink(std::filesystem::canonical(data / name), folder.file(name));
  }
  folder.write("clouds.csv", "0,kinect,table_scene_0.pcd\n0.1,kinect,table_scene_1.pcd\n");
  DepthCamera camera = depth_camera("kinect", 0, 640, 480, 1.0);
  camera.fx = camera.fy = 525.0;
  const CloudsFolder clouds(folder.path(), {camera});
  EXPECT_EQ(pixels_seen(clouds.load(0)), 182292) << "every finite point, pixel by pixel";
  EXPECT_EQ(pixels_seen(clouds.load(1)), 208763);
}

}  // namespace
}  // namespace locograph
