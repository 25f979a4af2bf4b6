// The certificate of static balance against cases worked out by hand, and its wrenches against the
// conditions they are to satisfy.
#include <gtest/gtest.h>
#include <locograph/check/balance_certificate.h>
#include <locograph/common/error.h>
#include <locograph/robots/robot_state.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <thread>

#include "check/coman_plus.h"
#include "check/given_contact.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::coman_plus;
using test::GivenContact;

constexpr double kGravity = 9.81;
constexpr double kWeight = 10.0 * kGravity;  // of the block
const double kInner16 = std::cos(std::numbers::pi / 16.0);

/// A robot of one link of 10 kg.
Robot block(const Vector3d& com) {
  const test::TemporaryFolder folder;
  const std::string xyz =
      std::to_string(com.x()) + " " + std::to_string(com.y()) + " " + std::to_string(com.z());
  return Robot::load(folder.write(
      "block.urdf", "<robot name='block'><link name='block'><inertial><origin xyz='" + xyz +
                        "'/><mass value='10'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
                        "izz='1'/></inertial></link></robot>"));
}

/// On a fixed or a floating base of 1 kg, a massless arm along x of 1 m with 2 kg at its end.
Robot arm(double effort, bool floating) {
  const test::TemporaryFolder folder;
  const std::string inertia = "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>";
  RobotOptions options;
  options.floating_base = floating;
  return Robot::load(
      folder.write("arm.urdf",
                   "<robot name='arm'><link name='foot'><inertial><mass value='1'/>" + inertia +
                       "</inertial></link><link name='arm'><inertial><origin xyz='1 0 0'/><mass "
                       "value='2'/>" +
                       inertia +
                       "</inertial></link><joint name='shoulder' type='revolute'><parent "
                       "link='foot'/><child link='arm'/><axis xyz='0 1 0'/><limit lower='-1' "
                       "upper='1' velocity='1' effort='" +
                       std::to_string(effort) + "'/></joint></robot>"),
      {}, options);
}

VectorXd standing(const Robot& robot,
                  const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity()) {
  VectorXd q = robot.neutral_configuration();
  q.segment<4>(3) = turned.coeffs();
  return q;
}

Eigen::Quaterniond tilt(double angle, double azimuth) {
  return Eigen::Quaterniond(
      Eigen::AngleAxisd(angle, Vector3d(-std::sin(azimuth), std::cos(azimuth), 0.0)));
}

GivenContact contact_at(const std::string& link, ContactKind kind, double mu) {
  GivenContact contact;
  contact.link = link;
  contact.kind = kind;
  contact.half_x_m = 0.1;
  contact.half_y_m = 0.05;
  contact.friction = mu;
  contact.max_force_N = 1e4;
  return contact;
}

BalanceCertificate certify(const Robot& robot, const VectorXd& q,
                           const std::vector<GivenContact>& contacts,
                           const BalanceOptions& options = {}) {
  return certify_balance(robot, q, test::contacts_at(robot, q, contacts), options);
}

TEST(BalanceCertificate, TipsABlockAtTheEdgeOfItsBase) {
  const GivenContact base = contact_at("block", ContactKind::kSurface, 0.5);
  for (const double x : {0.0, 0.05, 0.0999, 0.1001, 0.2}) {
    const Robot robot = block({x, 0.0, 0.3});
    const BalanceCertificate certificate = certify(robot, standing(robot), {base});
    EXPECT_EQ(certificate.balanced, x < 0.1) << x;
    if (x > 0.1) {
      EXPECT_LT(certificate.margin, 0.0);
      continue;
    }
    // The corners of the far side bear what is least.
    EXPECT_NEAR(certificate.margin, 0.5 * kInner16 * (1.0 - x / 0.1), 1e-8);
    const VectorXd expected = (VectorXd(6) << 0, 0, kWeight, 0, -x * kWeight, 0).finished();
    EXPECT_LT((certificate.wrenches[0] - expected).norm(), 1e-6 * kWeight);
    const std::string far = x > 0.0 ? "friction of block at its corner -x" : "friction of block";
    EXPECT_EQ(certificate.limiting.find(far), 0u) << certificate.limiting;
    EXPECT_EQ(certificate.max_torque_ratio, 0.0);
  }
}

