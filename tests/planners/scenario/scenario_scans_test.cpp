// Meshes, clouds and octrees in the environment of a scenario.

#include <locograph/world/octree.h>

#include <algorithm>
#include <sstream>

#include "planners/scenario_texts.h"
#include "world/synthetic_cloud.h"

namespace locograph {
namespace {

const std::string kScans =
    "<scenario version=\"1\" name=\"scans\">\n"  // line 1
    "<robot urdf=\"r.urdf\"/>\n"                 // 2
    "<end_effectors>\n"                          // 3
    "<end_effector name=\"foot\" link=\"sole\" kind=\"surface\" half_x=\"0.08\""
    " half_y=\"0.035\" max_force=\"1000\"/>\n"  // 4
    "</end_effectors>\n"                        // 5
    "<environment friction=\"0.8\">\n"          // 6
    "<mesh name=\"rocks\" file=\"rocks.stl\" position=\"1 2 3\" rpy=\"0 0 0.5\" scale=\"0.001\""
    " friction=\"0.4\"/>\n"                                            // 7
    "<cloud name=\"scan\" file=\"/scans/scan.pcd\" voxel=\"0.1\"/>\n"  // 8
    "<octomap name=\"hall\" file=\"maps/hall.bt\"/>\n"                 // 9
    "</environment>\n"                                                 // 10
    "<start><contact end_effector=\"foot\" position=\"0 0 0\" normal=\"0 0 1\"/></start>\n"
    "<goal><contact end_effector=\"foot\" position=\"1 0 0\" normal=\"0 0 1\"/></goal>\n"
    "</scenario>\n";

std::string only(const std::string& element) {
  const std::size_t from = kScans.find("<mesh"), to = kScans.find("</environment>");
  return kScans.substr(0, from) + element + "\n" + kScans.substr(to);
}

std::string pcd(const std::vector<Eigen::Vector3d>& points) {
  const std::string count = std::to_string(points.size());
  std::ostringstream text;
  text << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << count
       << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << count << "\nDATA ascii\n";
  for (const Eigen::Vector3d& p : points) text << p.transpose() << '\n';
  return text.str();
}

/// A rectangle of 1 m x 2 m, seen from above.
const char kStl[] =
    "solid a\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 2 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 2 0\nvertex 0 2 0\nendloop\nendfacet\n"
    "endsolid a\n";

/// Of kScans with this in its environment; data holds the files.
World world_with(const DataFolder& data, const std::string& element) {
  return world_of(scenario_of(data, only(element)));
}

/// What world_of() refuses the scenario with.
Error refusal(const DataFolder& data, const std::string& text) {
  const Scenario scenario = scenario_of(data, text);
  try {
    world_of(scenario);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "accepted";
  return Error("");
}

TEST(ScenarioScans, AreReadWithoutBeingOpenedAndTheirFilesAreRelativeToTheScenario) {
  const DataFolder data;
  const Scenario scenario = scenario_of(data, kScans);
  EXPECT_TRUE(scenario.surfaces.empty()) << "they are something to stand on all the same";
  ASSERT_EQ(scenario.scanned.size(), 3u);
  const ScannedSurface& mesh = scenario.scanned[0];
  EXPECT_EQ(mesh.kind, ScannedSurface::Kind::kMesh);
  EXPECT_EQ(mesh.name, "rocks");
  EXPECT_EQ(mesh.file, data.path() / "rocks.stl");
  EXPECT_EQ(mesh.world_from_mesh.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR(mesh.world_from_mesh.linear()(1, 0), std::sin(0.5), 1e-15);
  EXPECT_EQ(mesh.scale, 0.001);
  EXPECT_EQ(mesh.friction, 0.4);
  EXPECT_EQ(mesh.line, 7);
  const ScannedSurface& cloud = scenario.scanned[1];
  EXPECT_EQ(cloud.kind, ScannedSurface::Kind::kCloud);
  EXPECT_EQ(cloud.file, "/scans/scan.pcd");
  EXPECT_EQ(cloud.voxel_m, 0.1);
  EXPECT_EQ(cloud.friction, 0.0) << "what the end effector says";
  const ScannedSurface& octomap = scenario.scanned[2];
  EXPECT_EQ(octomap.kind, ScannedSurface::Kind::kOctomap);
  EXPECT_EQ(octomap.file, data.path() / "maps/hall.bt");
}

TEST(ScenarioScans, AMeshStaysWhereItIsAndACloudHasVoxelsOfFiveCentimetresUnlessTheyAreMoved) {
  const Scenario scenario =
      scenario_of(only("<mesh name=\"m\" file=\"m.stl\"/><cloud name=\"c\" file=\"c.pcd\"/>"));
  EXPECT_TRUE(scenario.scanned[0].world_from_mesh.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_EQ(scenario.scanned[0].scale, 1.0);
  EXPECT_EQ(scenario.scanned[1].voxel_m, 0.05);
}

TEST(ScenarioScans, WithoutFrictionOfTheEnvironmentTheyHaveToSayTheirOwn) {
  const std::string text =
      with(only("<mesh name=\"m\" file=\"m.stl\" friction=\"0.3\"/>"), " friction=\"0.8\"", "");
  EXPECT_EQ(scenario_of(text).end_effectors[0].friction, 0.3);
  expect_refused(text, {"", " friction=\"0.3\"", "", 7, "the friction of 'm' is not known"});
}

TEST(ScenarioScans, TheWorldHasTheRectanglesOfAMeshMovedAndScaled) {
  const DataFolder data;
  data.write("rocks.stl", kStl);
  const World world =
      world_with(data,
                 "<mesh name=\"rocks\" file=\"rocks.stl\" position=\"0 0 0.2\" scale=\"0.5\" "
                 "friction=\"0.4\"/>");
  ASSERT_EQ(world.surfaces.size(), 1u);
  const Surface& top = world.surfaces[0];
  EXPECT_EQ(top.name, "rocks 1");
  EXPECT_EQ(top.friction, 0.4);
  EXPECT_NEAR(top.world_from_surface.translation().z(), 0.2, 1e-6);
  EXPECT_GT(4.0 * top.half_x_m * top.half_y_m, 0.4);
  EXPECT_LT(4.0 * top.half_x_m * top.half_y_m, 0.5 + 1e-6);
}

TEST(ScenarioScans, TheWorldHasTheFlatPlacesAndBarsOfACloudBehindItsOwnSurfaces) {
  test::SyntheticCloud cloud(0.002);
  cloud.rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  cloud.bar({0.5, -0.4, 0.9}, {0.5, 0.4, 0.9}, 0.02);
  const DataFolder data;
  data.write("scan.pcd", pcd(cloud.points));
  const World world =
      world_with(data,
                 "<cloud name=\"scan\" file=\"scan.pcd\"/>"
                 "<plane name=\"stage\" center=\"3 0 0\" normal=\"0 0 1\" size=\"1 1\"/>");
  ASSERT_GE(world.surfaces.size(), 2u);
  EXPECT_EQ(world.surfaces[0].name, "stage");
  EXPECT_EQ(world.surfaces[1].name, "scan 1");
  EXPECT_GT(world.surfaces[1].world_from_surface.linear()(2, 2), 0.999);
  ASSERT_EQ(world.bars.size(), 1u);
  EXPECT_EQ(world.bars[0].name, "scan bar 1");
  EXPECT_NEAR(world.bars[0].radius_m, 0.02, 2e-3);
}

TEST(ScenarioScans, OctreesHaveNoSurfacesThatLookDownAndNoSmallOnes) {
  octomap::OcTree tree(0.1);
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y) {
      tree.updateNode(octomap::point3d(0.1f * static_cast<float>(x) + 0.05f,
                                       0.1f * static_cast<float>(y) + 0.05f, 0.55f),
                      true);
    }
  tree.updateNode(octomap::point3d(3.05f, 0.05f, 0.05f), true);  // 0.1 m x 0.1 m
  const DataFolder data;
  ASSERT_TRUE(tree.writeBinary(data.file("hall.bt").string()));
  const World world = world_with(data, "<octomap name=\"hall\" file=\"hall.bt\"/>");
  ASSERT_FALSE(world.surfaces.empty());
  bool top = false;
  for (const Surface& surface : world.surfaces) {
    EXPECT_EQ(surface.name.rfind("hall ", 0), 0u);
    const double up = surface.world_from_surface.linear()(2, 2);
    EXPECT_GT(up, -0.5) << surface.name;
    EXPECT_LT(surface.world_from_surface.translation().x(), 2.0) << "of the single voxel";
    top =
        top || (up > 0.999 && std::abs(surface.world_from_surface.translation().z() - 0.6) < 1e-6);
  }
  EXPECT_TRUE(top);
  ASSERT_NE(world.map, nullptr);
  EXPECT_NE(world.map->search(3.05, 0.05, 0.05), nullptr) << "it is in the way";
}

TEST(ScenarioScans, ADriveDoesNotStandOnTheGroundWhereThereIsAScan) {
  const DataFolder data;
  data.write("m.stl", kStl);
  const World world = world_of(
      scenario_of(data, drive_in("<environment friction=\"0.8\"><mesh name=\"m\" file=\"m.stl\"/>"
                                 "</environment>")));
  ASSERT_EQ(world.surfaces.size(), 1u);
  EXPECT_EQ(world.surfaces[0].name, "m 1");
}

TEST(ScenarioScans, AFileThatCannotBeUsedIsNamed) {
  const DataFolder data;
  const std::string cloud = only("<cloud name=\"scan\" file=\"scan.pcd\"/>");
  const std::string file = (data.path() / "scan.pcd").string();
  EXPECT_EQ(refusal(data, cloud).file(), file) << "it is not there";
  data.write("scan.pcd", "ply\n");
  EXPECT_EQ(refusal(data, cloud).file(), file);
  data.write("scan.pcd", pcd({{0.0, 0.0, 1e7}}));
  EXPECT_EQ(refusal(data, cloud).file(), file) << "further away than maps reach";
  EXPECT_EQ(refusal(data, only("<mesh name=\"m\" file=\"m.stl\"/>")).file(),
            (data.path() / "m.stl").string());
  EXPECT_EQ(refusal(data, only("<octomap name=\"o\" file=\"o.bt\"/>")).file(),
            (data.path() / "o.bt").string());
}

TEST(ScenarioScans, VoxelsThatDoNotSuitTheScanAreTheFaultOfTheScenariosLine) {
  const DataFolder data;
  data.write("scan.pcd", pcd({{0.0, 0.0, 0.0}, {900.0, 0.0, 0.0}}));
  const Error error =
      refusal(data, only("<cloud name=\"scan\" file=\"scan.pcd\" voxel=\"0.0001\"/>"));
  EXPECT_EQ(error.file(), (data.path() / "s.xml").string());
  EXPECT_EQ(error.line(), 7);
  const std::string what = error.what();
  EXPECT_NE(what.find((data.path() / "scan.pcd").string()), std::string::npos) << what;
  EXPECT_NE(what.find("expected larger voxels"), std::string::npos) << what;
}

TEST(ScenarioScans, OneWithNothingToStandOnIsTheFaultOfTheScenariosLine) {
  const DataFolder data;
  data.write("scan.pcd", pcd({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}));
  const Error error = refusal(data, only("<cloud name=\"scan\" file=\"scan.pcd\"/>"));
  EXPECT_EQ(error.file(), (data.path() / "s.xml").string());
  EXPECT_EQ(error.line(), 7);
  EXPECT_NE(std::string(error.what()).find("nothing to stand on"), std::string::npos)
      << error.what();
}

class BadScan : public testing::TestWithParam<Mistake> {};
TEST_P(BadScan, IsRefusedWithFileAndLine) { expect_refused(kScans, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    ScenarioScans, BadScan,
    testing::Values(
        Mistake{"AMeshWithoutAName", "name=\"rocks\" ", "", 7, "<mesh> without name"},
        Mistake{"ACloudWithoutAFile", "file=\"/scans/scan.pcd\" ", "", 8, "<cloud> without file"},
        Mistake{"AnOctomapWithAnEmptyFile", "maps/hall.bt", "", 9, "file"},
        Mistake{"TheSameNameTwice", "name=\"hall\"", "name=\"scan\"", 9, "a second 'scan'"},
        Mistake{"AMeshWithVoxels", "scale=\"0.001\"", "voxel=\"0.1\"", 7, "'voxel'"},
        Mistake{"ACloudThatIsMoved", "voxel=\"0.1\"", "position=\"0 0 1\"", 8, "'position'"},
        Mistake{"AnOctomapThatIsScaled", "name=\"hall\"", "name=\"hall\" scale=\"2\"", 9,
                "'scale'"},
        Mistake{"AMeshOfNoSize", "scale=\"0.001\"", "scale=\"0\"", 7, "scale is 0"},
        Mistake{"ATurnByTwoAngles", "rpy=\"0 0 0.5\"", "rpy=\"0 0\"", 7,
                "expected 3 finite numbers"},
        Mistake{"AMeshBeyondAllPlaces", "position=\"1 2 3\"", "position=\"1e7 2 3\"", 7,
                "position=\"1e7 2 3\""},
        Mistake{"VoxelsOfNothing", "voxel=\"0.1\"", "voxel=\"0\"", 8, "voxel is 0"},
        Mistake{"VoxelsLikeHouses", "voxel=\"0.1\"", "voxel=\"1000\"", 8, "0.0001 to 100"},
        Mistake{"FrictionOfNothing", "friction=\"0.4\"", "friction=\"0\"", 7, "friction is 0"}),
    mistake_name);

}  // namespace
}  // namespace locograph
