// Gravity torques, mass matrix and inverse dynamics of every robot against an independent library.
#include <locograph/robots/dynamics.h>

#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#include <map>

#include "robots/kdl_test_support.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

constexpr double kKdlTolerance = 1e-12;  // of the largest entry

/// KDL knows fixed bases only. A floating one hangs on six joints in a frame placed where the base
/// is, so that all six stand at zero: there their speeds are the velocity of the base in its own
/// axes, and their forces and torques those on the base.
class KdlDynamics {
 public:
  KdlDynamics(const Robot& robot, const urdf::Link& root, const Eigen::VectorXd& q)
      : robot_(robot), tree_("world"), positions_(robot.tangent_size()) {
    KDL::SetToZero(positions_);
    std::string parent = "world";
    const auto append = [&](const std::string& name, const KDL::Joint& joint,
                            const KDL::Frame& frame, const KDL::RigidBodyInertia& inertia) {
      tree_.addSegment(KDL::Segment(name, joint, frame, inertia), parent);
      parent = name;
    };
    const KDL::RigidBodyInertia nothing = KDL::RigidBodyInertia::Zero();
    if (robot.floating_base()) {
      const KDL::Frame pose(KDL::Rotation::Quaternion(q[3], q[4], q[5], q[6]),
                            KDL::Vector(q[0], q[1], q[2]));
      append("placed", KDL::Joint("placed_joint", KDL::Joint::None), pose, nothing);
      const std::pair<const char*, KDL::Joint::JointType> joints[] = {
          {"base x", KDL::Joint::TransX},   {"base y", KDL::Joint::TransY},
          {"base z", KDL::Joint::TransZ},   {"base roll", KDL::Joint::RotX},
          {"base pitch", KDL::Joint::RotY}, {"base yaw", KDL::Joint::RotZ}};
      for (int k = 0; k < 6; ++k) {
        entry_[joints[k].first] = k;
        const bool last = k == 5;
        append(last ? root.name : joints[k].first, KDL::Joint(joints[k].first, joints[k].second),
               KDL::Frame::Identity(), last ? inertia_of(root) : nothing);
      }
    } else {
      append(root.name, KDL::Joint("placed_joint", KDL::Joint::None), KDL::Frame::Identity(),
             inertia_of(root));
    }
    add_children(root, tree_);
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      entry_[robot.active_joint(i).name] = robot.base_tangent_size() + i;
    }
    Eigen::VectorXd tangent_positions = Eigen::VectorXd::Zero(robot.tangent_size());
    tangent_positions.tail(robot.active_joint_count()) = q.tail(robot.active_joint_count());
    positions_ = to_kdl_order(tangent_positions);
  }

  /// As many as ours if both see the same robot.
  int joint_count() const { return static_cast<int>(tree_.getNrOfJoints()); }

  Eigen::VectorXd torques(const Eigen::VectorXd& velocity, const Eigen::VectorXd& acceleration,
                          const KDL::WrenchMap& wrenches, const Eigen::Vector3d& gravity) const {
    Eigen::VectorXd rates = acceleration;
    if (robot_.floating_base()) {
      // Speeds of the six joints to velocities along the axes of the base, derived once: the
      // translations do not turn with the base, and each rotation turns the axes after it.
      const Eigen::Vector3d linear = velocity.head<3>(), omega = velocity.segment<3>(3);
      rates.head<3>() += omega.cross(linear);
      rates.segment<3>(3) -=
          Eigen::Vector3d(omega.y() * omega.z(), -omega.x() * omega.z(), omega.x() * omega.y());
    }
    KDL::TreeIdSolver_RNE solver(tree_, KDL::Vector(gravity.x(), gravity.y(), gravity.z()));
    KDL::JntArray result(tree_.getNrOfJoints());
    if (solver.CartToJnt(positions_, to_kdl_order(velocity), to_kdl_order(rates), wrenches,
                         result) < 0) {
      ADD_FAILURE() << "KDL refuses";
    }
    Eigen::VectorXd ours(robot_.tangent_size());
    for (const auto& [name, element] : tree_.getSegments()) {
      const KDL::Joint& joint = element.segment.getJoint();
      if (joint.getType() != KDL::Joint::None) {
        ours[entry_.at(joint.getName())] = result(element.q_nr);
      }
    }
    return ours;
  }

 private:
  KDL::JntArray to_kdl_order(const Eigen::VectorXd& tangent) const {
    KDL::JntArray result(tree_.getNrOfJoints());
    for (const auto& [name, element] : tree_.getSegments()) {
      const KDL::Joint& joint = element.segment.getJoint();
      if (joint.getType() != KDL::Joint::None) {
        result(element.q_nr) = tangent[entry_.at(joint.getName())];
      }
    }
    return result;
  }

  const Robot& robot_;
  KDL::Tree tree_;
  KDL::JntArray positions_;
  std::map<std::string, int> entry_;
};