TEST(BalanceCertificate, SlipsABlockAtTheAngleOfFrictionInEveryDirection) {
  const Robot robot = block({0.0, 0.0, 0.0});
  for (const double mu : {0.3, 0.8}) {
    for (const ContactKind kind : {ContactKind::kSurface, ContactKind::kPoint}) {
      const GivenContact base = contact_at("block", kind, mu);
      for (int i = 0; i < 24; ++i) {
        const double azimuth = 0.1 + 2.0 * std::numbers::pi * i / 24.0;
        const auto at = [&](double angle) {
          return certify(robot, standing(robot, tilt(angle, azimuth)), {base}).balanced;
        };
        EXPECT_TRUE(at(std::atan(0.98 * mu))) << mu << " at " << azimuth;
        EXPECT_FALSE(at(std::atan(1.0001 * mu))) << mu << " at " << azimuth;
      }
      const double angle = 0.5 * std::atan(mu);  // downhill along x, where a side of the pyramid is
      EXPECT_NEAR(certify(robot, standing(robot, tilt(angle, 0.0)), {base}).margin,
                  mu * kInner16 * std::cos(angle) - std::sin(angle), 1e-8);
    }
  }
}

TEST(BalanceCertificate, SqueezesABlockBetweenTwoWalls) {
  const Robot robot = block({0.0, 0.0, 0.0});
  const double mu = 0.5, least = 0.5 * kWeight / (mu * kInner16);
  for (const double force : {0.5 * least, 0.999 * least, 1.001 * least, 3.0 * least}) {
    std::vector<GivenContact> walls(2, contact_at("block", ContactKind::kPoint, mu));
    for (const int i : {0, 1}) {
      GivenContact& wall = walls[std::size_t(i)];
      wall.normal = Vector3d(i == 0 ? 1.0 : -1.0, 0.0, 0.0);
      wall.point = -0.1 * wall.normal;
      wall.forward = Vector3d::UnitZ();
      wall.max_force_N = force;
    }
    const BalanceCertificate certificate = certify(robot, standing(robot), walls);
    EXPECT_EQ(certificate.balanced, force > least);
    if (!certificate.balanced) {
      EXPECT_LT(certificate.margin, 0.0);
      continue;
    }
    // mu f - W / 2 = s W with f = (1 - s) f_max.
    EXPECT_NEAR(certificate.margin,
                (mu * kInner16 * force - 0.5 * kWeight) / (kWeight + mu * kInner16 * force), 1e-8);
    EXPECT_NEAR(certificate.wrenches[0][0], 0.5 * kWeight, 1e-6 * kWeight);
  }
}

TEST(BalanceCertificate, HangsABlockFromARungThatTakesNoMomentAboutItsBar) {
  GivenContact rung = contact_at("block", ContactKind::kGrasp, 0.0);
  rung.point = Vector3d(0.0, 0.0, 0.3);
  rung.max_force_N = 4.0 * kWeight;
  rung.max_moment_Nm = 0.1 * kWeight;
  rung.normal = -Vector3d::UnitZ();  // pulled
  const auto hung = [&](const Vector3d& com) {
    const Robot robot = block(com);
    return certify(robot, standing(robot), {rung});
  };
  EXPECT_NEAR(hung({0, 0, 0}).margin, 0.75, 1e-8);
  EXPECT_EQ(hung({0, 0, 0}).limiting, "force limit of block");
  EXPECT_NEAR(hung({0, 0, 0}).wrenches[0][2], -kWeight, 1e-6);
  EXPECT_NEAR(hung({0, 0.05, 0}).margin, 0.5, 1e-8);
  EXPECT_EQ(hung({0, 0.05, 0}).limiting, "moment limit of block");
  EXPECT_FALSE(hung({0, 0.11, 0}).balanced);
  const BalanceCertificate turned = hung({0.02, 0, 0});
  EXPECT_FALSE(turned.balanced) << "nothing holds it about the bar";
  // Left over at the base: a moment of s W 1 m and a force of s W, 0.3 m below the bar.
  EXPECT_NEAR(turned.margin, -0.02 / 1.3, 1e-8);
  EXPECT_EQ(turned.limiting, "a moment on the base is left over");
  rung.max_moment_Nm = 0.0;
  EXPECT_NEAR(hung({0, 0, 0}).margin, 0.75, 1e-8);
  EXPECT_FALSE(hung({0, 0.001, 0}).balanced);
}

