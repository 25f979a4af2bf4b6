// What a contact can bear: the contact wrench cone, its boundary, and descriptions that are
// refused.
#include <Eigen/QR>

#include "plugins/bad_line.h"
#include "plugins/small_robot.h"
#include "plugins/static_balance_test_support.h"

namespace locograph::test::balance {
namespace {

/// Error of the limits on one contact's wrench.
Eigen::VectorXd limits_of(const Contact& contact, const Eigen::VectorXd& components,
                          const FrictionModel& cone = {}) {
  const RobotCase robot = robot_case("ComanPlus");
  Graph graph = graph_of(robot);
  const auto w = graph.add_vertex(
      0, wrenches_at(graph, add_contacts(graph, robot, {contact}, {cone}), components));
  graph.add_edge(EdgeContactWrench(*graph.vertex(w).contacts, 1.0), w);
  return Evaluated(graph).error(0);
}

TEST(ContactWrenchCone, IsThatOfForcesAtTheCornersFacetByFacet) {
  // Caron's cone: with four sides its sixteen rows are the facets of the cone that the sixteen
  // extreme corner forces span. Each must satisfy all rows, and each row must be tight for forces
  // that span a plane of five dimensions.
  const Contact contact = sole();
  const FrictionModel cone = {FrictionCone::kOuter, 4};
  std::vector<Eigen::VectorXd> rays;
  for (const double x : {-0.08, 0.08}) {
    for (const double y : {-0.035, 0.035}) {
      for (const double fx : {-0.6, 0.6}) {
        for (const double fy : {-0.6, 0.6}) {
          const Eigen::Vector3d force(fx, fy, 1.0), moment = Eigen::Vector3d(x, y, 0).cross(force);
          rays.emplace_back(6);
          rays.back() << force, moment;
        }
      }
    }
  }
  // How far a row is from its limit: pushed outwards along −fz until it is violated for certain.
  const Eigen::VectorXd down = -Eigen::VectorXd::Unit(6, 2);
  Eigen::MatrixXd values(18, 16);
  for (int r = 0; r < 16; ++r) {
    EXPECT_LT(limits_of(contact, rays[r], cone).maxCoeff(), 1e-14);
    // All rows are linear here, so that the hinge can be undone.
    values.col(r) =
        limits_of(contact, rays[r] + 1e3 * down, cone) - limits_of(contact, 1e3 * down, cone);
  }
  int facets = 0;
  for (int row = 0; row < 18; ++row) {
    if (row < 2) continue;  // fz >= 0 follows from friction, fz <= f_max is no part of the cone
    Eigen::MatrixXd tight(6, 0);
    for (int r = 0; r < 16; ++r) {
      EXPECT_LT(values(row, r), 1e-12);
      if (values(row, r) < -1e-9) continue;
      tight.conservativeResize(6, tight.cols() + 1);
      tight.col(tight.cols() - 1) = rays[r];
    }
    ASSERT_GT(tight.cols(), 0) << "row " << row;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(tight);
    factor.setThreshold(1e-9);
    EXPECT_EQ(factor.rank(), 5) << "row " << row;
    ++facets;
  }
  EXPECT_EQ(facets, 16);
}

TEST(ContactWrenchCone, OfTheCircleBearsTheYawOfAnInnerPyramidOnly) {
  const Contact contact = sole();
  Eigen::VectorXd wrench(6);
  const double most = 0.6 / std::sqrt(2.0) * (0.08 + 0.035) * 100.0;
  wrench << 0, 0, 100, 0, 0, most - 1e-9;
  EXPECT_EQ(limits_of(contact, wrench).maxCoeff(), 0.0);
  wrench[5] = most + 1e-3;
  EXPECT_NEAR(limits_of(contact, wrench).maxCoeff(), 1e-3, 1e-9);
}

TEST(ContactWrenchCone, HasACircleOrAPyramidInsideOrAroundIt) {
  Contact contact = sole();
  contact.effector.kind = ContactKind::kPoint;
  FrictionModel cone;
  const auto violation = [&](double angle, double ratio) {
    return limits_of(contact,
                     100.0 * Eigen::Vector3d(ratio * std::cos(angle), ratio * std::sin(angle), 1.0),
                     cone)
        .maxCoeff();
  };
  for (const double angle : {0.0, 0.3, 0.25 * static_cast<double>(EIGEN_PI), 2.0}) {
    EXPECT_EQ(violation(angle, 0.6 - 1e-9), 0.0);
    EXPECT_NEAR(violation(angle, 0.7), 10.0, 1e-12);
  }
  cone = {FrictionCone::kInner, 16};
  for (int i = 0; i < 64; ++i) {
    const double angle = 2.0 * EIGEN_PI * i / 64.0;
    EXPECT_EQ(violation(angle, 0.98 * 0.6), 0.0) << "at least 0.98 mu in every direction";
    EXPECT_GT(violation(angle, 0.6 + 1e-9), 0.0) << "never more than mu";
  }
  cone = {FrictionCone::kOuter, 4};
  EXPECT_EQ(violation(EIGEN_PI / 4.0, 0.6 * std::sqrt(2.0) - 1e-9), 0.0);
  EXPECT_NEAR(violation(0.0, 0.7), 10.0, 1e-12);
}

TEST(ContactLimits, HaveAGradientJustBeyondThem) {
  constexpr double kBeyond = 1e-9;
  const RobotCase robot = robot_case("ComanPlus");
  Graph graph = graph_of(robot);
  Contact rung = sole();
  rung.effector.link = "TCP_R";
  rung.effector.kind = ContactKind::kGrasp;
  rung.effector.max_moment_Nm = 5.0;
  const std::vector<int> numbers = add_contacts(graph, robot, {sole(), rung});
  std::vector<Eigen::VectorXd> states(4, Eigen::VectorXd::Zero(11));
  states[0].head<6>() << 0, 0, -kBeyond, 0, 0, 0;                // pulls
  states[1].head<6>() << 60 + kBeyond, 0, 100, 0, 0, 0;          // slips
  states[2].head<6>() << 0, 0, 100, 0, 8 + kBeyond, 0;           // tilts over its front edge
  states[3].tail<5>() << 0, 0, -1000 - kBeyond, 5 + kBeyond, 0;  // tears the grasp
  for (int i = 0; i < 4; ++i) {
    const auto w = graph.add_vertex(i, wrenches_at(graph, numbers, states[i]));
    graph.add_edge(EdgeContactWrench(*graph.vertex(w).contacts, 1.0), w);
  }
  Evaluated evaluated(graph);
  for (int i = 0; i < 4; ++i) {
    const Eigen::VectorXd e = evaluated.error(i);
    const Eigen::MatrixXd j = evaluated.jacobian(i, 0, false);
    EXPECT_GT(e.maxCoeff(), 0.5 * kBeyond);
    EXPECT_LT(e.maxCoeff(), 2.0 * kBeyond);
    for (int r = 0; r < e.size(); ++r) {
      // Every row has at least one entry that is no smaller than a half size.
      EXPECT_EQ(j.row(r).cwiseAbs().maxCoeff() > 0.01, e[r] > 0.0);
    }
  }
}

constexpr const char* kGood =
    "PARAMS_ROBOT 0 cart.urdf cart.srdf floating 0\n"
    "PARAMS_PLAN 5 2\n"
    "PARAMS_CONTACT 1 0 \"\" arm surface .1 .1 .5 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0\n"
    "PARAMS_CONTACT 2 0 \"\" lift point 0 .5 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0 inner 8\n"
    "PARAMS_CONTACT 3 0 \"\" wheel rung 100 0 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0\n"
    "PARAMS_CONTACT 4 0 \"\" arm point 0 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free unloaded\n"
    "VERTEX_CONFIGURATION 0 0 0 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
    "VERTEX_WRENCHES 1 2 1 2 1 2 3 4 5 6 7 8 9\n";

const BadLine kBadLines[] = {
    {"ContactOfAnUnknownRobot",
     "PARAMS_CONTACT 9 7 \"\" arm point 0 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
     "unknown parameter 7"},
    {"ContactOnAnUnknownLink",
     "PARAMS_CONTACT 9 0 \"\" leg point 0 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0", "leg"},
    {"ContactWithAZeroNormal",
     "PARAMS_CONTACT 9 0 \"\" arm surface 1 1 .5 1 0 0 0 0 0 0 1 0 0 at 0 0 0 0 0 1 1 0 0",
     "normal of length zero"},
    {"ContactWithAZeroForward",
     "PARAMS_CONTACT 9 0 \"\" arm surface 1 1 .5 1 0 0 0 0 0 1 0 0 0 at 0 0 0 0 0 1 1 0 0",
     "forward direction"},
    {"ContactWithAForwardAlongItsNormal",
     "PARAMS_CONTACT 9 0 \"\" arm surface 1 1 .5 1 0 0 0 0 0 1 0 0 -2 at 0 0 0 0 0 1 1 0 0",
     "forward direction"},
    {"ContactWithoutAPlace",
     "PARAMS_CONTACT 9 0 \"\" arm point 0 .5 1 0 0 0 0 0 1 1 0 0 on 0 0 0 0 0 1 1 0 0",
     "'on', expected 'at'"},
    {"ContactWithAZeroNormalInTheWorld",
     "PARAMS_CONTACT 9 0 \"\" arm point 0 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 0 1 0 0",
     "normal of length zero"},
    {"ContactLockedThatIsNoWheel",
     "PARAMS_CONTACT 9 0 \"\" arm point 0 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free locked",
     "is locked, expected wheels only"},
    {"ContactUnloadedTwice",
     "PARAMS_CONTACT 9 0 \"\" arm point 0 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free "
     "unloaded unloaded",
     "'unloaded', expected"},
    {"RungWithoutForward",
     "PARAMS_CONTACT 9 0 \"\" arm rung 1 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "rung without forward"},
    {"BallOfNegativeRadius",
     "PARAMS_CONTACT 9 0 \"\" arm point -.1 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free",
     "radius of -0.1"},
    {"ContactOfAnUnknownKind",
     "PARAMS_CONTACT 9 0 \"\" arm line .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
     "contact kind 'line'"},
    {"ContactWithoutFriction",
     "PARAMS_CONTACT 9 0 \"\" arm point 0 0 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
     "friction coefficient"},
    {"ContactWithNegativeFriction",
     "PARAMS_CONTACT 9 0 \"\" arm surface 1 1 -.5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
     "friction coefficient"},
    {"ContactWithoutForce",
     "PARAMS_CONTACT 9 0 \"\" arm point 0 .5 0 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
     "force limit"},
    {"ContactWithoutLength",
     "PARAMS_CONTACT 9 0 \"\" arm surface 0 1 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
     "half size x"},
    {"ContactWithNegativeWidth",
     "PARAMS_CONTACT 9 0 \"\" arm surface 1 -1 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
     "half size y"},
    {"RungWithANegativeMoment",
     "PARAMS_CONTACT 9 0 \"\" arm rung 1 -1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0",
     "moment limit"},
    {"RungWithACone",
     "PARAMS_CONTACT 9 0 \"\" arm rung 1 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0 inner 8",
     "rung with a friction cone"},
    {"PyramidOfTwoSides",
     "PARAMS_CONTACT 9 0 \"\" arm point 0 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0 inner 2",
     "2 sides"},
    {"PyramidOfUnknownKind",
     "PARAMS_CONTACT 9 0 \"\" arm point 0 .5 1 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0 upper 4",
     "'inner', 'outer', 'bar' or the end"},
    {"ContactWithTooFewFields", "PARAMS_CONTACT 9 0 \"\" arm point 0 .5", "too few fields"},
    {"WrenchesAtNoContact", "VERTEX_WRENCHES 9 0", "number of contacts 0"},
    {"WrenchesAtAnUnknownContact", "VERTEX_WRENCHES 9 1 8 0 0 0", "unknown parameter 8"},
    {"WrenchesAtARobot", "VERTEX_WRENCHES 9 1 0 0 0 0", "parameter 0 is a PARAMS_ROBOT"},
    {"WrenchesAtAnUnloadedContact", "VERTEX_WRENCHES 9 1 4 0 0 0", "contact 4, which is unloaded"},
    {"WrenchesTwiceAtAContact", "VERTEX_WRENCHES 9 2 2 2 0 0 0 0 0 0", "contact 2 twice"},
    {"WrenchesWithTooFewComponents", "VERTEX_WRENCHES 9 2 1 2 0 0 0", "too few fields"},
    {"WrenchesWithTooManyComponents", "VERTEX_WRENCHES 9 1 3 1 2 3 4 5 6", "too many fields"},
    {"WrenchBeyondAllForces", "VERTEX_WRENCHES 9 1 2 0 0 -1e300",
     "a wrench of -1e300 is beyond all forces, expected up to 1e9"},
    {"WrenchThatIsNotANumber", "VERTEX_WRENCHES 9 1 2 nan 0 0", "'nan' is not finite"},
    {"BalanceOfTwoWrenches", "EDGE_BALANCE 1 1 scalar 1",
     "vertex 1 is a VERTEX_WRENCHES, expected a VERTEX_CONFIGURATION"},
    {"ConeOfAnotherSize", "EDGE_CONTACT_WRENCH 1 26 scalar 1", "EDGE_CONTACT_WRENCH with n = 26"},
    {"NormOfAnotherSize", "EDGE_WRENCH_NORM 1 8 scalar 1",
     "EDGE_WRENCH_NORM with n = 8, expected n = 9"},
    {"TorqueLimitsOfAnotherSize", "EDGE_TORQUE_LIMITS 0 1 4 1 scalar 1",
     "EDGE_TORQUE_LIMITS with n = 4"},
    {"TorqueLimitsOfNothing", "EDGE_TORQUE_LIMITS 0 1 3 0 scalar 1", "fraction of 0"},
};

class BadBalance : public testing::TestWithParam<BadLine> {};

TEST_P(BadBalance, IsAnErrorWithItsLine) {
  const TemporaryFolder folder;
  folder.write("cart.urdf", kCartUrdf);
  folder.write("cart.srdf", kCartSrdf);
  expect_bad_line(folder, kGood, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Plugins, BadBalance, testing::ValuesIn(kBadLines), bad_line_name);

/// Evaluates what read well; the message of the Error.
std::string evaluation_error(const std::string& text, const std::string& urdf = kCartUrdf) {
  const TemporaryFolder folder;
  folder.write("cart.urdf", urdf);
  folder.write("cart.srdf", kCartSrdf);
  try {
    Graph graph = read_graph(folder.write("plan.g2o", kGood + text), robot_types());
    Evaluated evaluated(graph);
    for (std::size_t p = 0; p < graph.edge_pools().size(); ++p)
      evaluated.error(0, static_cast<int>(p));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
  return text;
}

TEST(BadBalance, IsAnErrorWhereTheVerticesShowIt) {
  EXPECT_NE(evaluation_error("EDGE_BALANCE 0 1 scalar 1\n").find("mass"), std::string::npos);
  EXPECT_NE(evaluation_error("PARAMS_ROBOT 8 cart.urdf - floating 0\n"
                             "VERTEX_CONFIGURATION 9 8 0 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
                             "EDGE_BALANCE 9 1 scalar 1\n")
                .find("different robots"),
            std::string::npos);
}

TEST(BadBalance, IsAnErrorWhereNoVertexNamesContacts) {
  VertexWrenches nameless;
  EXPECT_THROW(nameless.make_derived(), Error);
}

TEST(BadBalance, IsAnErrorOnAJointWithoutEffort) {
  const std::string weak =
      replaced(kCartUrdf, "velocity=\"8\" effort=\"1\"", "velocity=\"8\" effort=\"0\"");
  ASSERT_NE(weak, kCartUrdf);
  const std::string message = evaluation_error("EDGE_TORQUE_LIMITS 0 1 3 1 scalar 1\n", weak);
  EXPECT_NE(message.find("plan.g2o:9:"), std::string::npos) << message;
  EXPECT_NE(message.find("wheel_joint has an effort limit of 0"), std::string::npos) << message;
}

}  // namespace
}  // namespace locograph::test::balance
