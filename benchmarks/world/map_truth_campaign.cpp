// What the local map knows of a scene whose truth is known, beside OctoMap, from the same images.
//
//     map_truth_campaign [--scenes N] [--seed N] [--every-ray] [--images N]
//
// Prints one JSON object. Each scene is drawn: a floor, walls, boxes, spheres, cylinders and poles
// of 2 to 5 cm, upright and slanted, one pole of 2 cm at 2 m from the head's camera, in every third
// scene also an OctoMap with voxels of 2.5 cm. CENTAURO stands for 1 s, drives 4 m past all that,
// turning, its joints moving, and stands again; its two cameras of 640 x 480 pixels take 10 images
// a second each, with all their noise, and what shows the robot is taken out. Both maps have voxels
// of 5 cm and see 4 m far. They are compared where the drive ends, in the local map's window. Then
// a crate that stood in front of the robot for 3 s is taken away, while a ball crosses the view.
//
// Of each map (ours; octomap: insertPointCloud() with the sensor model that it has unless told
// otherwise, its distances those of DistanceField):
//   surface     voxels that showed a surface within 4 m in at least 5 images, by first hits without
//               noise.
//               missed: neither they nor any of their 26 neighbours are occupied; missed_solids:
//               the same without the floor; voxel_itself: occupied themselves; false_free: seen as
//               free themselves
//   inside_free voxels all of which are inside of something, and that are free
//   free        voxels that are known, and that nothing touches. occupied: share of them;
//               away: nothing within 5 cm of the voxel either
//   robot       voxels that are occupied where only the robot is: every eighth time, those of
//               `away` that are within 5 cm of its shapes
//   field_m     its value less the true distance, of points up to 1 m from a surface that was seen
//   pole        images that show a layer of that pole until it is occupied there. late: after 5
//   left        images that look through a voxel which the crate or the ball has left until it is
//               free. late: after 5; stays: occupied at the end, though seen through
//   ms          processor time of an image; ours with the window's move and the field
// With --images nothing is compared: so many images of one scene are shown to Perception, again and
// again the same drive, each time from a place 12.8 m away and back, and the window's bits after it
// are compared with those after the first.
#include <locograph/common/simd_level.h>
#include <locograph/common/uniform.h>
#include <locograph/world/distance_field.h>
#include <locograph/world/octree.h>
#include <locograph/world/perception/perception.h>
#include <locograph/world/perception/simulated_camera.h>
#include <locograph/world/voxel_tree.h>

#include <array>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "command_line.h"
#include "world/measure.h"
#include "world/octomap_insertion.h"
#include "world/posed_robot.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kVoxel_m = 0.05, kRate_Hz = 10.0;
constexpr double kStands_s = 1.0, kSpeed_m_s = 0.5, kWay_m = 4.0;
constexpr double kDriven_s = kStands_s + kWay_m / kSpeed_m_s;          // the drive ends
constexpr double kTaken_s = kDriven_s + 3.0, kEnd_s = kTaken_s + 3.0;  // the crate is gone
constexpr double kHalfDiagonal_m = 0.8660254037844387 * kVoxel_m;
constexpr double kAway_m = kHalfDiagonal_m + 0.05;
constexpr int kEnough = 5;  // images

// ---- Scenes.

/// The world's last two obstacles are the crate and the ball.
struct Scene {
  World world;
  double floor_m = 0.0;
  Eigen::Vector2d pole = Eigen::Vector2d::Zero();
  std::vector<Obstacle> fixed;  // all that stays, but the floor and the map
  std::optional<VoxelTree> leaves;

  const Obstacle& crate() const { return world.obstacles[world.obstacles.size() - 2]; }
  const Obstacle& ball() const { return world.obstacles.back(); }

  /// To what stays.
  DistanceSample nearest(const Eigen::Vector3d& point) const {
    DistanceSample least;
    least.distance = point.z() - floor_m;
    least.gradient = Eigen::Vector3d::UnitZ();
    for (const Obstacle& one : fixed) {
      const double radius = one.shape == Obstacle::Shape::kBox ? 0.5 * one.size.norm()
                            : one.shape == Obstacle::Shape::kSphere
                                ? one.size.x()
                                : std::hypot(one.size.x(), 0.5 * one.size.y());
      if ((point - one.world_from_obstacle.translation()).norm() - radius >= least.distance)
        continue;
      const DistanceSample its = one.sample(point, 0.0);
      if (its.distance < least.distance) least = its;
    }
    if (!leaves) return least;
    constexpr double kPoint_m = 1e-4;
    static const ConvexShape dot = ConvexShape::sphere(kPoint_m);
    const Eigen::Isometry3d at(Eigen::Translation3d(point.x(), point.y(), point.z()));
    VoxelTree::Query query{dot, at};
    query.best.distance = least.distance - kPoint_m;
    if (!leaves->nearest(query)) return least;
    least.distance = query.best.distance + kPoint_m;
    least.gradient = (query.best.on_first - query.best.on_second).normalized();
    return least;
  }