TEST(BalanceCertificate, ReachesATorqueLimitExactly) {
  const double needed = 2.0 * kGravity;
  GivenContact foot = contact_at("foot", ContactKind::kSurface, 0.5);
  foot.half_x_m = 2.0;
  for (const double effort : {0.5, 0.999, 1.0, 1.001, 1.1}) {
    const Robot robot = arm(effort * needed, true);
    const BalanceCertificate certificate = certify(robot, standing(robot), {foot});
    EXPECT_EQ(certificate.balanced, effort >= 1.0) << effort << ": " << certificate.margin;
    EXPECT_NEAR(certificate.margin, 1.0 - 1.0 / effort, 1e-5);
    EXPECT_NEAR(certificate.max_torque_ratio, 1.0 / effort, 1e-5);
    EXPECT_EQ(certificate.limiting, "torque of shoulder, which no contact loads");
    BalanceOptions report;
    report.enforce_torque_limits = false;
    const BalanceCertificate reported = certify(robot, standing(robot), {foot}, report);
    EXPECT_TRUE(reported.balanced);
    EXPECT_NEAR(reported.max_torque_ratio, 1.0 / effort, 1e-5);
  }
  // A hand at the end of the arm shares the load.
  const Robot robot = arm(0.5 * needed, true);
  GivenContact hand = contact_at("arm", ContactKind::kPoint, 0.5);
  hand.point = Vector3d::UnitX();
  const BalanceCertificate shared = certify(robot, standing(robot), {foot, hand});
  EXPECT_TRUE(shared.balanced);
  EXPECT_LT(shared.max_torque_ratio, 1.0 - shared.margin + 1e-8);
  // The hand can take all of it.
  BalanceOptions least;
  least.least_torques = true;
  EXPECT_NEAR(certify(robot, standing(robot), {foot, hand}, least).max_torque_ratio, 0.0, 1e-8);
  EXPECT_EQ(certify(robot, standing(robot), {foot, hand}, least).margin, shared.margin);
  hand.max_force_N = 0.4 * needed;
  EXPECT_NEAR(certify(robot, standing(robot), {foot, hand}, least).max_torque_ratio, 1.2, 1e-5);
  least.enforce_torque_limits = false;
  EXPECT_NEAR(certify(robot, standing(robot), {foot, hand}, least).max_torque_ratio, 1.2, 1e-5);
  EXPECT_NEAR(certify(robot, standing(robot), {foot}, least).max_torque_ratio, 2.0, 1e-5);
}

TEST(BalanceCertificate, ScalesEveryEffortAlike) {
  const double needed = 2.0 * kGravity;
  const Robot robot = arm(1.6 * needed, true);
  GivenContact foot = contact_at("foot", ContactKind::kSurface, 0.5);
  foot.half_x_m = 2.0;
  GivenContact hand = contact_at("arm", ContactKind::kPoint, 0.5);
  hand.point = Vector3d::UnitX();
  hand.max_force_N = 0.4 * needed;
  BalanceOptions half;
  half.effort_scale = 0.5;
  const BalanceCertificate weak = certify(robot, standing(robot), {foot}, half);
  EXPECT_FALSE(weak.balanced);
  EXPECT_NEAR(weak.margin, 1.0 - 2.0 / 1.6, 1e-5);
  EXPECT_NEAR(weak.max_torque_ratio, 2.0 * certify(robot, standing(robot), {foot}).max_torque_ratio,
              1e-8);
  // As a robot that has half the effort, with joints that contacts load, too.
  const Robot halved = arm(0.8 * needed, true);
  for (const bool least : {false, true}) {
    BalanceOptions whole;
    whole.least_torques = half.least_torques = least;
    const BalanceCertificate scaled = certify(robot, standing(robot), {foot, hand}, half),
                             own = certify(halved, standing(halved), {foot, hand}, whole);
    EXPECT_TRUE(scaled.balanced);
    EXPECT_NEAR(scaled.margin, own.margin, 1e-8);
    EXPECT_NEAR(scaled.max_torque_ratio, own.max_torque_ratio, 1e-8);
  }
}

