// `view --cameras` and `view --clouds`: what is in the page.
#include <apps/recorded_clouds.h>
#include <apps/view_test_support.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace locograph {
namespace {

constexpr int kFree = 1, kOccupied = 2;

/// Of a map, along x, then y, then z.
std::vector<int> states_of(const nlohmann::json& map) {
  std::vector<int> states;
  std::size_t run = 0;
  int shift = 0;
  for (const std::uint8_t byte : unpack<std::uint8_t>(map["states"])) {
    run |= static_cast<std::size_t>(byte & 127) << shift;
    shift += 7;
    if ((byte & 128) != 0) continue;
    states.insert(states.end(), run / 3, static_cast<int>(run % 3));
    run = 0;
    shift = 0;
  }
  return states;
}

struct Seen {
  std::vector<Eigen::Vector3d> kept, taken;
};

Seen points_of(const nlohmann::json& perception, const nlohmann::json& cloud) {
  const nlohmann::json& camera = perception["cameras"][cloud["camera"].get<std::size_t>()];
  const auto& pose = cloud["pose"];
  const Eigen::Quaterniond rotation(pose[6], pose[3], pose[4], pose[5]);
  const Eigen::Vector3d place(pose[0], pose[1], pose[2]);
  const std::vector<std::int16_t> depths = unpack<std::int16_t>(cloud["depths"]);
  const std::vector<std::uint8_t> places = unpack<std::uint8_t>(cloud["places"]);
  const int columns = camera["columns"], square = camera["square"], between = camera["between"];
  EXPECT_EQ(static_cast<int>(depths.size()), columns * camera["rows"].get<int>());
  EXPECT_EQ(places.size(), depths.size());
  Seen seen;
  for (int i = 0; i < static_cast<int>(depths.size()); ++i) {
    const int number = depths[static_cast<std::size_t>(i)];
    if (number == 0) continue;
    const double depth = 0.002 * std::abs(number);
    const auto slope = [&](int pixel, int axis) {
      return (pixel - camera["centre"][axis].get<double>()) / camera["focal"][axis].get<double>();
    };
    const int shown = places[static_cast<std::size_t>(i)];
    const Eigen::Vector3d point(slope(square * (i % columns) + between * (shown % 15), 0),
                                slope(square * (i / columns) + between * (shown / 15), 1), 1.0);
    (number > 0 ? seen.kept : seen.taken).push_back(place + rotation * (depth * point));
  }
  return seen;
}

/// A wall across the way, 3 m ahead.
const char kWall[] =
    "<obstacles version=\"1\"><box name=\"wall\" center=\"3.5 0 0.5\" size=\"0.2 3 1\"/>"
    "</obstacles>\n";

double to_wall(const Eigen::Vector3d& point) {
  const Eigen::AlignedBox3d wall(Eigen::Vector3d(3.4, -1.5, 0.0), Eigen::Vector3d(3.6, 1.5, 1.0));
  return wall.exteriorDistance(point);
}

TEST_F(ViewPlan, CamerasShowTheWallTheRobotAndTheFloorWhereTheyAre) {
  runner.write("wall.xml", kWall);
  const std::string command = "p.g2o --no-check --obstacles wall.xml --cameras --camera-rate 4";
  const nlohmann::json perception = view(runner, command)["perception"];
  EXPECT_LE(std::filesystem::file_size(runner.folder() / "page.html"), 4500000u);
  ASSERT_EQ(perception["cameras"].size(), 2u);
  EXPECT_EQ(perception["refused_images"], 0);
  EXPECT_EQ(perception["floor"], 0.05);
  ASSERT_EQ(perception["maps"].size(), 50u);
  EXPECT_EQ(perception["clouds"].size(), 100u);

  // At the beginning.
  std::map<int, int> places;
  int robot = 0, taken = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const nlohmann::json& cloud = perception["clouds"][i];
    EXPECT_LE(cloud["stamp"], 0.0);
    const Seen seen = points_of(perception, cloud);
    for (const Eigen::Vector3d& point : seen.kept) {
      ++places[to_wall(point) < 0.1 ? 1 : std::abs(point.z()) < 0.05 ? 2 : 0];
    }
    for (const Eigen::Vector3d& point : seen.taken) {
      robot += (point - Eigen::Vector3d(0.0, 0.0, 0.7)).norm() < 1.2 ? 1 : 0;
      ++taken;
    }
  }
  EXPECT_GT(places[1], 500) << "of the wall";
  EXPECT_GT(places[2], 2000) << "of the floor";
  EXPECT_LT(places[0], 0.05 * (places[1] + places[2])) << "pixels that fly, and noise far away";
  EXPECT_GT(taken, 20);
  EXPECT_GT(robot, 0.5 * taken) << "the others are beside it, and may fly";

