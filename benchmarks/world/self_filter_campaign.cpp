// What the self-filter takes and leaves, and how long it and the simulated camera take.
//
//     self_filter_campaign [--robot NAME]… [--configurations N] [--seed N] [--padding M]
//                          [--padding-per-m2 X] [--edge-pixels N] [--joint-error RAD]
//
// Prints one JSON object. A configuration has joints within 0.4 rad of home, the lowest point of
// the robot on the ground, legs and arms in view of its cameras, and a ball of 4 cm in view, 5 cm
// from a shin and no nearer to the rest. Each camera takes one image of it with all its noise; what
// each pixel shows is known from the first hits. `joint_error` is the standard deviation of what
// the filter believes of each joint, where the cameras are with it.
//
// Of all configurations:
//   robot_kept       share of the robot's pixels that stay
//   ball_kept        share of the ball's pixels that stay
//   floor_lost       share of the floor's pixels that are taken
//   worst_ball_kept  the least of a configuration that shows 200 pixels of the ball
//   voxels           of 5 cm, in which no point of ball or floor is, up to the noise there. robot:
//                    within 5 cm of the robot, with 3 pixels that stay and 5 % of those that they
//                    fill, which a map takes for a hit; robot_any_pixel: with one pixel at least;
//                    flying: hits that are further from the robot
//   unfiltered_voxels  the same of the images as they were
// Times are processor time in ms; take() includes casting and noise.
#include <locograph/common/uniform.h>
#include <locograph/world/perception/self_filter.h>
#include <locograph/world/perception/simulated_camera.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <random>
#include <tuple>
#include <vector>

#include "command_line.h"
#include "world/measure.h"
#include "world/posed_robot.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kVoxel_m = 0.05, kBall_m = 0.04, kApart_m = 0.05;

/// Where a robot has its cameras, here: on a link, looking forward and down.
struct Mount {
  const char *name, *link;
  Eigen::Vector3d position;
  double down_rad;
};

struct Subject {
  const char* name;
  std::vector<const char*> shins;
  std::vector<Mount> mounts;
};

const std::vector<Subject>& subjects() {
  static const std::vector<Subject> kSubjects = {
      {"centauro",
       {"knee_1", "knee_2", "ankle1_1", "ankle1_2"},
       {{"head", "pelvis", {0.38, 0.0, 0.8}, 1.0}, {"pelvis", "pelvis", {0.46, 0.0, 0.1}, 1.15}}},
      {"coman_plus",
       {"LLowLeg", "RLowLeg"},
       {{"head", "DWYTorso", {0.15, 0.0, 0.45}, 1.2}, {"waist", "Waist", {0.3, 0.0, 0.0}, 1.3}}}};
  return kSubjects;
}

