#include <locograph/robots/kinematic_tree.h>
#include <locograph/world/effector_skin.h>
#include <locograph/world/link_solid.h>

#include <algorithm>
#include <limits>

namespace locograph {

std::optional<double> beyond_frame_m(const Robot& robot, const EndEffector& effector) {
  if (effector.kind != ContactKind::kSurface) return std::nullopt;
  const KinematicTree& tree = robot.tree();
  const int own = robot.link_index(effector.link);
  const int body = tree.body_of_link[static_cast<std::size_t>(own)];
  const Eigen::Isometry3d own_from_body = tree.body_from_link(own).inverse();
  const Eigen::Vector3d out = -axes_in_link(effector).col(2);
  std::optional<double> most;
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    if (tree.body_of_link[link] != body) continue;
    const Eigen::Isometry3d own_from_link =
        own_from_body * tree.body_from_link(static_cast<int>(link));
    for (const CollisionShape& shape : robot.links()[link].collision) {
      if (shape.type == ShapeType::kMesh && !shape.mesh_found) continue;
      const Eigen::Isometry3d own_from_shape = own_from_link * shape.link_from_shape;
      const Eigen::Vector3d furthest =
          own_from_shape *
          link_solid(robot, shape).support(own_from_shape.linear().transpose() * out);
      most = std::max(most.value_or(-std::numeric_limits<double>::infinity()),
                      out.dot(furthest - effector.point));
    }
  }
  return most;
}

}  // namespace locograph
