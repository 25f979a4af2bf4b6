#pragma once
/// Random sets of contacts that a robot can reach, for tests and campaigns of the posture solver.
///
///     const PostureRobot coman = posture_robot("coman_plus");
///     ContactSets sets(coman, 7);
///     const ContactSet set = sets.draw();
///     PostureProblem problem{set.stance, placed_at(model, coman.home, set.stance)};
///
/// How a set is drawn. A configuration: every joint within ±0.4 rad of the home posture and inside
/// its limits, the base tilted by up to 0.15 rad about x and y and turned anywhere; again until it
/// does not collide with itself; then lifted or lowered so that its lowest point is on the ground.
/// What it touches are stones of any height, or the ground where a ball stands on it; a link may
/// reach into what its own contact is on and into nothing else.
/// Then one to four end effectors: for humanoids one foot or both, for robots on four legs three or
/// all of them, since fewer hold them at single configurations only; hands at random. The poses
/// that these have become the contacts, so there is a configuration that closes them without
/// collision. Whether there is one that balances is not known; where the drawn one does, the whole
/// check holds there.

#include <locograph/common/uniform.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/collision_world.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace locograph::test {

struct PostureRobot {
  std::string name;
  std::shared_ptr<const RobotParameter> robot;
  Eigen::VectorXd home;
  std::vector<EndEffector> feet, hands;
  int fewest_feet = 1;

  const Robot& model() const { return *robot->robot; }
};

inline EndEffector surface_contact(const std::string& link, const Eigen::Vector3d& point,
                                   double half_x_m, double half_y_m) {
  EndEffector end;
  end.link = link;
  end.point = point;
  end.half_x_m = half_x_m;
  end.half_y_m = half_y_m;
  end.friction = 0.6;
  end.max_force_N = 3000.0;
  return end;
}

inline EndEffector point_contact(const std::string& link, const Eigen::Vector3d& point) {
  EndEffector end;
  end.link = link;
  end.point = point;
  end.kind = ContactKind::kPoint;
  end.friction = 0.6;
  end.max_force_N = 3000.0;
  return end;
}

/// A foot that is a ball.
inline EndEffector ball_contact(const std::string& link, const Eigen::Vector3d& centre,
                                double radius_m) {
  EndEffector end = point_contact(link, centre);
  end.radius_m = radius_m;
  return end;
}

/// centauro, coman_plus, which come along; go2, anymal, which are public data: data_folder holds
/// their files.
inline PostureRobot posture_robot(const std::string& name, const std::filesystem::path& sources,
                                  const std::filesystem::path& data_folder) {
  PostureRobot robot;
  robot.name = name;
  const bool ours = name == "centauro" || name == "coman_plus";
  const std::filesystem::path folder =
      ours ? sources / "robots/models" / name : data_folder / "robots";
  RobotOptions options;
  options.lenient_srdf = !ours;
  robot.robot = std::make_shared<const RobotParameter>(folder / (name + ".urdf"),
                                                       folder / (name + ".srdf"), options);
  robot.home = robot.model().named_configuration(ours ? "home" : "standing");
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  if (name == "coman_plus") {
    robot.feet = {surface_contact("l_sole", origin, 0.08, 0.04),
                  surface_contact("r_sole", origin, 0.08, 0.04)};
    robot.hands = {point_contact("TCP_L", origin), point_contact("TCP_R", origin)};
  } else if (name == "centauro") {
    // Where the wheel touches, on the fork that carries it; the wheel turns behind it.
    for (const char* leg : {"1", "2", "3", "4"}) {
      robot.feet.push_back(
          surface_contact(std::string("ankle2_") + leg, {0.0, 0.0, -0.09835 - 0.078}, 0.005, 0.04));
    }
    robot.hands = {point_contact("ball1_tip", origin), point_contact("ball2_tip", origin)};
    robot.fewest_feet = 3;
  } else {
    // Of go2 the ball in the rubber, from which the hull of the foot differs by up to 1.5 mm.
    const bool go2 = name == "go2";
    const std::vector<std::string> feet =
        go2 ? std::vector<std::string>{"FL_foot", "FR_foot", "RL_foot", "RR_foot"}
            : std::vector<std::string>{"LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"};
    for (const std::string& foot : feet)
      robot.feet.push_back(go2 ? ball_contact(foot, {-0.002, 0.0, 0.0}, 0.022)
                               : ball_contact(foot, {0.0, 0.0, 0.0225}, 0.03));
    robot.fewest_feet = 3;
  }
  return robot;
}

struct ContactSet {
  Stance stance;
  Eigen::VectorXd drawn;  ///< closes them
};

class ContactSets {
 public:
  ContactSets(const PostureRobot& robot, std::uint64_t seed)
      : robot_(robot), random_(seed), world_(robot.model(), posture_world()) {}

