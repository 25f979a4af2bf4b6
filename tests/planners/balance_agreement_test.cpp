// Wrenches found by a graph and the certificate, which shares no code with its edges, agree on what
// is balanced. The benchmark balance_agreement does the same on thousands of postures.
#include <gtest/gtest.h>
#include <locograph/check/balance_certificate.h>

#include <cmath>

#include "benchmarks/planners/balance_cases.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

class BalanceAgreement : public testing::TestWithParam<std::string> {};

TEST_P(BalanceAgreement, HoldsOnRandomPosturesButForTheYawThatTheRowsOfASurfaceDoNotGrant) {
  const BalanceRobot robot = balance_robot(GetParam());
  std::mt19937_64 random(7);
  int balanced = 0, judged = 0, refused_by_rows = 0;
  for (int i = 0; i < 30; ++i) {
    const BalanceCase posture = draw_balance_case(robot, random);
    const BalanceCertificate certificate =
        certify_balance(robot.model(), posture.configuration, posture.contacts);
    const BalanceCase unlimited = without_surface_limits(robot, posture);
    const BalanceCertificate without_limits =
        certify_balance(robot.model(), unlimited.configuration, unlimited.contacts);
    if (std::min(std::abs(certificate.margin), std::abs(without_limits.margin)) <= 1e-3) continue;
    ++judged;
    balanced += certificate.balanced;
    const bool rows = graph_residual(robot, posture, SurfaceModel::kRows) <= kGraphBalanced;
    const bool corners = graph_residual(robot, unlimited, SurfaceModel::kCorners) <= kGraphBalanced;
    EXPECT_EQ(corners, without_limits.balanced) << i << ": " << without_limits.margin;
    EXPECT_LE(rows, certificate.balanced) << i << ": " << certificate.margin;
    refused_by_rows += !rows && certificate.balanced;
  }
  EXPECT_GE(judged, 28);
  EXPECT_GE(balanced, 8);
  EXPECT_GE(judged - balanced, 8);
  EXPECT_LE(refused_by_rows, 1);
}

INSTANTIATE_TEST_SUITE_P(Robots, BalanceAgreement, testing::Values("coman_plus", "centauro"),
                         [](const testing::TestParamInfo<std::string>& info) {
                           return info.param;
                         });

TEST(BalanceAgreement, EndsWhereTheRowsOfASurfaceGrantYawToForcesAtFullFriction) {
  // A block of 10 kg squeezed by two walls, its centre of mass 4 cm beyond their edge: forces at
  // the corners of the edge that use 97 % of their friction to bear the weight cannot turn it.
  const test::TemporaryFolder folder;
  const std::string inertia = "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>";
  const auto urdf = folder.write(
      "block.urdf",
      "<robot name='block'><link name='block'><inertial><origin xyz='0 0.09 0'/><mass "
      "value='10'/>" +
          inertia +
          "</inertial></link><link name='knob'/><joint name='knob_joint' type='revolute'><parent "
          "link='block'/><child link='knob'/><axis xyz='0 1 0'/><limit lower='-1' upper='1' "
          "velocity='1' effort='1'/></joint></robot>");
  const BalanceRobot robot = {"block", std::make_shared<const RobotParameter>(
                                           urdf, std::filesystem::path(), RobotOptions{})};
  BalanceCase posture;
  posture.configuration = robot.model().neutral_configuration();
  for (const double side : {-1.0, 1.0}) {
    Contact contact;
    EndEffector& wall = contact.effector;
    wall.link = "block";
    contact.normal = wall.normal = Eigen::Vector3d(side, 0.0, 0.0);
    contact.forward = wall.forward = Eigen::Vector3d::UnitZ();
    contact.position = wall.point = -0.2 * wall.normal;
    wall.half_x_m = 0.1;
    wall.half_y_m = 0.05;
    wall.friction = 0.7;
    wall.max_force_N = 0.5 * 10.0 * 9.81 / (0.97 * wall.friction);
    posture.contacts.push_back(contact);
  }
  EXPECT_LT(graph_residual(robot, posture, SurfaceModel::kRows), kGraphBalanced);
  const BalanceCertificate certificate =
      certify_balance(robot.model(), posture.configuration, posture.contacts);
  EXPECT_FALSE(certificate.balanced);
  EXPECT_LT(certificate.margin, -1e-3);
  posture.facets = 4;
  EXPECT_GT(graph_residual(robot, posture, SurfaceModel::kRows), 10.0 * kGraphBalanced)
      << "four sides: the rows are those of forces at the corners";
}

}  // namespace
}  // namespace locograph
