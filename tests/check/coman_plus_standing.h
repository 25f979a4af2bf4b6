#pragma once
/// COMAN+ on both soles on the ground, moving its arms: an honest motion, and what is known of it.
///
///     Motion motion = standing().motion(6);
///     EXPECT_TRUE(standing().check(motion).feasible);

#include <locograph/check/judge.h>

#include <string>
#include <vector>

#include "check/coman_plus.h"
#include "robots/coman_plus_postures.h"

namespace locograph::test {

class Standing {
 public:
  Standing() : robot(&coman_plus(), [](const Robot*) {}) {
    for (const ComanPosture& posture : coman_postures())
      if (posture.name == "B0") home = posture.configuration();
    home.segment<4>(3).normalize();
    RobotState state(*robot);
    state.update(home.data());
    // The soles of the published posture are level up to its digits: the ground is where they are.
    double height = 0.0;
    for (const char* sole : {"l_sole", "r_sole"})
      height += 0.5 * state.world_from_link(robot->link_index(sole)).translation().z();
    home[2] -= height;
    state.update(home.data());
    for (const char* sole : {"l_sole", "r_sole"}) {
      const Eigen::Isometry3d& pose = state.world_from_link(robot->link_index(sole));
      Contact contact;
      contact.effector = {.name = std::string(sole) == "l_sole" ? "left_foot" : "right_foot",
                          .link = sole,
                          .half_x_m = 0.08,
                          .half_y_m = 0.035,
                          .friction = 0.5,
                          .max_force_N = 1000.0};
      contact.position = pose.translation();
      contact.normal = pose.linear().col(2);
      contact.forward = pose.linear().col(0);
      feet.contacts.push_back(contact);
      known.push_back(contact.effector);
    }
  }

  int index(const std::string& joint) const {
    return 7 + robot->joints()[std::size_t(robot->joint_index(joint))].index;
  }
  /// The right elbow, the second last joint but two, bends a little.
  Motion motion(int vertices) const {
    Motion motion;
    motion.stances = {feet};
    motion.stance_from.assign(std::size_t(vertices), 0);
    for (int i = 0; i < vertices; ++i) {
      motion.time_s.push_back(0.5 * i);
      motion.configurations.push_back(home);
      motion.configurations.back()[7 + 24] += 0.02 * i;
    }
    return motion;
  }
  World world() const {
    World world;
    world.surfaces = {ground()};
    return world;
  }
  CheckReport check(const Motion& motion, const CheckOptions& options = {}) const {
    return Judge(robot, world()).check(motion, options);
  }

  std::shared_ptr<const Robot> robot;
  Eigen::VectorXd home;
  Stance feet;
  std::vector<EndEffector> known;
};

inline const Standing& standing() {
  static const Standing instance;
  return instance;
}

}  // namespace locograph::test