TEST(BalanceCertificate, AsksAFixedBaseForTorquesOnly) {
  const double needed = 2.0 * kGravity;
  const Robot strong = arm(2.0 * needed, false), weak = arm(0.5 * needed, false);
  EXPECT_NEAR(certify(strong, VectorXd::Zero(1), {}).margin, 0.5, 1e-6);
  const BalanceCertificate alone = certify(weak, VectorXd::Zero(1), {});
  EXPECT_FALSE(alone.balanced);
  EXPECT_NEAR(alone.margin, -1.0, 1e-5);
  GivenContact hand = contact_at("arm", ContactKind::kPoint, 0.5);
  hand.point = Vector3d::UnitX();
  EXPECT_TRUE(certify(weak, VectorXd::Zero(1), {hand}).balanced);
  hand.max_force_N = 0.49 * needed;
  const BalanceCertificate light = certify(weak, VectorXd::Zero(1), {hand});
  EXPECT_FALSE(light.balanced);
  EXPECT_LT(light.margin, 0.0);
}

TEST(BalanceCertificate, SaysThatNothingHoldsARobotWithoutContacts) {
  const Robot robot = block({0.0, 0.0, 0.0});
  const BalanceCertificate certificate = certify(robot, standing(robot), {});
  EXPECT_FALSE(certificate.balanced);
  EXPECT_NEAR(certificate.margin, -1.0, 1e-8);
  EXPECT_TRUE(certificate.wrenches.empty());
  EXPECT_EQ(certificate.limiting, "a force on the base is left over");
}

/// Rows of Caron, Pham & Nakamura 2015 for forces in pyramids of four sides, the largest of them.
double caron(const VectorXd& w, double X, double Y, double mu) {
  const double fx = w[0], fy = w[1], fz = w[2], mx = w[3], my = w[4], mz = w[5];
  return std::max(
      {std::abs(fx) - mu * fz, std::abs(fy) - mu * fz, std::abs(mx) - Y * fz, std::abs(my) - X * fz,
       std::abs(Y * fx - mu * mx) + std::abs(X * fy - mu * my) - mu * (X + Y) * fz - mz,
       std::abs(Y * fx + mu * mx) + std::abs(X * fy + mu * my) - mu * (X + Y) * fz + mz});
}

TEST(BalanceCertificate, HasTheClosedFormOfTheContactWrenchConeForFourSides) {
  // On a slope a block asks its base for any force through its centre of mass.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double mu = 0.7, inner = mu / std::sqrt(2.0);
  BalanceOptions four;
  four.facets = 4;
  int inside = 0;
  const GivenContact base = contact_at("block", ContactKind::kSurface, mu);
  for (int i = 0; i < 200; ++i) {
    const Vector3d com(0.2 * uniform(random), 0.2 * uniform(random), 0.1 * uniform(random));
    const Robot robot = block(com);
    const Eigen::Quaterniond turned = tilt(0.5 * uniform(random), 3.0 * uniform(random));
    VectorXd wrench(6);
    wrench.head<3>() = turned.inverse() * Vector3d(0.0, 0.0, kWeight);
    wrench.tail<3>() = robot.links()[0].com.cross(Vector3d(wrench.head<3>()));
    const double row = caron(wrench, 0.1, 0.05, inner);
    const BalanceCertificate certificate = certify(robot, standing(robot, turned), {base}, four);
    EXPECT_EQ(certificate.margin > 0.0, row < 0.0) << row << " and " << certificate.margin;
    inside += row < 0.0;
  }
  EXPECT_GT(inside, 20);
}

