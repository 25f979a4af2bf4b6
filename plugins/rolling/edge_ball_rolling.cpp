#include <locograph/plugins/rolling/edge_ball_rolling.h>

namespace locograph {

template class TypedEdgePool<EdgeBallRolling>;

EdgeBallRolling::EdgeBallRolling(int number, double weight) : contact_number(number) {
  weights.setConstant(weight);
}

void EdgeBallRolling::bind(const Parameters& parameters) {
  contact = parameters.get<ContactParameter>(contact_number);
  if (!is_ball(contact->contact.effector)) {
    throw locograph::Error(
        std::string(kTag) + " of " + contact->contact.name() + ", which is no ball",
        "a point contact with a radius");
  }
  track.emplace(contact->contact);
}

BallPose EdgeBallRolling::pose(const ConfigurationState& q) const {
  return BallPose(q.kinematics.world_from_link(contact->link), contact->contact.effector.point);
}

void EdgeBallRolling::error(const ConfigurationState& a, const ConfigurationState& b,
                            Eigen::Ref<Eigen::Vector3d> e) const {
  require_same_robot(kTag, a.robot, contact->robot);
  require_same_robot(kTag, b.robot, contact->robot);
  e = BallStep(*track, pose(a), pose(b)).error;
}

void EdgeBallRolling::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                                JacobianRef<EdgeBallRolling, 0> ja,
                                JacobianRef<EdgeBallRolling, 1> jb) const {
  const BallPose from = pose(a), to = pose(b);
  const BallStep step(*track, from, to);
  const BallStep::Derivative by_from = step.by_from(), by_to = step.by_to();
  const auto add = [&](const ConfigurationState& q, const BallPose& at,
                       const BallStep::Derivative& by, int i, double* row) {
    q.kinematics.add_wrench_gradient(contact->link, at.centre, by.by_centre.row(i),
                                     by.by_turn.row(i), row);
  };
  for (int i = 0; i < 3; ++i) {
    add(a, from, by_from, i, ja.row(i).data());
    add(b, to, by_to, i, jb.row(i).data());
  }
}

RowLabel EdgeBallRolling::row_label(int row) const {
  static constexpr const char* kRows[] = {" slip x", " slip y", " height"};
  return {contact->contact.name() + kRows[row], "m"};
}

}  // namespace locograph