  ContactSet draw() {
    ContactSet set;
    RobotState state(robot_.model());
    for (int i = 0;; ++i) {
      if (i == 10000) throw std::runtime_error("no configuration without collision");
      set.drawn = configuration();
      state.update(set.drawn.data());
      if (world_.self_distance(poses(state)).distance_m > 0.005) break;
    }
    // The distance to the ground, a plane, is the height of the lowest point; as covering spheres
    // have it first, since it is looked for up to a hand's breadth only.
    double lowest = std::numeric_limits<double>::infinity();
    for (const CollisionSphere& sphere : robot_.robot->spheres) {
      const Eigen::Vector3d centre = state.world_from_link(sphere.link) * sphere.center;
      lowest = std::min(lowest, centre.z() - sphere.radius);
    }
    set.drawn[2] -= lowest;
    state.update(set.drawn.data());
    set.drawn[2] -= world_.surroundings({.world_from_link = poses(state)}).surface.distance_m;
    state.update(set.drawn.data());
    for (const EndEffector& end : ends()) set.stance.contacts.push_back(place(end, state));
    if (const double height = height_of_standing_ball(set.stance); height != 0.0) {
      set.drawn[2] -= height;
      for (Contact& contact : set.stance.contacts) contact.position.z() -= height;
    }
    return set;
  }

 private:
  /// Of the lowest contact above the ground, where it is a ball that stands on it up to how the
  /// link's shape differs from a ball; else 0.
  static double height_of_standing_ball(const Stance& stance) {
    constexpr double kDiffers_m = 3e-3;
    const auto lowest = std::min_element(
        stance.contacts.begin(), stance.contacts.end(),
        [](const Contact& a, const Contact& b) { return a.position.z() < b.position.z(); });
    const double height = lowest->position.z();
    return lowest->effector.radius_m > 0.0 && std::abs(height) <= kDiffers_m ? height : 0.0;
  }

  static std::vector<Eigen::Isometry3d> poses(const RobotState& state) {
    std::vector<Eigen::Isometry3d> result;
    for (int link = 0; link < static_cast<int>(state.robot().links().size()); ++link) {
      result.push_back(state.world_from_link(link));
    }
    return result;
  }

  Eigen::VectorXd configuration() {
    constexpr double kSpread_rad = 0.4, kTilt_rad = 0.15;
    Eigen::VectorXd q = robot_.home;
    const Robot& model = robot_.model();
    for (int i = 0; i < model.active_joint_count(); ++i) {
      const Joint& joint = model.active_joint(i);
      double& at = q[7 + i];
      at = uniform(random_, std::max(joint.lower, at - kSpread_rad),
                   std::min(joint.upper, at + kSpread_rad));
    }
    const double yaw = uniform(random_, -EIGEN_PI, EIGEN_PI),
                 roll = uniform(random_, -kTilt_rad, kTilt_rad),
                 pitch = uniform(random_, -kTilt_rad, kTilt_rad);
    q.segment<4>(3) = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                          .coeffs();
    return q;
  }

  std::vector<EndEffector> ends() {
    std::vector<EndEffector> feet = shuffled(robot_.feet), hands = shuffled(robot_.hands);
    const auto count = [&](std::size_t from, std::size_t to) {
      return from + static_cast<std::size_t>(uniform(random_, 0.0, 1.0) *
                                             static_cast<double>(to - from + 1));
    };
    const std::size_t most = 4;
    feet.resize(count(static_cast<std::size_t>(robot_.fewest_feet), feet.size()));
    hands.resize(count(0, std::min(hands.size(), most - feet.size())));
    feet.insert(feet.end(), hands.begin(), hands.end());
    return feet;
  }

  std::vector<EndEffector> shuffled(std::vector<EndEffector> ends) {
    for (std::size_t i = ends.size(); i > 1; --i) {
      std::swap(
          ends[i - 1],
          ends[static_cast<std::size_t>(uniform(random_, 0.0, 1.0) * static_cast<double>(i))]);
    }
    return ends;
  }

  /// On wheels and round ends yaw is free; a round end touches from the side that its frame's z
  /// points to where it is a hand, from above where it is a foot.
  Contact place(const EndEffector& end, const RobotState& state) const {
    const Eigen::Isometry3d& pose = state.world_from_link(robot_.model().link_index(end.link));
    Contact placed;
    placed.effector = end;
    placed.position = pose * end.point;
    placed.normal = pose.linear() * end.normal;
    if (end.kind == ContactKind::kSurface && robot_.name == "coman_plus") {
      placed.forward = pose.linear() * end.forward;
    }
    if (end.kind == ContactKind::kPoint) {
      const bool hand = std::any_of(robot_.hands.begin(), robot_.hands.end(),
                                    [&](const EndEffector& h) { return h.link == end.link; });
      placed.normal = hand ? Eigen::Vector3d(-pose.linear().col(2)) : Eigen::Vector3d::UnitZ();
      placed.position -= end.radius_m * placed.normal;
    }
    return placed;
  }

  const PostureRobot& robot_;
  std::mt19937_64 random_;
  CollisionWorld world_;
};

}  // namespace locograph::test