TEST(BalanceCertificate, LetsAWallBearTheYawOfTheContactWrenchCone) {
  // Squeezed between two walls, half of the weight at each. Where the squeeze goes through both is
  // free; the contact wrench cone is asked on a grid of such places.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double mu = 0.7, inner = mu / std::sqrt(2.0);
  BalanceOptions four;
  four.facets = 4;
  int inside = 0, yaw = 0, decided = 0;
  for (int i = 0; i < 100; ++i) {
    const Robot robot = block({0.0, 0.4 * uniform(random), 0.4 * uniform(random)});
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(3.0 * uniform(random), Vector3d::UnitX()));
    const double squeeze = kWeight * (2.5 + 1.8 * uniform(random));
    std::vector<GivenContact> walls(2, contact_at("block", ContactKind::kSurface, mu));
    for (const int k : {0, 1}) {
      GivenContact& wall = walls[std::size_t(k)];
      wall.normal = Vector3d(k == 0 ? -1.0 : 1.0, 0.0, 0.0);
      wall.forward = Vector3d::UnitZ();
      wall.point = -0.2 * wall.normal;
      wall.max_force_N = squeeze;
    }
    const Vector3d half = 0.5 * (turned.inverse() * Vector3d(0.0, 0.0, kWeight));
    const double twist = robot.links()[0].com.cross(half).x();
    double row = 1e9, without_yaw = 1e9;
    for (int a = -40; a <= 40; ++a) {
      for (int b = -40; b <= 40; ++b) {
        VectorXd wrench(6);  // contact axes of the first wall: z, y, -x of the block
        wrench << half.z(), half.y(), squeeze, 0.05 * b / 40.0 * squeeze, 0.1 * a / 40.0 * squeeze,
            -twist;
        row = std::min(row, caron(wrench, 0.1, 0.05, inner));
        wrench.tail<3>() << 0.0, 0.0, 0.0;
        without_yaw = std::min(without_yaw, caron(wrench, 0.1, 0.05, inner));
      }
    }
    if (std::abs(row) < 0.005 * kWeight) continue;  // the grid is too coarse to say
    ++decided;
    const BalanceCertificate certificate = certify(robot, standing(robot, turned), walls, four);
    EXPECT_EQ(certificate.margin > 0.0, row < 0.0) << row << " and " << certificate.margin;
    inside += row < 0.0;
    yaw += row > 0.0 && without_yaw < 0.0;
  }
  EXPECT_GT(decided, 60);
  EXPECT_GT(inside, 10);
  EXPECT_GT(yaw, 5) << "cases that yaw decides";
}

/// COMAN+ at random, with contacts of all kinds.
struct RandomStance {
  VectorXd configuration;
  std::vector<GivenContact> contacts;
};

RandomStance random_stance(std::mt19937& random) {
  const Robot& robot = coman_plus();
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vector3d(x, y, z);
  };
  RandomStance stance;
  stance.configuration = robot.named_configuration("home");
  const Vector3d turn = 0.5 * vector();
  stance.configuration.segment<4>(3) =
      Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())).coeffs();
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    stance.configuration[7 + i] += 0.35 * uniform(random) * (joint.upper - joint.lower);
  }
  for (const char* link : {"l_sole", "r_sole", "TCP_L", "TCP_R"}) {
    GivenContact contact = contact_at(
        link, std::string(link).ends_with("sole") ? ContactKind::kSurface : ContactKind::kPoint,
        0.7);
    contact.half_x_m = 0.08;
    contact.half_y_m = 0.04;
    contact.max_force_N = 350.0;
    if (contact.kind == ContactKind::kPoint) {
      contact.axes_in_world = true;
      contact.normal = Vector3d::UnitZ() + 0.5 * vector();
      contact.point = 0.05 * vector();
    }
    stance.contacts.push_back(contact);
  }
  GivenContact& rung = stance.contacts[3];
  rung.kind = ContactKind::kGrasp;
  rung.axes_in_world = false;
  rung.max_force_N = 100.0;
  rung.max_moment_Nm = 5.0;
  return stance;
}

