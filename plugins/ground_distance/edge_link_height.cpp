#include <locograph/plugins/ground_distance/edge_link_height.h>
#include <locograph/world/link_solid.h>

#include <algorithm>

namespace locograph {

template class TypedEdgePool<EdgeLinkHeight>;

LinkSolids::LinkSolids(const Robot& robot, int link) : link_(link) {
  for (const CollisionShape& shape : robot.links()[static_cast<std::size_t>(link)].collision)
    solids_.push_back({link_solid(robot, shape), shape.link_from_shape});
}

Eigen::Vector3d LinkSolids::lowest_point(const Eigen::Isometry3d& world_from_link) const {
  Eigen::Vector3d lowest = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  for (const Solid& solid : solids_) {
    const Eigen::Isometry3d pose = world_from_link * solid.link_from_shape;
    const Eigen::Vector3d down = -pose.linear().row(2).transpose();
    const Eigen::Vector3d point = pose * solid.shape.support(down);
    if (point.z() < lowest.z()) lowest = point;
  }
  return lowest;
}

double LinkSolids::reach_from(const Eigen::Vector3d& point) const {
  double reach = 0.0;
  for (const Solid& solid : solids_) {
    const Eigen::Vector3d centre = solid.link_from_shape * solid.shape.center();
    reach = std::max(reach, (centre - point).norm() + solid.shape.bounding_radius());
  }
  return reach;
}

EdgeLinkHeight::EdgeLinkHeight(int number, std::string link, double margin, double weight,
                               std::shared_ptr<const LinkSolids> given)
    : robot_number(number), link_name(std::move(link)), margin_m(margin), solids(std::move(given)) {
  weights.setConstant(weight);
}

void EdgeLinkHeight::bind(const Parameters& parameters) {
  require_margin(kTag, margin_m);
  robot = parameters.get<RobotParameter>(robot_number);
  const int link = robot->robot->link_index(link_name);
  if (!solids) solids = std::make_shared<const LinkSolids>(*robot->robot, link);
}

void EdgeLinkHeight::error(const ConfigurationState& q,
                           Eigen::Ref<Eigen::Matrix<double, 1, 1>> e) const {
  require_same_robot(kTag, q.robot, robot);
  e[0] = 0.0;
  if (solids->empty()) return;
  const double z = solids->lowest_point(q.kinematics.world_from_link(solids->link())).z();
  e[0] = std::max(0.0, margin_m - z);
}

void EdgeLinkHeight::jacobians(const ConfigurationState& q,
                               JacobianRef<EdgeLinkHeight, 0> j) const {
  if (solids->empty()) return;
  const int link = solids->link();
  const Eigen::Vector3d lowest = solids->lowest_point(q.kinematics.world_from_link(link));
  if (margin_m - lowest.z() <= 0.0) return;
  q.kinematics.add_point_gradient(link, lowest, Eigen::Vector3d::UnitZ(), -1.0, j.row(0).data());
}

}  // namespace locograph
