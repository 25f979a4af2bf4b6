#include <locograph/check/judged_kind.h>
#include <locograph/check/loaded_contact.h>

namespace locograph {
namespace {

/// A wheel's disc in its link: its centre, and the axis of the joint above.
Eigen::Vector3d lowest_of_disc(const RobotState& state, const Contact& contact, int link) {
  const Robot& robot = state.robot();
  const Joint& joint =
      robot.joints()[std::size_t(robot.links()[static_cast<std::size_t>(link)].parent_joint)];
  const Eigen::Isometry3d& pose = state.world_from_link(link);
  const Eigen::Vector3d axle = pose.linear() * joint.axis;
  const Eigen::Vector3d normal = contact.normal.stableNormalized();
  const Eigen::Vector3d up = normal - axle * axle.dot(normal);
  const Eigen::Vector3d centre = pose * contact.effector.point;
  // A disc that lies flat touches anywhere: its centre is no worse a guess than another.
  if (up.norm() < 1e-9) return centre;
  return centre - up.normalized() * contact.effector.radius_m;
}

}  // namespace

LoadedContact loaded_contact(const RobotState& state, const Contact& given) {
  const EndEffector& effector = given.effector;
  require_judged_kind(effector);
  const int link = state.robot().link_index(effector.link);
  const Eigen::Isometry3d& pose = state.world_from_link(link);
  const bool fixed_in_link =
      effector.kind == ContactKind::kSurface || effector.kind == ContactKind::kGrasp;
  LoadedContact contact{&given, &effector, link, {}, pose * effector.point};
  contact.axes = fixed_in_link ? pose.linear() * axes_in_link(effector) : axes_in_world(given);
  if (effector.kind == ContactKind::kPoint) {
    contact.point -= effector.radius_m * contact.axes.col(2);
  } else if (effector.kind == ContactKind::kWheel) {
    contact.point = lowest_of_disc(state, given, link);
  }
  return contact;
}

std::vector<Eigen::Vector2d> corners_of(const EndEffector& effector,
                                        const std::vector<Eigen::Vector2d>& area) {
  std::vector<Eigen::Vector2d> corners = area;
  for (int corner = 0; area.empty() && corner < 4; ++corner) {
    corners.emplace_back(corner < 2 ? effector.half_x_m : -effector.half_x_m,
                         corner % 2 == 0 ? effector.half_y_m : -effector.half_y_m);
  }
  return corners;
}

}  // namespace locograph
