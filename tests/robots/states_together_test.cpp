// Kinematics of several configurations at once, at each level of vector instructions.
#include <locograph/common/simd_level.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/states_together.h>

#include <limits>

#include "common/allocation_counter.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

/// Points on all links, in two lists of different lengths.
struct Points {
  std::vector<LinkPoint> first, second;

  explicit Points(const Robot& robot) {
    for (int link = 0; link < static_cast<int>(robot.links().size()); ++link) {
      for (int k = 0; k < 3; ++k) first.push_back({link, {0.1 * k, -0.2, 0.03 * link}});
      if (link % 2 == 0) second.push_back({link, {-0.4, 0.05 * link, 0.2}});
    }
  }
};

/// What an update gives, as one list of numbers.
std::vector<double> numbers(const Robot& robot, const RobotState& state) {
  std::vector<double> all;
  const auto add = [&](const auto& matrix) {
    all.insert(all.end(), matrix.data(), matrix.data() + matrix.size());
  };
  for (int link = 0; link < static_cast<int>(robot.links().size()); ++link) {
    add(state.world_from_link(link).matrix());
  }
  for (int axis = 0; axis < static_cast<int>(robot.axes().size()); ++axis) {
    add(state.joint_axis(axis));
    add(state.joint_origin(axis));
  }
  for (int body = 0; body < static_cast<int>(robot.tree().bodies.size()); ++body) {
    add(state.subtree_moment(body));
  }
  return all;
}

/// The same of several at once, with the points after them.
std::vector<std::vector<double>> together(const Robot& robot, const Points& points,
                                          std::span<const Eigen::VectorXd> q,
                                          const TreeKernels& kernels) {
  std::vector<RobotState> states(q.size(), RobotState(robot));
  std::vector<Eigen::MatrixX3d> first(q.size(), Eigen::MatrixX3d(points.first.size(), 3));
  std::vector<Eigen::MatrixX3d> second(q.size(), Eigen::MatrixX3d(points.second.size(), 3));
  std::vector<StateUpdate> updates;
  for (std::size_t i = 0; i < q.size(); ++i) {
    updates.push_back({&states[i], q[i].data(), {first[i].data(), second[i].data()}});
  }
  update_together(updates, points.first, points.second, kernels);
  std::vector<std::vector<double>> result;
  for (std::size_t i = 0; i < q.size(); ++i) {
    result.push_back(numbers(robot, states[i]));
    result.back().insert(result.back().end(), first[i].data(), first[i].data() + first[i].size());
    result.back().insert(result.back().end(), second[i].data(),
                         second[i].data() + second[i].size());
  }
  return result;
}

/// One by one, by RobotState::update().
std::vector<double> alone(const Robot& robot, const Points& points, const Eigen::VectorXd& q) {
  RobotState state(robot);
  state.update(q.data());
  std::vector<double> result = numbers(robot, state);
  for (const std::vector<LinkPoint>* list : {&points.first, &points.second}) {
    for (int r = 0; r < 3; ++r) {
      for (const LinkPoint& point : *list) {
        result.push_back((state.world_from_link(point.link) *
                          Eigen::Vector3d(point.at[0], point.at[1], point.at[2]))[r]);
      }
    }
  }
  return result;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_NEAR(a[i], b[i], tolerance * std::max(1.0, std::abs(b[i]))) << "number " << i;
  }
}

class StatesTogether : public testing::TestWithParam<std::string> {
 protected:
  const TreeKernels& kernels() const { return tree_kernels_at(GetParam()); }

  void expect_agreement(const Robot& robot, const std::string& name) const {
    SCOPED_TRACE(name);
    constexpr std::size_t kMost = 19;  // whole registers, some of one, and one alone
    std::mt19937 random(7);
    const Points points(robot);
    std::vector<Eigen::VectorXd> q;
    for (std::size_t i = 0; i < kMost; ++i) q.push_back(random_configuration(robot, random));
    const auto all = together(robot, points, q, kernels());
    for (std::size_t i = 0; i < kMost; ++i) {
      expect_near(all[i], alone(robot, points, q[i]), 1e-13);
      EXPECT_EQ(together(robot, points, std::span(q).subspan(i, 1), kernels())[0], all[i]);
    }
    EXPECT_EQ(together(robot, points, std::span(q).subspan(3, 5), kernels()),
              (std::vector(all.begin() + 3, all.begin() + 8)));
  }
};

TEST_P(StatesTogether, AgreeWithRobotState) {
  for (const RobotFile& file : public_and_own_robots()) {
    if (!std::filesystem::exists(file.urdf)) continue;
    for (const bool floating : {true, false}) {
      expect_agreement(Robot::load(file.urdf, {}, {.floating_base = floating}), file.name);
    }
  }
}

TEST_P(StatesTogether, KnowMimicJointsAndSlides) {
  const TemporaryFolder folder;
  const auto file = folder.write("mimic.urdf", mimic_robot_urdf());
  expect_agreement(Robot::load(file), "floating");
  expect_agreement(Robot::load(file, {}, {.floating_base = false}), "fixed");
}

TEST_P(StatesTogether, TakeAnyAngleAndKeepToTheirLane) {
  const TemporaryFolder folder;
  const Robot robot = Robot::load(folder.write("mimic.urdf", mimic_robot_urdf()));
  const Points points(robot);
  std::vector<Eigen::VectorXd> q;
  for (const double angle : {0.0, 1e-9, 0.785398163397448, 1.5707963267948966, 3.1415926535897931,
                             -2.5, 101.0, -9e4, 2e5, 1e7}) {
    q.push_back(robot.neutral_configuration());
    q.back()[7] = angle;
  }
  const auto finite = together(robot, points, q, kernels());
  for (std::size_t i = 0; i < q.size(); ++i) {
    SCOPED_TRACE(q[i][7]);
    expect_near(finite[i], alone(robot, points, q[i]), std::abs(q[i][7]) > 1e3 ? 1e-10 : 1e-14);
  }
  q[4][7] = std::numeric_limits<double>::quiet_NaN();
  q[5][7] = std::numeric_limits<double>::infinity();
  const auto broken = together(robot, points, q, kernels());
  for (std::size_t i = 0; i < q.size(); ++i) {
    const bool is_broken = std::ranges::any_of(broken[i], [](double x) { return std::isnan(x); });
    EXPECT_EQ(is_broken, i == 4 || i == 5);
    if (is_broken) continue;
    EXPECT_EQ(broken[i], finite[i]);
  }
}

TEST_P(StatesTogether, AllocateNothingAfterTheFirstTime) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const TemporaryFolder folder;
  const Robot robot = Robot::load(folder.write("mimic.urdf", mimic_robot_urdf()));
  const Eigen::VectorXd q = robot.neutral_configuration();
  std::vector<RobotState> states(9, RobotState(robot));
  std::vector<StateUpdate> updates;
  for (RobotState& state : states) updates.push_back({&state, q.data(), {}});
  const TreeKernels& kernels = this->kernels();
  update_together(updates, {}, {}, kernels);
  const long before = allocation_count();
  update_together(updates, {}, {}, kernels);
  EXPECT_EQ(allocation_count(), before);
}

INSTANTIATE_TEST_SUITE_P(Levels, StatesTogether, testing::ValuesIn(simd_levels()));

}  // namespace
}  // namespace locograph::test