TEST(BalanceCertificate, GivesWrenchesThatSatisfyEveryConditionWithTheMarginItStates) {
  const Robot& robot = coman_plus();
  const double weight = robot.total_mass() * kGravity;
  std::mt19937 random(2);
  int balanced = 0;
  for (int i = 0; i < 60; ++i) {
    const RandomStance stance = random_stance(random);
    const BalanceCertificate certificate = certify(robot, stance.configuration, stance.contacts);
    ASSERT_EQ(certificate.wrenches.size(), 4u);
    if (!certificate.balanced) {
      EXPECT_LT(certificate.margin, 0.0) << certificate.limiting;
      continue;
    }
    ++balanced;
    RobotState state(robot);
    state.update(stance.configuration.data());
    Vector3d force(0.0, 0.0, -weight);
    Vector3d moment = state.center_of_mass().cross(force);
    VectorXd torques(robot.tangent_size());
    Eigen::Matrix<double, 3, Eigen::Dynamic> com(3, robot.tangent_size());
    state.center_of_mass_jacobian(com);
    torques = weight * com.row(2).transpose();
    for (std::size_t k = 0; k < 4; ++k) {
      const GivenContact& contact = stance.contacts[k];
      const VectorXd& w = certificate.wrenches[k];
      const int link = robot.link_index(contact.link);
      Eigen::Matrix3d axes;
      axes.col(2) = contact.normal.normalized();
      axes.col(0) = (contact.forward - contact.forward.dot(axes.col(2)) * axes.col(2)).normalized();
      axes.col(1) = axes.col(2).cross(Vector3d(axes.col(0)));
      if (!contact.axes_in_world) axes = state.world_from_link(link).linear() * axes;
      Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
      at.translation() = contact.point;
      Eigen::Matrix<double, 6, 1> world;
      world << axes * w.head<3>(), axes * w.tail<3>();
      force += world.head<3>();
      moment += world.tail<3>() +
                (state.world_from_link(link) * contact.point).cross(Vector3d(world.head<3>()));
      Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, robot.tangent_size());
      state.frame_jacobian(link, at, jacobian);
      torques -= jacobian.transpose() * world;

      const double reserve = certificate.margin * weight - 1e-6 * weight;
      const double used = (1.0 - certificate.margin) * (1.0 + 1e-6) + 1e-6;
      if (contact.kind == ContactKind::kGrasp) {
        EXPECT_LE(w.head<3>().cwiseAbs().maxCoeff(), used * contact.max_force_N);
        EXPECT_LE(w.tail<3>().cwiseAbs().maxCoeff(), used * contact.max_moment_Nm);
        EXPECT_EQ(w[4], 0.0);
        continue;
      }
      EXPECT_LE(w[2], used * contact.max_force_N);
      EXPECT_LE(w.head<2>().norm() + reserve, contact.friction * w[2]);
      if (contact.kind == ContactKind::kPoint) {
        EXPECT_EQ(w.tail<3>().norm(), 0.0);
        continue;
      }
      EXPECT_LE(std::abs(w[4]) + reserve * contact.half_x_m, contact.half_x_m * w[2]);
      EXPECT_LE(std::abs(w[3]) + reserve * contact.half_y_m, contact.half_y_m * w[2]);
      EXPECT_LE(caron(w, contact.half_x_m, contact.half_y_m, contact.friction), 1e-6 * weight)
          << "of the pyramid around the cone";
    }
    EXPECT_LT(force.norm(), 1e-5 * weight);
    EXPECT_LT(moment.norm(), 1e-5 * weight);
    for (int j = 0; j < robot.active_joint_count(); ++j) {
      EXPECT_LE(std::abs(torques[6 + j]),
                (1.0 - certificate.margin + 1e-6) * robot.active_joint(j).max_effort)
          << robot.active_joint(j).name;
    }
    EXPECT_NEAR((torques.tail(robot.active_joint_count()).cwiseAbs().array() /
                 VectorXd::NullaryExpr(
                     robot.active_joint_count(),
                     [&](Eigen::Index j) { return robot.active_joint(int(j)).max_effort; })
                     .array())
                    .maxCoeff(),
                certificate.max_torque_ratio, 1e-9);
  }
  EXPECT_GT(balanced, 5);
  EXPECT_LT(balanced, 55);
}

TEST(BalanceCertificate, GainsNothingByFewerSidesOrByMoreLimits) {
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    const RandomStance stance = random_stance(random);
    const auto margin = [&](int facets, bool enforce) {
      return certify(coman_plus(), stance.configuration, stance.contacts,
                     {.enforce_torque_limits = enforce, .facets = facets})
          .margin;
    };
    // Below zero the cones are shifted down, blunt ones by less.
    EXPECT_LE(std::max(0.0, margin(4, true)), std::max(0.0, margin(16, true)) + 1e-7);
    EXPECT_LE(margin(16, true), margin(16, false) + 1e-7);
  }
}

