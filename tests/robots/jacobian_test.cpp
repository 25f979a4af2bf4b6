// Jacobians and gradients against differences through integrate(), and allocation.
#include <locograph/robots/robot_state.h>

#include "common/allocation_counter.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

using Jacobian6 = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Jacobian3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;

constexpr double kStep = 1e-6;

struct Case {
  const char* name;
  bool floating;
  enum { kCentauro, kSmall, kMimic } robot;  // small: with a prismatic joint
};

class Jacobians : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    const RobotOptions options{.floating_base = GetParam().floating};
    const bool mimic = GetParam().robot == Case::kMimic;
    const std::filesystem::path urdf =
        GetParam().robot == Case::kCentauro
            ? model("centauro/centauro.urdf")
            : folder.write("small.urdf", mimic ? mimic_robot_urdf() : small_robot_urdf());
    robot = std::make_unique<Robot>(Robot::load(urdf, {}, options));
    state = std::make_unique<RobotState>(*robot);
    moved = std::make_unique<RobotState>(*robot);
  }

  /// (f(q + step e_k) - f(q - step e_k)) / (2 step) for a function of the state.
  template <class Function>
  Eigen::VectorXd difference(const Eigen::VectorXd& q, int k, const Function& f) {
    Eigen::VectorXd tangent = Eigen::VectorXd::Zero(robot->tangent_size());
    Eigen::VectorXd next(q.size());
    tangent[k] = kStep;
    robot->integrate(q.data(), tangent.data(), next.data());
    moved->update(next.data());
    const Eigen::VectorXd plus = f(*moved);
    tangent[k] = -kStep;
    robot->integrate(q.data(), tangent.data(), next.data());
    moved->update(next.data());
    const Eigen::VectorXd minus = f(*moved);
    return (plus - minus) / (2.0 * kStep);
  }

  TemporaryFolder folder;
  std::unique_ptr<Robot> robot;
  std::unique_ptr<RobotState> state, moved;
};

TEST_P(Jacobians, OfFramesAreTheDerivativesOfTheirPoses) {
  std::mt19937 random(4);
  Eigen::Isometry3d link_from_frame = Eigen::Isometry3d::Identity();
  link_from_frame.translation() << 0.1, -0.2, 0.3;
  link_from_frame.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  Jacobian6 jacobian(6, robot->tangent_size());
  for (int sample = 0; sample < 3; ++sample) {
    const Eigen::VectorXd q = random_configuration(*robot, random);
    state->update(q.data());
    for (int link = 0; link < static_cast<int>(robot->links().size()); ++link) {
      state->frame_jacobian(link, link_from_frame, jacobian);
      const Eigen::Isometry3d here = state->world_from_link(link) * link_from_frame;
      for (int k = 0; k < robot->tangent_size(); ++k) {
        const Eigen::VectorXd numeric = difference(q, k, [&](const RobotState& other) {
          const Eigen::Isometry3d there = other.world_from_link(link) * link_from_frame;
          const Eigen::AngleAxisd turn(there.linear() * here.linear().transpose());
          Eigen::VectorXd value(6);
          value << there.translation(), turn.angle() * turn.axis();
          return value;
        });
        EXPECT_LT((jacobian.col(k) - numeric).norm(), 1e-6 * (1.0 + numeric.norm()))
            << robot->links()[static_cast<std::size_t>(link)].name << " column " << k;
      }
    }
  }
}

TEST_P(Jacobians, OfTheCentreOfMassIsItsDerivative) {
  std::mt19937 random(5);
  Jacobian3 jacobian(3, robot->tangent_size());
  for (int sample = 0; sample < 5; ++sample) {
    const Eigen::VectorXd q = random_configuration(*robot, random);
    state->update(q.data());
    state->center_of_mass_jacobian(jacobian);
    for (int k = 0; k < robot->tangent_size(); ++k) {
      const Eigen::VectorXd numeric = difference(
          q, k, [](const RobotState& other) { return Eigen::VectorXd(other.center_of_mass()); });
      EXPECT_LT((jacobian.col(k) - numeric).norm(), 1e-6 * (1.0 + numeric.norm()));
    }
  }
}

TEST_P(Jacobians, GivePointGradientsThatAreTheirRows) {
  std::mt19937 random(6);
  Jacobian6 jacobian(6, robot->tangent_size());
  const int stride = 3;
  for (int link = 0; link < static_cast<int>(robot->links().size()); ++link) {
    state->update(random_configuration(*robot, random).data());
    Eigen::Isometry3d link_from_point = Eigen::Isometry3d::Identity();
    link_from_point.translation() = random_vector(3, 0.5, random);
    const Eigen::Vector3d point = state->world_from_link(link) * link_from_point.translation();
    const Eigen::Vector3d direction = random_vector(3, 1.0, random);
    state->frame_jacobian(link, link_from_point, jacobian);
    Eigen::VectorXd row = Eigen::VectorXd::Constant(stride * robot->tangent_size(), 0.25);
    state->add_point_gradient(link, point, direction, -1.7, row.data(), stride);
    for (int k = 0; k < row.size(); ++k) {
      const double added =
          k % stride == 0 ? -1.7 * direction.dot(jacobian.col(k / stride).head<3>()) : 0.0;
      EXPECT_NEAR(row[k], 0.25 + added, 1e-12);
    }
  }
}