DepthCamera camera_on(const Robot& robot, const Mount& mount, int width, int height) {
  DepthCamera camera;
  camera.name = mount.name;
  camera.link = robot.link_index(mount.link);
  camera.link_from_optical.translate(mount.position);
  camera.link_from_optical.rotate(
      Eigen::AngleAxisd(mount.down_rad + std::numbers::pi / 2.0, Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(-std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ()));
  camera.width = width;
  camera.height = height;
  camera.fx = 0.5 * width / std::tan(0.5 * 87.0 * std::numbers::pi / 180.0);
  camera.fy = 0.5 * height / std::tan(0.5 * 58.0 * std::numbers::pi / 180.0);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

class Campaign {
 public:
  Campaign(const Subject& subject, const SelfFilterOptions& options, double joint_error_rad,
           std::uint64_t seed)
      : subject_(subject),
        robot_(shipped(subject.name)),
        posed_(robot_),
        believed_(robot_),
        filter_(robot_, options),
        joint_error_rad_(joint_error_rad),
        random_(seed),
        limb_(robot_.links().size(), 0) {
    for (const Mount& mount : subject.mounts) {
      cameras_.push_back(camera_on(robot_, mount, 640, 480));
      small_cameras_.push_back(camera_on(robot_, mount, 80, 60));
    }
    mark_limbs("legs", 1);
    mark_limbs("arms", 2);
  }

  Json run(int configurations) {
    for (int done = 0; done < configurations; ++done) {
      World world;
      do draw_configuration();
      while (!draw_ball(world));
      look(world, static_cast<std::uint64_t>(done));
    }
    return {{"robot", subject_.name},
            {"capsules", filter_.capsules().size()},
            {"configurations", configurations},
            {"images", filter_ms_.size()},
            {"robot_share_of_pixels",
             static_cast<double>(robot_pixels_) / (640.0 * 480.0 * filter_ms_.size())},
            {"robot_pixels", robot_pixels_},
            {"robot_kept", share(robot_kept_, robot_pixels_)},
            {"ball_pixels", ball_pixels_},
            {"ball_kept", share(ball_kept_, ball_pixels_)},
            {"worst_ball_kept", worst_ball_kept_},
            {"floor_lost", share(floor_lost_, floor_pixels_)},
            {"voxels", voxels_.json()},
            {"unfiltered_voxels", unfiltered_.json()},
            {"filter_ms", spread(filter_ms_)},
            {"take_ms", spread(take_ms_)}};
  }

 private:
  struct Voxels {
    int of_robot = 0, flying = 0, of_robot_any = 0;

    Json json() const {
      return {{"robot", of_robot}, {"flying", flying}, {"robot_any_pixel", of_robot_any}};
    }
  };

  static double share(long part, long all) {
    return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
  }

  void mark_limbs(const std::string& group, int limb) {
    const std::vector<int>& joints = robot_.group_joints(group);
    for (std::size_t l = 0; l < robot_.links().size(); ++l) {
      for (int link = static_cast<int>(l); robot_.links()[link].parent_joint >= 0;
           link = robot_.joints()[robot_.links()[link].parent_joint].parent_link) {
        if (std::ranges::count(joints, robot_.links()[link].parent_joint) > 0) limb_[l] = limb;
      }
    }
  }

  /// Until legs and arms are seen.
  void draw_configuration() {
    World world;
    world.surfaces = {ground()};
    RayCaster rays(robot_, world);
    FirstHits hits;
    for (;;) {
      configuration_ = robot_.named_configuration("home");
      for (Eigen::Index i = 7; i < configuration_.size(); ++i)
        configuration_[i] += uniform(random_, -0.4, 0.4);
      posed_.stand(configuration_, 0.0);
      int seen[3] = {0, 0, 0};
      for (const DepthCamera& camera : small_cameras_) {
        rays.cast(camera, posed_.state(), 0.0, hits);
        for (std::size_t i = 0; i < hits.shows.size(); ++i) {
          if (hits.shows[i] >= 0 && hits.depth_m[i] >= camera.range_min_m &&
              hits.shows[i] < static_cast<int>(limb_.size()))
            ++seen[limb_[static_cast<std::size_t>(hits.shows[i])]];
        }
      }
      const int enough = 80 * 60 / 200;  // half a per cent of an image
      if (seen[1] >= enough && seen[2] >= enough) return;
    }
  }

  /// False if no place is found.
  bool draw_ball(World& world) {
    world.surfaces = {ground()};
    std::vector<const CollisionCapsule*> shins;
    for (const CollisionCapsule& capsule : filter_.capsules()) {
      for (const char* shin : subject_.shins) {
        if (robot_.links()[static_cast<std::size_t>(capsule.link)].name == shin)
          shins.push_back(&capsule);
      }
    }
    for (int trial = 0; trial < 300; ++trial) {
      const CollisionCapsule& shin = *shins[random_() % shins.size()];
      const Capsule there = transformed(posed_.state().world_from_link(shin.link), shin.capsule);
      Eigen::Vector3d out;
      for (int axis = 0; axis < 3; ++axis) out[axis] = uniform(random_, -1.0, 1.0);
      out.normalize();
      const double along = uniform(random_, 0.0, 1.0);
      const Eigen::Vector3d from = there.from + along * (there.to - there.from);
      double near = 0.0, far = 0.4;
      for (int halving = 0; halving < 30; ++halving) {
        const double middle = 0.5 * (near + far);
        (posed_.distance(from + middle * out) < kBall_m + kApart_m ? near : far) = middle;
      }
      const Eigen::Vector3d at = from + far * out;
      int nearest = -1;
      if (std::abs(posed_.distance(at, &nearest) - kBall_m - kApart_m) > 1e-3 ||
          nearest != shin.link || at.z() < 2.0 * kBall_m)
        continue;
      Obstacle ball;
      ball.shape = Obstacle::Shape::kSphere;
      ball.size.x() = kBall_m;
      ball.world_from_obstacle.translation() = at;
      world.obstacles = {ball};
      RayCaster rays(robot_, world);
      FirstHits hits;
      int seen = 0;
      for (const DepthCamera& camera : small_cameras_) {
        rays.cast(camera, posed_.state(), 0.0, hits);
        for (std::size_t i = 0; i < hits.shows.size(); ++i) {
          seen += hits.shows[i] == static_cast<int>(limb_.size()) &&
                  hits.depth_m[i] >= camera.range_min_m;
        }
      }
      if (seen >= 3) return true;
    }
    return false;
  }

  void look(const World& world, std::uint64_t seed) {
    Eigen::VectorXd believed = configuration_;
    for (Eigen::Index i = 7; i < believed.size(); ++i) {
      double normal = -6.0;
      for (int k = 0; k < 12; ++k) normal += uniform(random_, 0.0, 1.0);
      believed[i] += joint_error_rad_ * normal;
    }
    believed_.update(believed.data());
    SimulatedCamera simulated(robot_, world);
    const int ball = static_cast<int>(limb_.size());
    long ball_here = 0, ball_kept_here = 0;
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      std::vector<std::int16_t> shows;
      double start = processor_ms();
      DepthImage image =
          simulated.take(cameras_[c], static_cast<int>(c), posed_.state(), 0.0, seed, &shows);
      take_ms_.push_back(processor_ms() - start);
      const DepthImage before = image;
      start = processor_ms();
      filter_.remove(believed_, cameras_[c], image);
      filter_ms_.push_back(processor_ms() - start);
      for (std::size_t i = 0; i < shows.size(); ++i) {
        if (before.depth_mm[i] == 0 || shows[i] < 0) continue;
        const bool stays = image.depth_mm[i] != 0;
        if (shows[i] < ball) {
          ++robot_pixels_;
          robot_kept_ += stays;
        } else if (shows[i] == ball) {
          ++ball_here;
          ball_kept_here += stays;
        } else {
          ++floor_pixels_;
          floor_lost_ += !stays;
        }
      }
      count(world, cameras_[c], image, voxels_);
      count(world, cameras_[c], before, unfiltered_);
    }
    ball_pixels_ += ball_here;
    ball_kept_ += ball_kept_here;
    if (ball_here >= 200)
      worst_ball_kept_ = std::min(worst_ball_kept_, share(ball_kept_here, ball_here));
  }

  void count(const World& world, const DepthCamera& camera, const DepthImage& image,
             Voxels& voxels) const {
    const Eigen::Isometry3d world_from_optical =
        posed_.state().world_from_link(camera.link) * camera.link_from_optical;
    std::map<std::tuple<int, int, int>, int> pixels;
    for (int pixel = 0; pixel < image.width * image.height; ++pixel) {
      const double depth = 0.001 * image.depth_mm[static_cast<std::size_t>(pixel)];
      if (depth == 0.0) continue;
      const Eigen::Vector3d ray((pixel % image.width - camera.cx) / camera.fx,
                                (pixel / image.width - camera.cy) / camera.fy, 1.0);
      const Eigen::Vector3d at = world_from_optical * Eigen::Vector3d(depth * ray) / kVoxel_m;
      ++pixels[{static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())),
                static_cast<int>(std::floor(at.z()))}];
    }
    for (const auto& [key, seen] : pixels) {
      const Eigen::Vector3d index(std::get<0>(key), std::get<1>(key), std::get<2>(key));
      const Eigen::Vector3d centre = kVoxel_m * (index + Eigen::Vector3d::Constant(0.5));
      const double depth = (world_from_optical.inverse() * centre).z();
      const double fills = kVoxel_m * kVoxel_m * camera.fx * camera.fy / (depth * depth);
      // Half a diagonal, and 3.5 standard deviations of the noise.
      const CameraNoise noise;
      const double reach =
          0.5 * std::sqrt(3.0) * kVoxel_m + 3.5 * (noise.at_zero_m + noise.per_m2 * depth * depth);
      if (std::min(centre.z(), world.obstacles[0].distance(centre, 0.0)) <= reach) continue;
      const bool is_near = posed_.distance(centre) <= 0.5 * std::sqrt(3.0) * kVoxel_m + 0.05;
      voxels.of_robot_any += is_near;
      if (seen < 3 || seen < 0.05 * fills) continue;
      (is_near ? voxels.of_robot : voxels.flying)++;
    }
  }

  const Subject& subject_;
  Robot robot_;
  PosedRobot posed_;
  RobotState believed_;
  SelfFilter filter_;
  double joint_error_rad_;
  std::mt19937_64 random_;
  std::vector<int> limb_;  // of each link: 1 a leg, 2 an arm
  std::vector<DepthCamera> cameras_, small_cameras_;
  Eigen::VectorXd configuration_;
  std::vector<double> filter_ms_, take_ms_;
  long robot_pixels_ = 0, robot_kept_ = 0, ball_pixels_ = 0, ball_kept_ = 0;
  long floor_pixels_ = 0, floor_lost_ = 0;
  double worst_ball_kept_ = 1.0;
  Voxels voxels_, unfiltered_;
};

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("What the self-filter takes and leaves", "self_filter_campaign");
  std::vector<std::string> robots = {"centauro", "coman_plus"};
  int configurations = 100;
  std::uint64_t seed = 1;
  double joint_error_rad = 0.0;
  locograph::SelfFilterOptions options;
  app.add_option("--robot", robots).one_of(robots);
  app.add_option("--configurations", configurations).positive();
  app.add_option("--seed", seed);
  app.add_option("--padding", options.padding_m).not_negative();
  app.add_option("--padding-per-m2", options.padding_per_m2).not_negative();
  app.add_option("--edge-pixels", options.edge_pixels).not_negative();
  app.add_option("--joint-error", joint_error_rad).not_negative();
  return locograph::run_benchmark(app, argc, argv, [&] {
    locograph::Json all = locograph::Json::array();
    for (const locograph::Subject& subject : locograph::subjects()) {
      if (std::ranges::count(robots, subject.name) > 0)
        all.push_back(
            locograph::Campaign(subject, options, joint_error_rad, seed).run(configurations));
    }
    std::cout << locograph::Json{{"seed", seed},
                                 {"padding_m", options.padding_m},
                                 {"padding_per_m2", options.padding_per_m2},
                                 {"edge_pixels", options.edge_pixels},
                                 {"joint_error_rad", joint_error_rad},
                                 {"robots", all}}
                     .dump(2)
              << '\n';
  });
}