TEST(BalanceCertificate, IsTheSameFromEveryThread) {
  std::mt19937 random(4);
  const RandomStance stance = random_stance(random);
  const BalanceCertificate alone = certify(coman_plus(), stance.configuration, stance.contacts);
  std::vector<BalanceCertificate> all(4);
  std::vector<std::thread> threads;
  for (BalanceCertificate& one : all) {
    threads.emplace_back([&stance, &one] {
      for (int i = 0; i < 5; ++i) {
        one = certify(coman_plus(), stance.configuration, stance.contacts);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const BalanceCertificate& one : all) {
    EXPECT_EQ(one.margin, alone.margin);
    EXPECT_EQ(one.wrenches, alone.wrenches);
  }
}

TEST(BalanceCertificate, RefusesWhatMakesNoSenseByName) {
  const Robot robot = block({0.0, 0.0, 0.0});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto error = [&](auto&& change, ContactKind kind = ContactKind::kSurface) -> std::string {
    GivenContact contact = contact_at("block", kind, 0.5);
    VectorXd q = standing(robot);
    BalanceOptions options;
    change(contact, q, options);
    try {
      certify(robot, q, {contact}, options);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  using C = GivenContact&;
  using Q = VectorXd&;
  using O = BalanceOptions&;
  EXPECT_EQ(error([](C, Q, O) {}), "");
  EXPECT_NE(error([](C c, Q, O) { c.link = "blok"; }).find("blok"), std::string::npos);
  EXPECT_NE(error([](C c, Q, O) { c.normal.setZero(); }).find("normal of length"),
            std::string::npos);
  EXPECT_NE(error([&](C c, Q, O) { c.normal[1] = nan; }).find("normal of length"),
            std::string::npos);
  EXPECT_NE(error([](C c, Q, O) { c.forward = -2.0 * c.normal; }).find("along its normal"),
            std::string::npos);
  EXPECT_NE(error([](C c, Q, O) { c.forward.setZero(); }).find("forward direction that is zero"),
            std::string::npos);
  EXPECT_NE(error([&](C c, Q, O) { c.point[0] = nan; }).find("place"), std::string::npos);
  EXPECT_NE(error([](C c, Q, O) { c.friction = 0.0; }).find("friction"), std::string::npos);
  EXPECT_NE(error([](C c, Q, O) { c.half_x_m = -1.0; }).find("half size x"), std::string::npos);
  EXPECT_NE(error([&](C c, Q, O) { c.half_y_m = nan; }).find("half size y"), std::string::npos);
  EXPECT_NE(error([&](C c, Q, O) { c.max_force_N = INFINITY; }).find("force limit"),
            std::string::npos);
  EXPECT_NE(error([](C c, Q, O) { c.max_moment_Nm = -1.0; }, ContactKind::kGrasp).find("moment"),
            std::string::npos);
  EXPECT_NE(error([](C, Q q, O) { q = VectorXd::Zero(6); }).find("6 numbers"), std::string::npos);
  EXPECT_NE(error([&](C, Q q, O) { q[1] = nan; }).find("not finite"), std::string::npos);
  EXPECT_NE(error([](C, Q q, O) { q[6] = 2.0; }).find("quaternion"), std::string::npos);
  EXPECT_NE(error([](C, Q, O o) { o.facets = 2; }).find("2 sides"), std::string::npos);
  EXPECT_NE(error([](C, Q, O o) { o.facets = 65; }).find("65 sides"), std::string::npos);
  for (const double scale : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(error([&](C, Q, O o) { o.effort_scale = scale; }).find("efforts"), std::string::npos);
  }

  const Robot powerless = arm(0.0, true);
  const GivenContact foot = contact_at("foot", ContactKind::kSurface, 0.5);
  EXPECT_THROW(certify(powerless, standing(powerless), {foot}), Error);
  EXPECT_NO_THROW(
      certify(powerless, standing(powerless), {foot}, {.enforce_torque_limits = false}));
}

}  // namespace
}  // namespace locograph