TEST_P(Jacobians, OfPointsAreTheLinearRowsOfFrames) {
  std::mt19937 random(10);
  Jacobian6 frame(6, robot->tangent_size());
  for (int link = 0; link < static_cast<int>(robot->links().size()); ++link) {
    state->update(random_configuration(*robot, random).data());
    Eigen::Isometry3d link_from_point = Eigen::Isometry3d::Identity();
    link_from_point.translation() = random_vector(3, 0.5, random);
    state->frame_jacobian(link, link_from_point, frame);
    Jacobian3 point = Jacobian3::Constant(3, robot->tangent_size(), 7.0);
    state->point_jacobian(link, state->world_from_link(link) * link_from_point.translation(),
                          point);
    std::vector<bool> moves(static_cast<std::size_t>(robot->tangent_size()), false);
    std::fill_n(moves.begin(), robot->base_tangent_size(), true);
    for (const int i : robot->support(link)) {
      const int active = robot->axes()[static_cast<std::size_t>(i)].active;
      moves[static_cast<std::size_t>(robot->base_tangent_size() + active)] = true;
    }
    for (int k = 0; k < robot->tangent_size(); ++k) {
      if (moves[static_cast<std::size_t>(k)]) {
        EXPECT_LT((point.col(k) - frame.col(k).head<3>()).norm(), 1e-14);
      } else {
        EXPECT_EQ(point.col(k), Eigen::Vector3d::Constant(7.0));
        EXPECT_TRUE(frame.col(k).isZero(0.0));
      }
    }
  }
}

TEST_P(Jacobians, GiveAxisGradientsThatAreTheirRows) {
  std::mt19937 random(7);
  Jacobian6 jacobian(6, robot->tangent_size());
  const int stride = 2;
  for (int link = 0; link < static_cast<int>(robot->links().size()); ++link) {
    state->update(random_configuration(*robot, random).data());
    const Eigen::Vector3d axis = random_vector(3, 1.0, random).normalized();
    const Eigen::Vector3d direction = random_vector(3, 1.0, random);
    state->frame_jacobian(link, Eigen::Isometry3d::Identity(), jacobian);
    Eigen::VectorXd row = Eigen::VectorXd::Constant(stride * robot->tangent_size(), 0.25);
    state->add_axis_gradient(link, axis, direction, 0.6, row.data(), stride);
    for (int k = 0; k < row.size(); ++k) {
      double added = 0.0;
      if (k % stride == 0) {
        const Eigen::Vector3d omega = jacobian.col(k / stride).tail<3>();
        added = 0.6 * direction.dot(omega.cross(axis));
      }
      EXPECT_NEAR(row[k], 0.25 + added, 1e-12);
    }
  }
}

TEST_P(Jacobians, OfJointsPassThroughTheirOriginsAlongTheirAxes) {
  std::mt19937 random(8);
  state->update(random_configuration(*robot, random).data());
  for (int i = 0; i < static_cast<int>(robot->axes().size()); ++i) {
    const int above = robot->axes()[static_cast<std::size_t>(i)].joint;
    const Joint& joint = robot->joints()[static_cast<std::size_t>(above)];
    const Eigen::Isometry3d& pose = state->world_from_link(joint.child_link);
    EXPECT_LT((state->joint_axis(i) - pose.linear() * joint.axis).norm(), 1e-12);
    const Eigen::Vector3d offset = pose.translation() - state->joint_origin(i);
    EXPECT_LT(offset.cross(state->joint_axis(i)).norm(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Jacobians,
                         testing::Values(Case{"centauro_floating", true, Case::kCentauro},
                                         Case{"centauro_fixed", false, Case::kCentauro},
                                         Case{"small_floating", true, Case::kSmall},
                                         Case{"small_fixed", false, Case::kSmall},
                                         Case{"mimic_floating", true, Case::kMimic},
                                         Case{"mimic_fixed", false, Case::kMimic}),
                         [](const testing::TestParamInfo<Case>& info) { return info.param.name; });

TEST(RobotState, AllocatesNothingOnceBuilt) {
  const Robot robot = Robot::load(model("centauro/centauro.urdf"), model("centauro/centauro.srdf"));
  RobotState state(robot);
  std::mt19937 random(9);
  const Eigen::VectorXd q = random_configuration(robot, random);
  Eigen::VectorXd next = q, tangent = random_vector(robot.tangent_size(), 0.1, random);
  Eigen::VectorXd row = Eigen::VectorXd::Zero(robot.tangent_size());
  Jacobian6 frame(6, robot.tangent_size());
  Jacobian3 com(3, robot.tangent_size());
  const int wheel = robot.link_index("wheel_3");
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const long before = allocation_count();
  ASSERT_GT(before, 0);
  state.update(q.data());
  state.frame_jacobian(wheel, Eigen::Isometry3d::Identity(), frame);
  state.center_of_mass_jacobian(com);
  state.point_jacobian(wheel, Eigen::Vector3d::Ones(), com);
  state.add_point_gradient(wheel, Eigen::Vector3d::Ones(), Eigen::Vector3d::UnitX(), 1.0,
                           row.data());
  state.add_axis_gradient(wheel, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), 1.0,
                          row.data());
  robot.integrate(q.data(), tangent.data(), next.data());
  robot.difference(q.data(), next.data(), tangent.data());
  const Eigen::Vector3d center = state.center_of_mass();
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(center.allFinite());
}

}  // namespace
}  // namespace locograph::test