class DynamicsOfKdl : public ComparedTest<std::tuple<RobotFile, bool>> {
 protected:
  void SetUp() override {
    const std::filesystem::path& file = std::get<0>(GetParam()).urdf;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not on this machine";
    source = parse_urdf(file);
    robot =
        std::make_unique<Robot>(Robot::load(file, {}, {.floating_base = std::get<1>(GetParam())}));
    state = std::make_unique<RobotState>(*robot);
    dynamics = std::make_unique<RobotDynamics>(*robot, gravity);
    size = robot->tangent_size();
  }

  KdlDynamics place(const Eigen::VectorXd& q) {
    state->update(q.data());
    KdlDynamics kdl(*robot, *source->getLink(robot->links()[0].name), q);
    EXPECT_EQ(kdl.joint_count(), size);
    return kdl;
  }

  void compare(const Eigen::MatrixXd& ours, const Eigen::MatrixXd& theirs) {
    ComparedTest::compare(ours, theirs, kKdlTolerance);
  }

  // Tilted, so that a base that stands upright feels every component.
  const Eigen::Vector3d gravity = Eigen::Vector3d(1.3, -2.1, -9.4);
  urdf::ModelInterfaceSharedPtr source;
  std::unique_ptr<Robot> robot;
  std::unique_ptr<RobotState> state;
  std::unique_ptr<RobotDynamics> dynamics;
  int size = 0;
};

TEST_P(DynamicsOfKdl, HaveOurGravityTorques) {
  std::mt19937 random(20);
  Eigen::VectorXd torques(size);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
  for (int sample = 0; sample < 8; ++sample) {
    const Eigen::VectorXd q = sample % 2 == 0 ? random_configuration(*robot, random)
                                              : configuration_at_limits(*robot, random);
    const KdlDynamics kdl = place(q);
    gravity_torques(*state, gravity, torques);
    compare(torques, kdl.torques(zero, zero, {}, gravity));
  }
}

TEST_P(DynamicsOfKdl, HaveOurMassMatrix) {
  std::mt19937 random(21);
  Eigen::MatrixXd mass(size, size), expected(size, size);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
  for (int sample = 0; sample < 2; ++sample) {
    const KdlDynamics kdl = place(random_configuration(*robot, random));
    dynamics->mass_matrix(*state, mass);
    for (int k = 0; k < size; ++k) {
      expected.col(k) =
          kdl.torques(zero, Eigen::VectorXd::Unit(size, k), {}, Eigen::Vector3d::Zero());
    }
    // Each entry by the inertias it couples: a wrist is judged by its own, not by the trunk's.
    const Eigen::VectorXd scale = expected.diagonal().cwiseSqrt().cwiseInverse();
    compare(scale.asDiagonal() * mass * scale.asDiagonal(),
            scale.asDiagonal() * expected * scale.asDiagonal());
  }
}

TEST_P(DynamicsOfKdl, HaveOurInverseDynamics) {
  std::mt19937 random(22);
  Eigen::VectorXd torques(size);
  for (int sample = 0; sample < 8; ++sample) {
    const KdlDynamics kdl = place(random_configuration(*robot, random));
    const Eigen::VectorXd velocity = random_vector(size, 3.0, random);
    const Eigen::VectorXd acceleration = random_vector(size, 10.0, random);
    dynamics->inverse_dynamics(*state, velocity, acceleration, {}, torques);
    compare(torques, kdl.torques(velocity, acceleration, {}, gravity));
  }
}

TEST_P(DynamicsOfKdl, HaveOurInverseDynamicsWithWrenches) {
  std::mt19937 random(23);
  Eigen::VectorXd torques(size);
  for (int sample = 0; sample < 8; ++sample) {
    const KdlDynamics kdl = place(random_configuration(*robot, random));
    const std::vector<PointWrench> wrenches = random_wrenches(*robot, 3, random);
    KDL::WrenchMap theirs;
    for (const PointWrench& wrench : wrenches) {
      const Link& link = robot->links()[static_cast<std::size_t>(wrench.link)];
      const Eigen::Matrix3d link_from_world =
          state->world_from_link(wrench.link).linear().transpose();
      const Eigen::Vector3d force = link_from_world * wrench.force;
      const Eigen::Vector3d moment = link_from_world * wrench.moment + wrench.point.cross(force);
      theirs[link.name] += KDL::Wrench(KDL::Vector(force.x(), force.y(), force.z()),
                                       KDL::Vector(moment.x(), moment.y(), moment.z()));
    }
    const Eigen::VectorXd velocity = random_vector(size, 3.0, random);
    const Eigen::VectorXd acceleration = random_vector(size, 10.0, random);
    dynamics->inverse_dynamics(*state, velocity, acceleration, wrenches, torques);
    compare(torques, kdl.torques(velocity, acceleration, theirs, gravity));
  }
}

INSTANTIATE_TEST_SUITE_P(All, DynamicsOfKdl,
                         testing::Combine(testing::ValuesIn(public_and_own_robots()),
                                          testing::Bool()),
                         floating_or_fixed<RobotFile>);

}  // namespace
}  // namespace locograph::test
