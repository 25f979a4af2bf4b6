// Bounds without a linear programme, held against the programme.
#include <gtest/gtest.h>
#include <locograph/check/nearby_balance.h>

#include <random>

#include "check/coman_plus_standing.h"

namespace locograph {
namespace {

using test::standing;

Eigen::VectorXd beside(const Eigen::VectorXd& q, double most, std::mt19937& random) {
  Eigen::VectorXd other = q;
  std::uniform_real_distribution<double> uniform(-most, most);
  for (Eigen::Index i = 7; i < other.size(); ++i) other[i] += uniform(random);
  return other;
}

BalanceBounds bounds_at(const Eigen::VectorXd& q, const std::vector<Contact>& contacts,
                        const BalanceOptions& options, const BalanceCertificate& found) {
  RobotState state(*standing().robot);
  state.update(q.data());
  return NearbyBalance(*standing().robot).prove(state, contacts, options, found);
}

/// Both feet, and hands that lean on a wall and hold a bar.
std::vector<Contact> four_contacts() {
  std::vector<Contact> contacts = standing().feet.contacts;
  Contact hand;
  hand.effector = {.name = "left_hand",
                   .link = "LBall",
                   .kind = ContactKind::kPoint,
                   .friction = 0.6,
                   .max_force_N = 300.0};
  hand.normal = {-1.0, 0.0, 0.3};
  contacts.push_back(hand);
  hand.effector = {.name = "right_hand",
                   .link = "RBall",
                   .kind = ContactKind::kGrasp,
                   .max_force_N = 300.0,
                   .max_moment_Nm = 5.0};
  hand.forward = Eigen::Vector3d::UnitY();
  contacts.push_back(hand);
  return contacts;
}

TEST(NearbyBalance, NeverSaysMoreThanTheProgrammeAndSoonSaysAlmostAsMuch) {
  std::mt19937 random(7);
  const Robot& robot = *standing().robot;
  for (const std::vector<Contact>& contacts : {standing().feet.contacts, four_contacts()}) {
    for (const bool enforce : {true, false}) {
      for (const double far : {1e-4, 1e-2, 0.1}) {
        for (int run = 0; run < 5; ++run) {
          BalanceOptions options;
          options.enforce_torque_limits = enforce;
          options.least_torques = true;
          const Eigen::VectorXd from = beside(standing().home, 0.05, random);
          const BalanceCertificate found = certify_balance(robot, from, contacts, options);
          const Eigen::VectorXd to = beside(from, far, random);
          const Eigen::VectorXd slow = Eigen::VectorXd::Constant(robot.tangent_size(), far);
          options.motion = BalanceMotion{slow, slow};
          const BalanceCertificate there = certify_balance(robot, to, contacts, options);
          const BalanceBounds bounds = bounds_at(to, contacts, options, found);
          EXPECT_LE(bounds.margin_at_least, there.margin + 1e-8) << far;
          EXPECT_GE(bounds.torque_ratio_at_most, there.max_torque_ratio - 1e-8) << far;
          if (!found.balanced || far > 1e-3) continue;
          EXPECT_GE(bounds.margin_at_least, there.margin - 0.02);
          EXPECT_LE(bounds.torque_ratio_at_most, there.max_torque_ratio + 0.02);
        }
      }
    }
  }
}

TEST(NearbyBalance, SaysTheSameInTheSameConfiguration) {
  BalanceOptions options;
  options.least_torques = true;
  for (const std::vector<Contact>& contacts : {standing().feet.contacts, four_contacts()}) {
    const BalanceCertificate found =
        certify_balance(*standing().robot, standing().home, contacts, options);
    ASSERT_TRUE(found.balanced);
    const BalanceBounds bounds = bounds_at(standing().home, contacts, options, found);
    EXPECT_NEAR(bounds.margin_at_least, found.margin, 1e-7);
    EXPECT_NEAR(bounds.torque_ratio_at_most, found.max_torque_ratio, 1e-6);
  }
}

TEST(NearbyBalance, ProvesNothingWithOtherContactsOrOutOfBalance) {
  const BalanceCertificate found =
      certify_balance(*standing().robot, standing().home, standing().feet.contacts);
  std::vector<Contact> contacts = standing().feet.contacts;
  contacts[0].bears_load = false;
  EXPECT_LT(bounds_at(standing().home, contacts, {}, found).margin_at_least, -1e300);
  EXPECT_LT(bounds_at(standing().home, four_contacts(), {}, found).margin_at_least, -1e300);
  EXPECT_LT(bounds_at(standing().home, standing().feet.contacts, {}, {}).margin_at_least, -1e300);
  // Thrown sideways by 2 g, nothing holds it.
  BalanceOptions thrown;
  thrown.motion = BalanceMotion{Eigen::VectorXd::Zero(standing().robot->tangent_size()),
                                20.0 * Eigen::VectorXd::Unit(standing().robot->tangent_size(), 1)};
  const BalanceBounds bounds = bounds_at(standing().home, standing().feet.contacts, thrown, found);
  EXPECT_LT(bounds.margin_at_least, 0.0);
  EXPECT_GT(bounds.torque_ratio_at_most, 1e300);
}

}  // namespace
}  // namespace locograph
