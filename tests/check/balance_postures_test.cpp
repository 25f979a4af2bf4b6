// The published postures of COMAN+ under Coulomb's friction and the feet as they are: the table of
// doc/constraints/static_balance.md.
#include <gtest/gtest.h>
#include <locograph/check/balance_certificate.h>
#include <locograph/common/error.h>
#include <locograph/robots/statics.h>

#include <algorithm>

#include "check/coman_plus.h"
#include "check/given_contact.h"
#include "robots/coman_plus_postures.h"

namespace locograph::test {
namespace {

ComanPosture posture_of(const std::string& name) {
  for (const ComanPosture& posture : coman_postures()) {
    if (posture.name == name) return posture;
  }
  throw Error("no posture " + name, "a published one");
}

struct Expected {
  const char* posture;
  double margin;          ///< without torque limits
  double limited_margin;  ///< with them
  double least_ratio;     ///< of a torque to its limit, the largest, at the least
};

/// on_rungs: hands grasp bars, feet stand on them, 2 cm deep.
void expect_balanced(const Expected& expected, bool on_rungs) {
  SCOPED_TRACE(expected.posture);
  const ComanPosture posture = posture_of(expected.posture);
  std::vector<GivenContact> contacts;
  for (const ComanContact& at : posture.contacts) {
    const bool foot = at.frame.ends_with("sole");
    GivenContact contact;
    contact.link = at.frame;
    contact.axes_in_world = true;
    contact.normal = at.normal;
    contact.forward = at.normal.z() > 0.5 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
    contact.kind = foot       ? ContactKind::kSurface
                   : on_rungs ? ContactKind::kGrasp
                              : ContactKind::kPoint;
    contact.half_x_m = on_rungs ? 0.01 : 0.08;
    contact.half_y_m = 0.035;
    contact.friction = posture.name[0] == 'A' ? 0.5 : 0.8;
    contact.max_force_N = !foot && on_rungs ? 500.0 : 1000.0;
    contacts.push_back(contact);
  }
  BalanceOptions options;
  const BalanceCertificate limited =
      certify_balance(coman_plus(), posture.configuration(),
                      contacts_at(coman_plus(), posture.configuration(), contacts), options);
  options.enforce_torque_limits = false;
  options.least_torques = true;
  const BalanceCertificate free =
      certify_balance(coman_plus(), posture.configuration(),
                      contacts_at(coman_plus(), posture.configuration(), contacts), options);
  EXPECT_TRUE(free.balanced);
  EXPECT_TRUE(limited.balanced);
  EXPECT_NEAR(free.margin, expected.margin, 1e-4) << free.limiting;
  EXPECT_NEAR(limited.margin, expected.limited_margin, 1e-4) << limited.limiting;
  EXPECT_NEAR(free.max_torque_ratio, expected.least_ratio, 1e-4);
}

TEST(PublishedPostures, AreBalancedUnderCoulombsFrictionAndWithinTheTorqueLimits) {
  const std::vector<Expected> table = {
      {"A0", 0.1968, 0.1968, 0.4186}, {"A1", 0.0811, 0.0811, 0.0722},
      {"A2", 0.0794, 0.0794, 0.0514}, {"A3", 0.0408, 0.0408, 0.2049},
      {"B0", 0.2605, 0.2605, 0.1338}, {"B1", 0.4432, 0.2119, 0.2957},
      {"B2", 0.4432, 0.2119, 0.2957}, {"C0", 0.2605, 0.2605, 0.1338},
      {"C1", 0.1188, 0.1188, 0.0418}, {"C2", 0.1158, 0.1158, 0.0407},
      {"C3", 0.1185, 0.1185, 0.2959}};
  for (const Expected& expected : table) expect_balanced(expected, false);
}

TEST(PublishedPostures, AreBalancedOnTheLadderWithGraspedRungs) {
  const std::vector<Expected> table = {{"C1", 0.4566, 0.4017, 0.0461},
                                       {"C2", 0.4588, 0.4050, 0.0413},
                                       {"C3", 0.4628, 0.3953, 0.3207}};
  for (const Expected& expected : table) expect_balanced(expected, true);
}

TEST(PublishedPostures, LoadNoJointBeyondItsLimitByThePublishedWrenchesButInB) {
  const std::vector<std::pair<const char*, double>> table = {
      {"A0", 0.419}, {"A1", 0.121}, {"A2", 0.091}, {"A3", 0.367}, {"B0", 0.141},
      {"B1", 1.242}, {"B2", 1.242}, {"C0", 0.141}, {"C2", 0.664}};
  RobotState state(coman_plus());
  for (const auto& [name, expected] : table) {
    const ComanPosture posture = posture_of(name);
    state.update(posture.configuration().data());
    std::vector<PointWrench> wrenches;
    for (const ComanContact& at : posture.contacts) {
      wrenches.push_back(
          {.link = coman_plus().link_index(at.frame), .force = at.force, .moment = at.moment});
    }
    Eigen::VectorXd torques(coman_plus().tangent_size());
    static_torques(state, standard_gravity(), wrenches, torques);
    double largest = 0.0;
    for (int i = 0; i < coman_plus().active_joint_count(); ++i) {
      largest =
          std::max(largest, std::abs(torques[6 + i]) / coman_plus().active_joint(i).max_effort);
    }
    EXPECT_NEAR(largest, expected, 1e-3) << name;
  }
}

}  // namespace
}  // namespace locograph::test