  /// To what leaves.
  double nearest_leaving(const Eigen::Vector3d& point, double time_s) const {
    return std::min(crate().distance(point, time_s), ball().distance(point, time_s));
  }
};

Eigen::Isometry3d turned(std::mt19937_64& random, double tilt_rad) {
  return Eigen::Isometry3d(
      Eigen::AngleAxisd(uniform(random, -std::numbers::pi, std::numbers::pi),
                        Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(uniform(random, -tilt_rad, tilt_rad), Eigen::Vector3d::UnitX()));
}

Obstacle obstacle(Obstacle::Shape shape, const Eigen::Vector3d& size,
                  const Eigen::Isometry3d& pose) {
  Obstacle made;
  made.shape = shape;
  made.size = size;
  made.world_from_obstacle = pose;
  return made;
}

/// Beside the way, or beyond its end.
Obstacle drawn_obstacle(std::mt19937_64& random, double floor_m) {
  using Shape = Obstacle::Shape;
  const auto kind = random() % 5;
  Eigen::Isometry3d pose = turned(random, kind == 3 ? 0.6 : 0.0);
  const Eigen::Vector3d at(uniform(random, 0.0, 7.5), uniform(random, -3.0, 3.0), floor_m);
  pose.translation() = at;
  if (kind < 2) {  // on the floor, or hanging
    const Eigen::Vector3d size(uniform(random, 0.1, 0.8), uniform(random, 0.1, 0.8),
                               uniform(random, 0.05, 1.2));
    pose.translation().z() += 0.5 * size.z() + (kind == 1 ? uniform(random, 0.3, 1.0) : 0.0);
    return obstacle(Shape::kBox, size, pose);
  }
  if (kind == 2) {
    const double radius = uniform(random, 0.08, 0.4);
    pose.translation().z() += radius + uniform(random, 0.0, 0.8);
    return obstacle(Shape::kSphere, {radius, 0.0, 0.0}, pose);
  }
  const double radius = kind == 3 ? uniform(random, 0.01, 0.025) : uniform(random, 0.05, 0.3);
  const double height = uniform(random, 0.5, 1.8);
  pose.translation().z() += 0.5 * height;
  return obstacle(Shape::kCylinder, {radius, height, 0.0}, pose);
}

/// The robot passes by it, the first pole is in sight from the start, and the crate and the ball
/// have room.
bool is_apart(const Obstacle& one, const Scene& scene, const Eigen::Vector3d& eye) {
  constexpr double kFromWay_m = 0.75, kFromView_m = 0.9;
  for (double z = scene.floor_m; z < 1.6; z += 0.2) {
    for (double x = -0.4; x <= kWay_m + 0.6; x += 0.1)
      if (one.distance({x, 0.0, z}, 0.0) < kFromWay_m) return false;
    for (double t = 0.0; t <= 1.0; t += 0.05) {
      const Eigen::Vector2d to_pole = eye.head<2>() + t * (scene.pole - eye.head<2>());
      if (one.distance({to_pole.x(), to_pole.y(), z}, 0.0) < kFromView_m * t) return false;
      if (one.distance({kWay_m + 2.0, 3.0 * t - 1.5, z}, 0.0) < kFromView_m) return false;
    }
  }
  return true;
}

void add_walls(Scene& scene, std::mt19937_64& random) {
  const auto wall = [&](double x, double y, double length, double yaw) {
    Eigen::Isometry3d pose(Eigen::Translation3d(x, y, scene.floor_m + 1.25) *
                           Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    scene.world.solids.push_back(
        {"wall " + std::to_string(scene.world.solids.size()), pose, {length, 0.2, 2.5}});
    scene.fixed.push_back(obstacle(Obstacle::Shape::kBox, {length, 0.2, 2.5}, pose));
  };
  wall(3.0, uniform(random, 2.0, 3.2), 9.0, uniform(random, -0.08, 0.08));
  if (random() % 2 == 0) wall(3.0, -uniform(random, 2.0, 3.2), 9.0, uniform(random, -0.08, 0.08));
  if (random() % 2 == 0)
    wall(uniform(random, 7.3, 8.2), 0.0, 5.0, std::numbers::pi / 2 + uniform(random, -0.3, 0.3));
}

void add_map(Scene& scene, std::mt19937_64& random) {
  std::vector<Box> boxes(3);
  const double side = random() % 2 == 0 ? 1.0 : -1.0, x = uniform(random, 1.0, 4.5);
  for (Box& box : boxes) {
    box.world_from_box = turned(random, 0.5);
    box.size << uniform(random, 0.2, 0.6), uniform(random, 0.2, 0.6), uniform(random, 0.1, 0.6);
    box.world_from_box.translation() << x + uniform(random, -0.3, 0.3),
        side * uniform(random, 1.3, 1.7), scene.floor_m + uniform(random, 0.2, 0.8);
  }
  scene.world.map = octree_from_boxes(boxes, 0.5 * kVoxel_m);
  scene.leaves.emplace(*scene.world.map);
}

Scene drawn_scene(std::mt19937_64& random, int number, const Eigen::Vector3d& eye) {
  Scene scene;
  // Not between two layers of voxels.
  scene.floor_m = uniform(random, 0.01, 0.04);
  Surface floor = ground();
  floor.world_from_surface.translation().z() = scene.floor_m;
  scene.world.surfaces = {floor};
  add_walls(scene, random);
  if (number % 3 == 2) add_map(scene, random);

  const double side = random() % 2 == 0 ? 1.0 : -1.0, angle = side * uniform(random, 0.42, 0.65);
  scene.pole = eye.head<2>() + 2.0 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  Eigen::Isometry3d upright = Eigen::Isometry3d::Identity();
  upright.translation() << scene.pole, scene.floor_m + 0.9;
  scene.fixed.push_back(obstacle(Obstacle::Shape::kCylinder, {0.01, 1.8, 0.0}, upright));

  const std::size_t before = scene.fixed.size();
  while (scene.fixed.size() < before + 15) {
    const Obstacle one = drawn_obstacle(random, scene.floor_m);
    if (is_apart(one, scene, eye)) scene.fixed.push_back(one);
  }

  for (const Obstacle& one : scene.fixed) {
    if (one.shape != Obstacle::Shape::kBox || one.size.x() < 4.0)  // walls are among the solids
      scene.world.obstacles.push_back(one);
  }
  Obstacle crate =
      obstacle(Obstacle::Shape::kBox,
               {uniform(random, 0.2, 0.5), uniform(random, 0.2, 0.5), uniform(random, 0.2, 0.5)},
               turned(random, 0.0));
  crate.world_from_obstacle.translation() << kWay_m + uniform(random, 1.4, 2.0),
      uniform(random, -0.5, 0.5), scene.floor_m + 0.5 * crate.size.z();
  crate.appears_s = kDriven_s;
  crate.vanishes_s = kTaken_s - 0.5 / kRate_Hz;
  Obstacle ball = obstacle(Obstacle::Shape::kSphere, {uniform(random, 0.08, 0.15), 0.0, 0.0},
                           Eigen::Isometry3d::Identity());
  const double ball_x = kWay_m + uniform(random, 1.6, 2.4),
               ball_z = scene.floor_m + uniform(random, 0.6, 0.9);
  ball.world_from_obstacle.translation() << ball_x, 1.5 * side, ball_z;
  ball.motion.resize(2);
  ball.motion[0] = {kDriven_s, ball.world_from_obstacle};
  ball.motion[1] = {kEnd_s - 0.5, ball.world_from_obstacle};
  ball.motion[1].pose.translation().y() *= -1.0;
  ball.appears_s = kDriven_s;
  scene.world.obstacles.push_back(crate);
  scene.world.obstacles.push_back(ball);
  return scene;
}

// ---- The drive.

struct Drive {
  explicit Drive(const Robot& robot) : home(robot.named_configuration("home")) {}

  Eigen::VectorXd home;

  /// Its base not yet as high as it stands.
  Eigen::VectorXd at(double time_s) const {
    Eigen::VectorXd q = home;
    const double drives_s = std::clamp(time_s - kStands_s, 0.0, kDriven_s - kStands_s);
    q[0] = kSpeed_m_s * drives_s;
    q[1] = 0.08 * std::sin(0.9 * drives_s);
    const double yaw = 0.3 * std::sin(1.1 * drives_s);
    q.segment<4>(3) << 0.0, 0.0, std::sin(0.5 * yaw), std::cos(0.5 * yaw);
    for (Eigen::Index i = 7; i < q.size(); ++i) {
      const auto phase = static_cast<double>(i);
      q[i] += 0.15 * (std::sin(1.3 * drives_s + phase) - std::sin(phase));
    }
    return q;
  }
};

struct Taken {
  DepthImage image;  // without the robot
  DepthImage truth;  // without noise
  std::vector<std::int16_t> shows;
  Eigen::Isometry3d world_from_optical;
};

// ---- What is known beforehand of each voxel, and of what images have shown of it.

/// Voxels by their world indices.
class Region {
 public:
  Region(const Eigen::Vector3i& first, const Eigen::Vector3i& size) : first_(first), size_(size) {}

  std::size_t count() const { return static_cast<std::size_t>(size_.cast<long>().prod()); }
  bool contains(const Eigen::Vector3i& index) const {
    return ((index - first_).array() >= 0).all() &&
           ((index - first_).array() < size_.array()).all();
  }
  std::size_t at(const Eigen::Vector3i& index) const {
    const Eigen::Vector3i i = index - first_;
    return (static_cast<std::size_t>(i[2]) * static_cast<std::size_t>(size_[1]) +
            static_cast<std::size_t>(i[1])) *
               static_cast<std::size_t>(size_[0]) +
           static_cast<std::size_t>(i[0]);
  }
  template <class Visit>
  void each(Visit visit) const {
    for (int z = 0; z < size_[2]; ++z)
      for (int y = 0; y < size_[1]; ++y)
        for (int x = 0; x < size_[0]; ++x)
          visit(Eigen::Vector3i(first_ + Eigen::Vector3i(x, y, z)));
  }

 private:
  Eigen::Vector3i first_, size_;
};

Eigen::Vector3i index_at(const Eigen::Vector3d& point) {
  return (point / kVoxel_m).array().floor().cast<int>();
}

Eigen::Vector3d centre_of(const Eigen::Vector3i& index) {
  return kVoxel_m * (index.cast<double>() + Eigen::Vector3d::Constant(0.5));
}

enum class Voxel { kUnknown, kFree, kOccupied };

/// A map that is held against the truth.
struct Subject {
  long seen = 0, missed = 0, seen_solids = 0, missed_solids = 0, itself = 0, false_free = 0;
  long inside_free = 0, free = 0, free_occupied = 0, away = 0, away_occupied = 0, robot = 0;
  std::vector<double> field_m, pole, left, ms;
  long pole_never = 0, stays = 0;

  Json json() const {
    const auto share = [](long part, long all) {
      return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
    };
    const auto late = [](const std::vector<double>& images) {
      return std::ranges::count_if(images, [](double n) { return n > kEnough; });
    };
    std::vector<double> field = field_m;
    std::ranges::sort(field);
    const auto beyond = [&](double metres) {
      return share(std::ranges::count_if(field, [&](double e) { return e > metres; }),
                   static_cast<long>(field.size()));
    };
    return {{"surface",
             {{"voxels", seen},
              {"missed", share(missed, seen)},
              {"solids", seen_solids},
              {"missed_solids", share(missed_solids, seen_solids)},
              {"voxel_itself", share(itself, seen)},
              {"false_free", share(false_free, seen)}}},
            {"inside_free", inside_free},
            {"free",
             {{"voxels", free},
              {"occupied", share(free_occupied, free)},
              {"away_voxels", away},
              {"away_occupied_voxels", away_occupied},
              {"away_occupied", share(away_occupied, away)}}},
            {"robot", robot},
            {"field_m",
             {{"points", field.size()},
              {"p1", percentile(field, 0.01)},
              {"median", percentile(field, 0.5)},
              {"p99", percentile(field, 0.99)},
              {"max", field.empty() ? 0.0 : field.back()},
              {"above_0", beyond(0.0)},
              {"above_5_cm", beyond(0.05)}}},
            {"pole", spread(pole)},
            {"pole_late", late(pole) + pole_never},
            {"left", spread(left)},
            {"left_late", late(left) + stays},
            {"left_stays", stays},
            {"ms", spread(ms)}};
  }
};

/// What becomes of a voxel that something leaves.
struct Leaving {
  bool was_occupied = false;
  int looks = 0;
};

// ---- A scene.

struct Setting {
  const Robot& robot;
  std::vector<DepthCamera> cameras = cameras_of(robot);
  LocalMapOptions map = {};
  OctomapInsertion octomap = {};
};

class Trial {
 public:
  Trial(const Setting& setting, std::mt19937_64& random, int number)
      : setting_(setting),
        drive_(setting.robot),
        posed_(setting.robot),
        scene_(draw(random, number)),
        noise_seed_(random()),
        noisy_(setting.robot, scene_.world),
        exact_(setting.robot, scene_.world, CameraNoise::none()),
        filter_(setting.robot),
        floor_shows_(floor_number()),
        pole_shows_(pole_number()),
        map_(setting.map),
        tree_(kVoxel_m),
        distance_(region_.count()),
        seen_floor_(region_.count(), 0),
        seen_solids_(region_.count(), 0),
        last_seen_(region_.count(), -1) {
    region_.each([&](const Eigen::Vector3i& index) {
      distance_[region_.at(index)] = static_cast<float>(scene_.nearest(centre_of(index)).distance);
    });
    list_leaving();
  }

  void run(Subject& ours, Subject& octomap, std::mt19937_64& random) {
    const int driven = static_cast<int>(kDriven_s * kRate_Hz),
              end = static_cast<int>(kEnd_s * kRate_Hz);
    for (int step = 0; step < end; ++step) {
      const double time_s = step / kRate_Hz;
      if (step == driven) compare(ours, octomap, random);
      Eigen::VectorXd q = drive_.at(time_s);
      posed_.stand(q, scene_.floor_m);
      for (std::size_t c = 0; c < setting_.cameras.size(); ++c) {
        const Taken taken = take(c, time_s);
        show(setting_.cameras[c], taken, ours, octomap);
        if (step < driven) remember(setting_.cameras[c], taken);
        if (time_s < kStands_s) look_for_pole(setting_.cameras[c], taken, ours, octomap);
        if (step >= driven) look_after(setting_.cameras[c], taken, time_s, ours, octomap);
      }
      if (step % 8 == 7 && step < driven) look_for_robot(ours, octomap);
    }
    for (int map = 0; map < 2; ++map) {
      Subject& subject = map == 0 ? ours : octomap;
      for (const bool found : pole_found_[map]) subject.pole_never += found ? 0 : 1;
      for (const Leaving& one : leaving_[map]) subject.stays += one.was_occupied && one.looks > 0;
    }
  }

  /// The images of the drive, with its configurations, for Perception.
  void record(std::vector<std::pair<double, Eigen::VectorXd>>& configurations,
              std::vector<DepthImage>& images) {
    for (int step = 0; step < kDriven_s * kRate_Hz; ++step) {
      const double time_s = step / kRate_Hz;
      Eigen::VectorXd q = drive_.at(time_s);
      posed_.stand(q, scene_.floor_m);
      configurations.emplace_back(time_s, q);
      for (std::size_t c = 0; c < setting_.cameras.size(); ++c) {
        images.push_back(noisy_.take(setting_.cameras[c], static_cast<int>(c), posed_.state(),
                                     time_s, noise_seed_));
      }
    }
  }

 private:
  Scene draw(std::mt19937_64& random, int number) {
    Eigen::VectorXd q = drive_.at(0.0);
    posed_.stand(q, 0.0);
    const DepthCamera& head = setting_.cameras.front();
    const Eigen::Vector3d eye =
        (posed_.state().world_from_link(head.link) * head.link_from_optical).translation();
    return drawn_scene(random, number, eye);
  }

  /// What pixels show of the floor, or of the pole, is told by its kind and place in the world.
  int number_of(Shown::Kind kind, int index) {
    const int links = static_cast<int>(setting_.robot.links().size());
    for (int number = links;; ++number) {
      const Shown shown = exact_.shown(number);
      if (shown.kind == kind && shown.index == index) return number;
      if (shown.kind == Shown::Kind::kNothing) return -1;
    }
  }
  int floor_number() { return number_of(Shown::Kind::kSurface, 0); }
  int pole_number() { return number_of(Shown::Kind::kObstacle, 0); }

  Taken take(std::size_t c, double time_s) {
    const DepthCamera& camera = setting_.cameras[c];
    Taken taken;
    taken.image = noisy_.take(camera, static_cast<int>(c), posed_.state(), time_s, noise_seed_);
    filter_.remove(posed_.state(), camera, taken.image);
    taken.truth = exact_.take(camera, static_cast<int>(c), posed_.state(), time_s, 0, &taken.shows);
    taken.world_from_optical =
        posed_.state().world_from_link(camera.link) * camera.link_from_optical;
    return taken;
  }

  void show(const DepthCamera& camera, const Taken& taken, Subject& ours, Subject& octomap) {
    double begin = processor_ms();
    map_.move_to(posed_.state().world_from_link(setting_.robot.root_link()).translation());
    map_.insert(camera, taken.world_from_optical, taken.image);
    map_.field();
    ours.ms.push_back(processor_ms() - begin);
    begin = processor_ms();
    insert_into(tree_, camera, taken.world_from_optical, taken.image, setting_.octomap);
    octomap.ms.push_back(processor_ms() - begin);
  }

  Voxel voxel(int map, const Eigen::Vector3i& index) const {
    if (map == 0) {
      const int odds = map_.window().contains(index) ? map_.log_odds(index) : kNeverSeen;
      if (odds == kNeverSeen) return Voxel::kUnknown;
      return odds >= setting_.map.log_odds.occupied_from ? Voxel::kOccupied : Voxel::kFree;
    }
    const Eigen::Vector3d centre = centre_of(index);
    const octomap::OcTreeNode* node = tree_.search(centre.x(), centre.y(), centre.z());
    if (node == nullptr) return Voxel::kUnknown;
    return tree_.isNodeOccupied(node) ? Voxel::kOccupied : Voxel::kFree;
  }

  bool is_robot(int shown) const {
    return shown >= 0 && shown < static_cast<int>(setting_.robot.links().size());
  }

  template <class Visit>
  void each_hit(const DepthCamera& camera, const Taken& taken, Visit visit) const {
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const std::size_t pixel = static_cast<std::size_t>(v) * camera.width + u;
        const double depth = 1e-3 * taken.truth.depth_mm[pixel];
        const Eigen::Vector3d point = camera.point(u, v, depth);
        // OctoMap's range is along the ray, and so less than ours.
        if (depth == 0.0 || point.norm() > setting_.map.range_m || is_robot(taken.shows[pixel]))
          continue;
        visit(taken.shows[pixel], taken.world_from_optical * point);
      }
    }
  }

  /// Which voxels show a surface in this image.
  void remember(const DepthCamera& camera, const Taken& taken) {
    ++image_;
    each_hit(camera, taken, [&](int shows, const Eigen::Vector3d& point) {
      const Eigen::Vector3i index = index_at(point);
      if (!region_.contains(index) || !map_.window().contains(index)) return;
      const std::size_t at = region_.at(index);
      if (std::exchange(last_seen_[at], image_) == image_) return;
      auto& seen = shows == floor_shows_ ? seen_floor_ : seen_solids_;
      if (seen[at] < 255) ++seen[at];
    });
  }

  bool any_around(int map, const Eigen::Vector3i& index) const {
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (voxel(map, index + Eigen::Vector3i(dx, dy, dz)) == Voxel::kOccupied) return true;
    return false;
  }

  void compare(Subject& ours, Subject& octomap, std::mt19937_64& random) {
    region_.each([&](const Eigen::Vector3i& index) {
      if (!map_.window().contains(index)) return;
      const std::size_t at = region_.at(index);
      for (int map = 0; map < 2; ++map)
        count(map, index, distance_[at], seen_floor_[at], seen_solids_[at],
              map == 0 ? ours : octomap);
    });
    const std::shared_ptr<const LocalField> field = map_.field();
    DistanceFieldOptions options;
    options.max_distance_m = setting_.map.max_distance_m;
    options.lower = map_.window().bounds().min();
    options.upper = map_.window().bounds().max();
    const DistanceField theirs = DistanceField::from_octree(tree_, options);
    const Eigen::AlignedBox3d bounds = map_.window().bounds();
    for (int points = 0; points < 200'000; ++points) {
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis)
        point[axis] = uniform(random, bounds.min()[axis], bounds.max()[axis]);
      const DistanceSample truth = scene_.nearest(point);
      if (truth.distance <= 0.0 || truth.distance >= options.max_distance_m) continue;
      const Eigen::Vector3i index = index_at(point),
                            nearest = index_at(point - truth.distance * truth.gradient);
      if (!was_seen_around(nearest) || voxel(0, index) == Voxel::kUnknown ||
          voxel(1, index) == Voxel::kUnknown)
        continue;
      ours.field_m.push_back(field->distance(point) - truth.distance);
      octomap.field_m.push_back(theirs.distance(point) - truth.distance);
    }
  }

  bool was_seen_around(const Eigen::Vector3i& index) const {
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Eigen::Vector3i other = index + Eigen::Vector3i(dx, dy, dz);
          if (!region_.contains(other) || !map_.window().contains(other)) continue;
          const std::size_t at = region_.at(other);
          if (seen_floor_[at] + seen_solids_[at] >= kEnough) return true;
        }
      }
    }
    return false;
  }

  void count(int map, const Eigen::Vector3i& index, double distance, int floor, int solids,
             Subject& subject) const {
    const Voxel is = voxel(map, index);
    if (floor + solids >= kEnough) {
      const bool missed = !any_around(map, index), of_solids = solids >= kEnough;
      ++subject.seen;
      subject.missed += missed;
      subject.seen_solids += of_solids;
      subject.missed_solids += of_solids && missed;
      subject.itself += is == Voxel::kOccupied;
      subject.false_free += is == Voxel::kFree;
    }
    if (is == Voxel::kUnknown) return;
    subject.inside_free += distance < -kHalfDiagonal_m && is == Voxel::kFree;
    if (distance <= kHalfDiagonal_m) return;
    ++subject.free;
    subject.free_occupied += is == Voxel::kOccupied;
    if (distance <= kAway_m) return;
    ++subject.away;
    subject.away_occupied += is == Voxel::kOccupied;
  }

  void look_for_robot(Subject& ours, Subject& octomap) const {
    const Eigen::Vector3d base =
        posed_.state().world_from_link(setting_.robot.root_link()).translation();
    region_.each([&](const Eigen::Vector3i& index) {
      const Eigen::Vector3d centre = centre_of(index);
      if (distance_[region_.at(index)] <= kAway_m || (centre - base).norm() > 2.0) return;
      for (int map = 0; map < 2; ++map) {
        if (voxel(map, index) != Voxel::kOccupied || posed_.distance(centre) > kAway_m) continue;
        ++(map == 0 ? ours : octomap).robot;
      }
    });
  }

  /// Of the pole's layers those that this image shows.
  void look_for_pole(const DepthCamera& camera, const Taken& taken, Subject& ours,
                     Subject& octomap) {
    std::array<bool, kLayers> shown{};
    each_hit(camera, taken, [&](int shows, const Eigen::Vector3d& point) {
      const int layer = index_at(point).z();
      if (shows == pole_shows_ && layer >= 0 && layer < kLayers)
        shown[static_cast<std::size_t>(layer)] = true;
    });
    for (int map = 0; map < 2; ++map) {
      for (std::size_t layer = 0; layer < kLayers; ++layer) {
        if (pole_looks_[map].empty()) {
          pole_looks_[map].assign(kLayers, 0);
          pole_found_[map].assign(kLayers, true);
        }
        int& looks = pole_looks_[map][layer];
        if (!shown[layer] || (looks > 0 && pole_found_[map][layer])) continue;
        ++looks;
        pole_found_[map][layer] = is_pole_there(map, static_cast<int>(layer));
        if (pole_found_[map][layer]) (map == 0 ? ours : octomap).pole.push_back(looks);
      }
    }
  }

  bool is_pole_there(int map, int layer) const {
    const Eigen::Vector3i middle =
        index_at({scene_.pole.x(), scene_.pole.y(), kVoxel_m * (layer + 0.5)});
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (voxel(map, middle + Eigen::Vector3i(dx, dy, 0)) == Voxel::kOccupied) return true;
    return false;
  }

  /// Voxels that the crate or the ball may be in, and nothing else is near.
  void list_leaving() {
    region_.each([&](const Eigen::Vector3i& index) {
      const Eigen::Vector3d centre = centre_of(index);
      if (distance_[region_.at(index)] <= kAway_m) return;
      const double ball_m =
          std::hypot(centre.x() - scene_.ball().world_from_obstacle.translation().x(),
                     centre.z() - scene_.ball().world_from_obstacle.translation().z()) -
          scene_.ball().size.x();
      if (ball_m > kAway_m && scene_.crate().sample_shape(centre, 0.0).distance > kAway_m) return;
      may_leave_.push_back(index);
    });
    for (std::vector<Leaving>& all : leaving_) all.resize(may_leave_.size());
  }

  void look_after(const DepthCamera& camera, const Taken& taken, double time_s, Subject& ours,
                  Subject& octomap) {
    const Eigen::Isometry3d optical_from_world = taken.world_from_optical.inverse();
    for (std::size_t i = 0; i < may_leave_.size(); ++i) {
      const Eigen::Vector3d centre = centre_of(may_leave_[i]);
      const bool has_left = scene_.nearest_leaving(centre, time_s) > kAway_m;
      std::optional<bool> looks;
      for (int map = 0; map < 2; ++map) {
        Leaving& one = leaving_[map][i];
        const bool occupied = voxel(map, may_leave_[i]) == Voxel::kOccupied;
        if (!has_left) {
          one = {.was_occupied = occupied};
          continue;
        }
        if (!one.was_occupied) continue;
        if (!looks) looks = looks_through(camera, taken, optical_from_world * centre);
        one.looks += *looks ? 1 : 0;
        if (occupied) continue;
        if (one.looks > 0) (map == 0 ? ours : octomap).left.push_back(one.looks);
        one = {};
      }
    }
  }

  /// The image shows something further away, or the end of the range, all over the voxel.
  bool looks_through(const DepthCamera& camera, const Taken& taken,
                     const Eigen::Vector3d& point) const {
    if (point.z() < camera.range_min_m || point.z() + kVoxel_m > setting_.map.range_m) return false;
    const double half_px = kHalfDiagonal_m * camera.fx / point.z();
    const double u = camera.fx * point.x() / point.z() + camera.cx,
                 v = camera.fy * point.y() / point.z() + camera.cy;
    if (u < half_px || v < half_px || u > camera.width - 1 - half_px ||
        v > camera.height - 1 - half_px)
      return false;
    for (int row = static_cast<int>(v - half_px); row <= v + half_px; ++row) {
      for (int column = static_cast<int>(u - half_px); column <= u + half_px; ++column) {
        const std::size_t pixel = static_cast<std::size_t>(row) * camera.width + column;
        const double depth = 1e-3 * taken.truth.depth_mm[pixel];
        if (depth == 0.0 || depth < point.z() + 2.0 * kVoxel_m || is_robot(taken.shows[pixel]))
          return false;
      }
    }
    return true;
  }

  static constexpr int kLayers = 36;

  const Setting& setting_;
  Drive drive_;
  PosedRobot posed_;
  Scene scene_;
  std::uint64_t noise_seed_;
  SimulatedCamera noisy_, exact_;
  SelfFilter filter_;
  int floor_shows_, pole_shows_;
  LocalMap map_;
  octomap::OcTree tree_;

  Region region_{{-96, -96, -24}, {288, 192, 80}};
  std::vector<float> distance_;                         // to what stays, from the centre
  std::vector<std::uint8_t> seen_floor_, seen_solids_;  // in how many images
  std::vector<int> last_seen_;
  int image_ = 0;
  std::array<std::vector<int>, 2> pole_looks_;
  std::array<std::vector<bool>, 2> pole_found_;
  std::vector<Eigen::Vector3i> may_leave_;
  std::array<std::vector<Leaving>, 2> leaving_;
};

