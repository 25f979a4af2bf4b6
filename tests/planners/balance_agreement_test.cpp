// Wrenches found by a graph and the certificate, which shares no code with its edges, agree on what
// is balanced. The benchmark balance_agreement does the same on thousands of postures.
#include <gtest/gtest.h>
#include <locograph/planners/plan/balance_certificate.h>

#include <cmath>

#include "benchmarks/planners/balance_cases.h"

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

}  // namespace
}  // namespace locograph