  const nlohmann::json& map = perception["maps"][0];
  const std::vector<int> states = states_of(map);
  const std::vector<int> first = map["first"], size = map["size"];
  ASSERT_EQ(static_cast<int>(states.size()), size[0] * size[1] * size[2]);
  int occupied = 0;
  for (int i = 0; i < static_cast<int>(states.size()); ++i) {
    if (states[static_cast<std::size_t>(i)] != kOccupied) continue;
    ++occupied;
    const Eigen::Vector3d index(first[0] + i % size[0], first[1] + i / size[0] % size[1],
                                first[2] + i / (size[0] * size[1]));
    EXPECT_LT(to_wall(0.05 * (index + Eigen::Vector3d::Constant(0.5))), 0.1) << index.transpose();
  }
  EXPECT_GT(occupied, 500);
  EXPECT_GT(std::ranges::count(states, kFree), 50000);

  EXPECT_EQ(view(runner, command)["perception"], perception) << "the same bits again";
  EXPECT_NE(view(runner, command + " --seed 2")["perception"], perception);
}

TEST_F(ViewPlan, RecordedCloudsAreShownFromTheirTimesOn) {
  write_clouds(runner, "-0.5,D435i_camera,a.pcd\n1.5,D435i_camera,a.pcd\n900,D435i_camera,a.pcd");
  const Outcome outcome = runner.run("view p.g2o --no-check --clouds clouds -o page.html --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("clouds from 900 s on are not shown"), std::string::npos);
  EXPECT_EQ(outcome.json()["images"], 2);
  EXPECT_EQ(outcome.json()["clouds"], 2);
  const nlohmann::json perception = scene_of(runner.read("page.html"))["perception"];
  ASSERT_EQ(perception["clouds"].size(), 2u);
  EXPECT_EQ(perception["clouds"][0]["stamp"], -0.5);
  EXPECT_EQ(perception["clouds"][1]["stamp"], 1.5);
  EXPECT_GT(points_of(perception, perception["clouds"][1]).kept.size(), 400u);
  EXPECT_EQ(perception["maps"].size(), 2u) << "only where there is something new";
}

TEST_F(ViewPlan, CloudsThatShowNothingAreToldOf) {
  write_clouds(runner, "0.5,D435i_camera,a.pcd");
  std::string cloud = runner.read("clouds/a.pcd");
  cloud.resize(cloud.find("DATA ascii\n") + 11);
  for (int i = 0; i < 41 * 41; ++i) cloud += "nan nan nan\n";
  runner.write("clouds/a.pcd", cloud);
  const Outcome outcome = runner.run("view p.g2o --no-check --clouds clouds -o page.html --json");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.json()["blind_images"], 1);
  EXPECT_NE(outcome.err.find("1 image shows nothing"), std::string::npos) << outcome.err;
}

TEST_F(ViewPlan, RefusesCamerasAndCloudsThatItCannotShowInOneLine) {
  const auto refused = [&](const std::string& arguments, const std::string& place,
                           const std::string& words) {
    SCOPED_TRACE(arguments);
    expect_refusal(runner.run("view " + arguments + " -o x.html"), place, words);
    EXPECT_FALSE(runner.exists("x.html"));
  };
  refused("p.g2o --clouds nowhere", "nowhere/clouds.csv", "no such file");
  refused("p.g2o --clouds nowhere --cameras", "", "both --cameras and --clouds");
  refused("p.g2o --cameras --unknown slow", "", "--unknown slow");
  write_clouds(runner, "0.0,ear,a.pcd");
  refused("p.g2o --clouds clouds", "clouds/clouds.csv:2", "ear");
  write_clouds(runner, "0.0,D435i_camera,b.pcd");
  refused("p.g2o --clouds clouds", "clouds/clouds.csv:2", "b.pcd");
  write_clouds(runner, "100,D435i_camera,a.pcd");
  refused("p.g2o --clouds clouds", "clouds/clouds.csv", "after the end of the plan");
  runner.write("pose.g2o", "VERTEX_SE2 0 0 0 0\n");
  refused("pose.g2o --cameras", "pose.g2o", "--cameras has no plan to go with");
  refused("'" LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro.urdf' --clouds clouds",
          LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro.urdf",
          "--clouds has no plan to go with");
  ASSERT_EQ(runner.run("plan standing_up --stances-only -o stances.g2o").exit_code, 0);
  refused("stances.g2o --cameras", "stances.g2o", "nothing moves between stances");
}

TEST_F(ViewPlan, WritesOntoNoCloudThatItReads) {
  write_clouds(runner, "0.0,D435i_camera,a.pcd");
  for (const std::string file : {"clouds/clouds.csv", "clouds/a.pcd"}) {
    const std::string before = runner.read(file);
    expect_refusal(runner.run("view p.g2o --no-check --clouds clouds -o " + file), file,
                   "would be lost");
    EXPECT_EQ(runner.read(file), before);
  }
}

}  // namespace
}  // namespace locograph