Json compared(const Setting& setting, int scenes, std::mt19937_64& random) {
  Subject ours, octomap;
  for (int number = 0; number < scenes; ++number)
    Trial(setting, random, number).run(ours, octomap, random);
  return {{"scenes", scenes}, {"ours", ours.json()}, {"octomap", octomap.json()}};
}

// ---- Endurance.

/// Distances, and what is known and occupied of the window, in the window's order.
std::vector<int> bits_of(const LocalField& field) {
  const VoxelWindow& window = field.window();
  std::vector<int> bits = {window.first.x(), window.first.y(), window.first.z()};
  bits.reserve(window.count() + 3);
  for (int z = 0; z < window.size[2]; ++z) {
    for (int y = 0; y < window.size[1]; ++y) {
      for (int x = 0; x < window.size[0]; ++x) {
        const Eigen::Vector3i index = window.first + Eigen::Vector3i(x, y, z);
        bits.push_back(4 * field.squared_distance(index) + 2 * (field.is_known(index) ? 1 : 0) +
                       (field.is_occupied(index) ? 1 : 0));
      }
    }
  }
  return bits;
}

Json endured(const Setting& setting, int images, std::mt19937_64& random) {
  std::vector<std::pair<double, Eigen::VectorXd>> configurations;
  std::vector<DepthImage> recorded;
  Trial(setting, random, 2).record(configurations, recorded);
  PerceptionOptions options;
  options.map = setting.map;
  Perception perception(std::make_shared<const Robot>(setting.robot), setting.cameras, World{},
                        options);
  const std::size_t cameras = setting.cameras.size();
  std::vector<int> first;
  int drives = 0, returns = 0, different = 0;
  Json resident = Json::object();
  std::vector<double> ms;
  int next_report = 1000;
  while (perception.images() < images) {
    const double away_m = drives % 2 == 0 ? 0.0 : 12.8;
    for (std::size_t step = 0; step < configurations.size(); ++step) {
      const double time_s = kDriven_s * drives + configurations[step].first;
      Eigen::VectorXd q = configurations[step].second;
      q[0] += away_m;
      perception.configuration(time_s, q);
      for (std::size_t c = 0; c < cameras; ++c) {
        DepthImage image = recorded[step * cameras + c];
        image.stamp_s = time_s;
        const double begin = processor_ms();
        perception.image(std::move(image));
        if (drives < 6) ms.push_back(processor_ms() - begin);
      }
      if (perception.images() >= next_report) {
        resident[std::to_string(perception.images())] = resident_megabytes();
        next_report *= 10;
      }
    }
    if (drives++ % 2 != 0) continue;
    const std::vector<int> now = bits_of(*perception.field());
    if (first.empty()) first = now;
    ++returns;
    different += now != first;
  }
  return {{"images", perception.images()},        {"drives", drives},
          {"ends_at_the_start", returns},         {"that_differ_from_the_first", different},
          {"resident_MB_after_images", resident}, {"ms", spread(ms)}};
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("What a local map knows of a scene, beside OctoMap",
                              "map_truth_campaign");
  int scenes = 20, images = 0;
  std::uint64_t seed = 1;
  bool every_ray = false;
  app.add_option("--scenes", scenes, "Scenes that are drawn").positive().show_default();
  app.add_option("--seed", seed, "Of scenes and noise").show_default();
  app.add_flag("--every-ray", every_ray, "OctoMap casts a ray for every pixel");
  app.add_option("--images", images, "So many images of one scene, again and again, instead")
      .not_negative();
  return locograph::run_benchmark(app, argc, argv, [&] {
    const locograph::Robot robot = locograph::shipped("centauro");
    locograph::Setting setting{robot};
    setting.octomap = {.range_m = setting.map.range_m, .discretised = !every_ray};
    std::mt19937_64 random(seed);
    locograph::Json result = {{"seed", seed}, {"level", locograph::simd_level()}};
    result.update(images > 0 ? locograph::endured(setting, images, random)
                             : locograph::compared(setting, scenes, random));
    std::cout << result.dump(2) << '\n';
  });
}
