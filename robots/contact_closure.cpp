#include <locograph/robots/contact_closure.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/rolling_ball.h>

namespace locograph {
namespace {

class BallClosure final : public ClosureRows {
 public:
  BallClosure(const Robot& robot, const Contact& contact, const BallPose& from)
      : ClosureRows({0, 1, 2}, robot.link_index(contact.effector.link)),
        point_in_link_(contact.effector.point),
        track_(contact),
        from_(from) {}

  void error(const RobotState& state, double* e) const override {
    Eigen::Map<Eigen::Vector3d> rows(e);
    rows = BallStep(track_, from_, pose(state)).error;
  }

  void add_jacobian(const RobotState& state, double* jacobian,
                    std::ptrdiff_t stride) const override {
    const BallPose to = pose(state);
    const BallStep::Derivative by_to = BallStep(track_, from_, to).by_to();
    for (int row = 0; row < 3; ++row) {
      state.add_wrench_gradient(link(), to.centre, by_to.by_centre.row(row), by_to.by_turn.row(row),
                                jacobian);
      jacobian += stride;
    }
  }

 private:
  BallPose pose(const RobotState& state) const {
    return BallPose(state.world_from_link(link()), point_in_link_);
  }

  Eigen::Vector3d point_in_link_;
  BallTrack track_;
  BallPose from_;
};

}  // namespace

std::optional<ContactRowLabel> ClosureRows::label(int) const { return std::nullopt; }

ContactClosure::ContactClosure(const Robot& robot, const Contact& contact) {
  require_sound_contact(robot, contact);
  rows_ = contact_kind_entry(contact.effector.kind).closure(robot, contact);
}

ContactClosure::ContactClosure(const Robot& robot, const Contact& contact, const BallPose& from) {
  require_sound_contact(robot, contact);
  rows_ = std::make_shared<BallClosure>(robot, contact, from);
}

}  // namespace locograph
