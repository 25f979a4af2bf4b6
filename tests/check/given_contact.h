#pragma once
/// Contacts for tests of balance, given by their axes in the link or in the world whatever their
/// kind is, and closed wherever the robot stands.
///
///     GivenContact sole{.link = "l_sole", .half_x_m = 0.08, …};
///     certify_balance(robot, q, contacts_at(robot, q, {sole}));

#include <locograph/robots/contact.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace locograph::test {

struct GivenContact {
  std::string link;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  bool axes_in_world = false;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();
  ContactKind kind = ContactKind::kSurface;
  double half_x_m = 0.0, half_y_m = 0.0, friction = 0.0, max_force_N = 0.0, max_moment_Nm = 0.0;
};

inline std::vector<Contact> contacts_at(const Robot& robot, const Eigen::VectorXd& configuration,
                                        const std::vector<GivenContact>& given) {
  RobotState state(robot);
  Eigen::VectorXd q = configuration;
  if (q.size() == robot.configuration_size() && q.allFinite()) {
    if (robot.floating_base()) q.segment<4>(3).normalize();
    state.update(q.data());
  }
  std::vector<Contact> contacts;
  for (const GivenContact& one : given) {
    const int link = robot.find_link(one.link);
    const Eigen::Isometry3d world_from_link =
        link < 0 ? Eigen::Isometry3d::Identity() : state.world_from_link(link);
    const Eigen::Matrix3d turn = world_from_link.linear();
    Contact contact;
    contact.effector = {.name = "",
                        .link = one.link,
                        .kind = one.kind,
                        .point = one.point,
                        .normal = one.axes_in_world ? turn.transpose() * one.normal : one.normal,
                        .forward = one.axes_in_world ? turn.transpose() * one.forward : one.forward,
                        .half_x_m = one.half_x_m,
                        .half_y_m = one.half_y_m,
                        .friction = one.friction,
                        .max_force_N = one.max_force_N,
                        .max_moment_Nm = one.max_moment_Nm};
    contact.position = world_from_link * one.point;
    contact.normal = one.axes_in_world ? one.normal : turn * one.normal;
    contact.forward = one.axes_in_world ? one.forward : turn * one.forward;
    contacts.push_back(contact);
  }
  return contacts;
}

}  // namespace locograph::test
