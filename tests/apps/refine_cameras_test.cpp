// `refine --cameras` and `refine --clouds`, as a user runs them.
#include <apps/recorded_clouds.h>
#include <locograph/world/octree.h>

namespace locograph {
namespace {

/// A folder with the shipped drive as plan.g2o.
class CameraRunner : public CommandRunner {
 public:
  CameraRunner() {
    const Outcome outcome = run("plan centauro_drive -o plan.g2o");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  void write_map(const std::string& name, double x_m = 2.0) const {
    Box box;
    box.world_from_box.translation() = Eigen::Vector3d(x_m, 3.0, 0.25);
    box.size.setConstant(0.5);
    save_octree(*octree_from_boxes({&box, 1}, 0.05), folder() / name);
  }
};

TEST(RefineCameras, TellsWhatTheCamerasSaw) {
  const CameraRunner runner;
  runner.write("box.xml",
               "<obstacles version=\"1\"><box name=\"box\" center=\"2 0 0.25\" size=\"0.5 0.5 "
               "0.5\"/></obstacles>\n");
  const std::string command =
      "refine plan.g2o --obstacles box.xml --cameras --camera-rate 3 --save-map seen.bt ";
  const Outcome outcome = runner.run(command + "-o out.g2o --json");
  EXPECT_LE(outcome.exit_code, 1) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["cameras"].size(), 2u);
  EXPECT_GT(json["images"], 100);
  EXPECT_EQ(json["refused_images"], 0);
  EXPECT_GT(json["perception_time"]["mean"], 0.0);
  EXPECT_GE(json["perception_time"]["p99"], json["perception_time"]["p50"]);
  EXPECT_EQ(json["map"]["resolution_m"], 0.05);
  EXPECT_GT(json["map"]["known_share"], 0.0);
  EXPECT_EQ(json["truth"]["contact"], false);
  EXPECT_EQ(json["success"], outcome.exit_code == 0);
  EXPECT_GT(octree_info(*load_octree(runner.folder() / "seen.bt")).occupied_leaves, 0u);
  EXPECT_EQ(runner.run("check out.g2o").exit_code, 0) << "as far as it got";
  // The same bits again, whether the map is saved or not.
  const std::string without_map = command.substr(0, command.find("--save-map"));
  EXPECT_EQ(runner.run(without_map + "-o again.g2o").exit_code, outcome.exit_code);
  EXPECT_EQ(runner.read("again.g2o"), runner.read("out.g2o"));
}

TEST(RefineCameras, ShowsRecordedCloudsAtTheirTimes) {
  const CameraRunner runner;
  write_clouds(runner,
               "0.0,D435i_camera,a.pcd\n1.5,D435i_camera,a.pcd\n1.6,D435i_camera,none.pcd\n"
               "900,D435i_camera,a.pcd");
  runner.write("clouds/none.pcd",
               "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 0\nHEIGHT 1\nDATA ascii\n");
  const Outcome outcome = runner.run("refine plan.g2o --clouds clouds -o out.g2o --json");
  EXPECT_LE(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(outcome.json()["images"], 3) << "the last one comes too late";
  EXPECT_EQ(outcome.json()["blind_images"], 1) << "one without points";
  EXPECT_EQ(outcome.json()["images_not_shown"], 1);
  EXPECT_EQ(outcome.json()["refused_images"], 0);
  // A window of the smallest voxels, whose distances do not reach as far.
  EXPECT_EQ(
      runner.run("refine plan.g2o --clouds clouds --voxel 0.01 --window 1 -o fine.g2o").exit_code,
      outcome.exit_code);
}

TEST(RefineCameras, RefuseWhatCannotBeUsedInOneLine) {
  const CameraRunner runner;
  runner.write_map("box.bt");
  const auto refused = [&](const std::string& options, const std::string& place,
                           const std::string& words) {
    SCOPED_TRACE(options);
    expect_refusal(runner.run("refine plan.g2o -o out.g2o " + options), place, words);
    EXPECT_FALSE(runner.exists("out.g2o"));
  };
  refused("--clouds nowhere", "nowhere/clouds.csv", "no such file");
  refused("--clouds nowhere --cameras", "", "both --cameras and --clouds");
  refused("--known-map box.bt", "", "--known-map without --cameras");
  refused("--save-map seen.bt", "", "--save-map without --cameras or --clouds");
  refused("--unknown occupied", "", "--unknown without --cameras or --clouds");
  refused("--unknown free", "", "--unknown without --cameras or --clouds");
  refused("--voxel 0.05", "", "--voxel without --cameras or --clouds");
  refused("--window 8", "", "--window without --cameras or --clouds");
  refused("--seed 0", "", "--seed without --cameras");
  refused("--camera-rate 30", "", "--camera-rate without --cameras");
  refused("--clouds nowhere --camera-rate 3", "", "--camera-rate without --cameras");
  refused("--clouds nowhere --seed 3", "", "--seed without --cameras");
  refused("--cameras --known-map none.bt", "none.bt", "");
  refused("--cameras --known-map box.bt --voxel 0.1", "box.bt", "those of the window");
  refused("--cameras --known-map box.bt --save-map box.bt", "", "box.bt");
  refused("--cameras --window 1000", "", "a window of 20000 x 20000 x 60 voxels");
  refused("--cameras --unknown perhaps", "", "unknown");
  refused("--cameras --camera-rate 0", "", "camera-rate");
  refused("--cameras --save-map none/seen.bt", "", "none/seen.bt");
  runner.write_map("elsewhere.bt", 1000.0);
  refused("--cameras --known-map elsewhere.bt", "elsewhere.bt", "the plan's frame");
  write_clouds(runner, "0.0,D435i_camera,a.pcd");
  refused("--clouds clouds --map elsewhere.bt", "elsewhere.bt", "the plan's frame");
  refused("--clouds clouds --map box.bt --voxel 0.1", "box.bt", "those of the window");
  write_clouds(runner, "0.0,ear,a.pcd");
  refused("--clouds clouds", "clouds/clouds.csv:2", "ear");
  write_clouds(runner, "0.0,D435i_camera,b.pcd");
  refused("--clouds clouds", "clouds/clouds.csv:2", "b.pcd");
  write_clouds(runner, "900,D435i_camera,a.pcd");
  refused("--clouds clouds", "clouds/clouds.csv", "after the end of the plan");
}

TEST(RefineCameras, WritesOntoNothingThatItReads) {
  const CameraRunner runner;
  write_clouds(runner, "0.0,D435i_camera,a.pcd");
  runner.write("box.xml",
               "<obstacles version=\"1\"><box center=\"2 3 1\" size=\"1 1 1\"/></obstacles>\n");
  ASSERT_EQ(runner.run("refine plan.g2o --obstacles box.xml -o with_box.g2o").exit_code, 0);
  const auto is_kept = [&](const std::string& file, const std::string& options) {
    SCOPED_TRACE(options + ' ' + file);
    const std::string before = runner.read(file);
    expect_refusal(runner.run("refine with_box.g2o " + options + ' ' + file), file,
                   "would be lost");
    EXPECT_EQ(runner.read(file), before);
  };
  is_kept("box.xml", "--cameras -o out.g2o --save-map");
  for (const std::string file : {"clouds/clouds.csv", "clouds/a.pcd"}) {
    is_kept(file, "--clouds clouds -o");
    is_kept(file, "--clouds clouds -o out.g2o --save-map");
  }
}

}  // namespace
}  // namespace locograph
