#include <numbers>

#include "plugins/plugin_test_support.h"

namespace locograph::test {
namespace {

constexpr double kRadius = 0.078;

/// CENTAURO's lower body on its wheels.
class Wheels : public testing::Test {
 protected:
  RobotCase robot = centauro_lower_body();
  EdgeRolling rolling = rolling_of(graph_of(robot));

  /// Height and tilt of every wheel, one after the other.
  Eigen::VectorXd contact(const Eigen::VectorXd& q) const {
    Eigen::VectorXd all(8);
    for (int w = 0; w < 4; ++w) {
      all.segment<2>(2 * w) = error_of(robot, wheel_contact(graph_of(robot), w), q);
    }
    return all;
  }

  struct Pose {
    Eigen::Vector3d centre, axle;
    Eigen::Matrix3d rotation;
  };
  /// Of a wheel, from the kinematics of the turning link alone: its frame sits on the axle.
  Pose wheel_at(const Eigen::VectorXd& q, int wheel) const {
    RobotState state(robot.model());
    state.update(q.data());
    const Wheel w = wheel_of(robot.model(), robot.wheels[static_cast<std::size_t>(wheel)].effector);
    const Eigen::Isometry3d& pose = state.world_from_link(w.link);
    return {pose.translation(), state.joint_axis(w.joint), pose.linear()};
  }
  int spin(int wheel) const { return at("j_wheel_", wheel); }
  int at(const std::string& joint, int wheel) const {
    return robot.at(joint + std::to_string(wheel + 1));
  }
  Eigen::Vector3d steering_axis(const Eigen::VectorXd& q, int wheel) const {
    RobotState state(robot.model());
    state.update(q.data());
    return state.joint_axis(at("ankle_yaw_", wheel) - robot.base());
  }
  /// +1 where a positive turn rolls forward.
  double sign(int wheel) const { return wheel_at(home(robot), wheel).axle.y() > 0.0 ? 1.0 : -1.0; }

  Eigen::VectorXd moved(Eigen::VectorXd q, const Eigen::Isometry3d& motion) const {
    q.head<3>() = motion * Eigen::Vector3d(q.head<3>());
    const Eigen::Quaterniond turned =
        Eigen::Quaterniond(motion.linear()) * Eigen::Quaterniond(q.segment<4>(3).data());
    q.segment<4>(3) = turned.normalized().coeffs();
    return q;
  }
  Eigen::VectorXd shifted(const Eigen::VectorXd& q, double x, double y, double z = 0.0) const {
    return moved(q, Eigen::Isometry3d(Eigen::Translation3d(x, y, z)));
  }
  double lateral(const Eigen::VectorXd& e, int wheel) const { return e[2 * wheel]; }
  double longitudinal(const Eigen::VectorXd& e, int wheel) const { return e[2 * wheel + 1]; }
};

TEST_F(Wheels, TouchTheGroundAtHomeWithThePelvisAtItsHeight) {
  // The height is known to a tenth of a millimetre.
  EXPECT_LE(contact(home(robot)).cwiseAbs().maxCoeff(), 1e-4);
}

TEST_F(Wheels, AreAsHighAboveTheGroundAsTheRobotIsLifted) {
  const Eigen::VectorXd at_home = contact(home(robot));
  for (const double height : {-0.1, 0.003, 0.05, 0.4}) {
    const Eigen::VectorXd e = contact(shifted(home(robot), 0.3, -0.2, height));
    for (int w = 0; w < 4; ++w) {
      EXPECT_NEAR(e[2 * w], at_home[2 * w] + height, 1e-12);
      EXPECT_NEAR(e[2 * w + 1], at_home[2 * w + 1], 1e-12);
    }
  }
}

TEST_F(Wheels, ContactIsTheLowestPointOfADiscAndTheSineOfItsTilt) {
  Random random(21);
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    const Eigen::VectorXd e = contact(q);
    for (int w = 0; w < 4; ++w) {
      const Pose pose = wheel_at(q, w);
      double lowest = 1e9;
      const Eigen::Vector3d u = pose.axle.unitOrthogonal(), v = pose.axle.cross(u);
      for (int a = 0; a < 20000; ++a) {
        const double angle = 2.0 * std::numbers::pi * a / 20000;
        const Eigen::Vector3d rim =
            pose.centre + kRadius * (std::cos(angle) * u + std::sin(angle) * v);
        lowest = std::min(lowest, rim.z());
      }
      EXPECT_NEAR(e[2 * w], lowest, 1e-8);
      EXPECT_NEAR(e[2 * w + 1], pose.axle.z(), 1e-12);
    }
  }
}

TEST_F(Wheels, ContactDoesNotCareHowFarAWheelHasTurned) {
  Eigen::VectorXd q = home(robot);
  const Eigen::VectorXd before = contact(q);
  for (int w = 0; w < 4; ++w) q[spin(w)] += 1.3 * (w + 1);
  EXPECT_TRUE(contact(q).isApprox(before, 1e-12));
}

TEST_F(Wheels, HaveTheirAxlesAcrossTheRobotAtHome) {
  for (int w = 0; w < 4; ++w) {
    EXPECT_NEAR(std::abs(wheel_at(home(robot), w).axle.y()), 1.0, 1e-4) << "wheel " << w + 1;
  }
}

TEST_F(Wheels, RollStraightWhenEachTurnsByDistanceOverRadius) {
  for (const double distance : {-0.5, 0.01, 0.2, 3.0}) {
    Eigen::VectorXd to = shifted(home(robot), distance, 0.0);
    for (int w = 0; w < 4; ++w) to[spin(w)] += sign(w) * distance / kRadius;
    const Eigen::VectorXd e = error_between(robot, rolling, home(robot), to);
    // Home steers the wheels straight to 1e-6 rad.
    EXPECT_LE(e.cwiseAbs().maxCoeff(), 1e-5 * std::abs(distance));
  }
}

TEST_F(Wheels, SlipSidewaysByTheSidewaysDisplacement) {
  for (const double distance : {-0.2, 0.05}) {
    const Eigen::VectorXd e =
        error_between(robot, rolling, home(robot), shifted(home(robot), 0.0, distance));
    for (int w = 0; w < 4; ++w) {
      EXPECT_NEAR(lateral(e, w), sign(w) * distance, 1e-8);
      EXPECT_NEAR(longitudinal(e, w), 0.0, 1e-5 * std::abs(distance));
    }
  }
}

TEST_F(Wheels, SlideForwardByTheRollThatIsMissing) {
  constexpr double kDistance = 0.3;
  for (const double missing : {-0.1, 0.02, 0.3}) {
    for (int slipping = 0; slipping < 4; ++slipping) {
      Eigen::VectorXd to = shifted(home(robot), kDistance, 0.0);
      for (int w = 0; w < 4; ++w) {
        to[spin(w)] += sign(w) * (kDistance - (w == slipping ? missing : 0.0)) / kRadius;
      }
      const Eigen::VectorXd e = error_between(robot, rolling, home(robot), to);
      for (int w = 0; w < 4; ++w) {
        EXPECT_NEAR(longitudinal(e, w), w == slipping ? sign(w) * missing : 0.0, 1e-5);
        EXPECT_NEAR(lateral(e, w), 0.0, 1e-5);
      }
    }
  }
}

TEST_F(Wheels, DoNotRollWhenTheBaseOnlyRisesOrTheWholePathIsTurned) {
  const Eigen::VectorXd up = shifted(home(robot), 0.0, 0.0, 0.1);
  EXPECT_LE(error_between(robot, rolling, home(robot), up).cwiseAbs().maxCoeff(), 1e-12);

  Random random(22);
  const Eigen::VectorXd from = random.configuration(robot.model(), 1.0, 0.0);
  Eigen::VectorXd to(from.size());
  const Eigen::VectorXd step = random.vector(robot.model().tangent_size(), 0.2);
  robot.model().integrate(from.data(), step.data(), to.data());
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(Eigen::Vector3d(3.0, -2.0, 0.7));
  motion.rotate(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()));
  const Eigen::VectorXd here = error_between(robot, rolling, from, to);
  const Eigen::VectorXd there =
      error_between(robot, rolling, moved(from, motion), moved(to, motion));
  EXPECT_LE((here - there).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(Wheels, RollAlongAnArcWhenTheySteerAroundItsCentre) {
  for (const double radius : {1.5, -1.5, 4.0}) {
    const Eigen::Vector3d centre(0.1, radius, 0.0);
    // Steer until every axle points to the centre of rotation.
    Eigen::VectorXd from = home(robot);
    for (int w = 0; w < 4; ++w) {
      for (int i = 0; i < 20; ++i) {
        const Pose pose = wheel_at(from, w);
        const Eigen::Vector3d arm = centre - pose.centre;
        double turn = std::atan2(arm.y(), arm.x()) - std::atan2(pose.axle.y(), pose.axle.x());
        turn = std::remainder(turn, std::numbers::pi);
        const Eigen::Vector3d steering = steering_axis(from, w);
        ASSERT_NEAR(std::abs(steering.z()), 1.0, 1e-4);
        from[at("ankle_yaw_", w)] += steering.z() * turn;
      }
    }
    for (const double angle : {-0.2, -0.02, 0.02, 0.2}) {
      Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
      motion.translate(centre);
      motion.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
      motion.translate(-centre);
      Eigen::VectorXd to = moved(from, motion);
      Eigen::VectorXd short_by(4);
      for (int w = 0; w < 4; ++w) {
        const Pose pose = wheel_at(from, w);
        const Eigen::Vector3d arm = pose.centre - centre;
        const Eigen::Vector3d velocity = Eigen::Vector3d::UnitZ().cross(arm);
        const double path = angle * std::hypot(arm.x(), arm.y()) *
                            (velocity.dot(pose.axle.cross(Eigen::Vector3d::UnitZ())) > 0 ? 1 : -1);
        to[spin(w)] += path / kRadius;
        // The chord is sin(Δθ/2) / (Δθ/2) of the arc: Δθ²/24 of the path is missing.
        short_by[w] = path * (1.0 - std::sin(0.5 * angle) / (0.5 * angle));
      }
      const Eigen::VectorXd e = error_between(robot, rolling, from, to);
      for (int w = 0; w < 4; ++w) {
        EXPECT_NEAR(lateral(e, w), 0.0, 1e-5 * std::abs(angle * radius));
        EXPECT_NEAR(longitudinal(e, w), -short_by[w], 1e-5 * std::abs(angle * radius));
        EXPECT_LE(
            std::abs(longitudinal(e, w)),
            angle * angle / 24.0 * (1.01 * std::abs(angle) * (std::abs(radius) + 0.6)) + 1e-5);
      }
    }
  }
}

TEST_F(Wheels, SteerEvenlyOnAStraightPathWithAPartOfTheAngleSquaredTooMuch) {
  constexpr double kDistance = 0.3;
  for (const double steer : {0.05, 0.2}) {
    Eigen::VectorXd from = home(robot), to = shifted(home(robot), kDistance, 0.0);
    for (int w = 0; w < 4; ++w) {
      from[at("ankle_yaw_", w)] -= 0.5 * steer;
      to[at("ankle_yaw_", w)] += 0.5 * steer;
      // ∫ cos of the steering angle along the path
      const double path = kDistance * std::sin(0.5 * steer) / (0.5 * steer);
      to[spin(w)] += sign(w) * path / kRadius;
    }
    const Eigen::VectorXd e = error_between(robot, rolling, from, to);
    for (int w = 0; w < 4; ++w) {
      EXPECT_NEAR(lateral(e, w), 0.0, 1e-5);
      EXPECT_NEAR(longitudinal(e, w), sign(w) * kDistance * steer * steer / 24.0,
                  0.05 * kDistance * steer * steer / 24.0 + 1e-5);
    }
  }
}

TEST_F(Wheels, StandStillWhenTheBasePitchesAndTheirJointsTurnBack) {
  for (const double pitch : {-0.4, 0.1, 0.8}) {
    const Eigen::Isometry3d motion(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()));
    for (int w = 0; w < 4; ++w) {
      Eigen::VectorXd to = moved(home(robot), motion);
      const Eigen::Vector3d back = wheel_at(home(robot), w).centre - wheel_at(to, w).centre;
      to = shifted(to, back.x(), back.y(), back.z());
      const Eigen::VectorXd turned = error_between(robot, rolling, home(robot), to);
      EXPECT_NEAR(longitudinal(turned, w), -sign(w) * kRadius * pitch, 1e-5);
      to[spin(w)] -= sign(w) * pitch;
      EXPECT_TRUE(wheel_at(to, w).rotation.isApprox(wheel_at(home(robot), w).rotation, 1e-5));
      const Eigen::VectorXd e = error_between(robot, rolling, home(robot), to);
      EXPECT_NEAR(lateral(e, w), 0.0, 1e-6);
      EXPECT_NEAR(longitudinal(e, w), 0.0, 1e-6);
    }
  }
}

TEST_F(Wheels, StandStillWhenALegPitchesAndTheirJointsTurnBack) {
  for (int w = 0; w < 4; ++w) {
    // With the leg straight ahead its pitch joints turn about the wheel's axle.
    Eigen::VectorXd from = home(robot);
    from[at("hip_yaw_", w)] = from[at("ankle_yaw_", w)] = 0.0;
    for (const std::string joint : {"hip_pitch_", "knee_pitch_", "ankle_pitch_"}) {
      for (const double angle : {-0.3, 0.2}) {
        Eigen::VectorXd to = from;
        to[at(joint, w)] += angle;
        const Eigen::Vector3d before = wheel_at(from, w).axle;
        ASSERT_TRUE(wheel_at(to, w).axle.isApprox(before, 1e-5));
        const Eigen::Vector3d back = wheel_at(from, w).centre - wheel_at(to, w).centre;
        to = shifted(to, back.x(), back.y(), back.z());
        const Eigen::AngleAxisd turned(wheel_at(to, w).rotation *
                                       wheel_at(from, w).rotation.transpose());
        const double about_axle = turned.angle() * turned.axis().dot(before);
        EXPECT_NEAR(std::abs(about_axle), std::abs(angle), 1e-6);
        EXPECT_NEAR(longitudinal(error_between(robot, rolling, from, to), w), -kRadius * about_axle,
                    1e-6);
        to[spin(w)] -= about_axle;
        const Eigen::VectorXd e = error_between(robot, rolling, from, to);
        EXPECT_NEAR(lateral(e, w), 0.0, 1e-6);
        EXPECT_NEAR(longitudinal(e, w), 0.0, 1e-6);
      }
    }
  }
}

TEST_F(Wheels, RollOnOverManyTurnsOfTheJointAndOverAWholePitch) {
  // A joint angle counts every turn; a carrier's pitch is known up to turns: the nearest is meant.
  Eigen::VectorXd from = home(robot), to = from;
  for (int w = 0; w < 4; ++w) to[spin(w)] += 40.0;
  for (int w = 0; w < 4; ++w) {
    EXPECT_NEAR(longitudinal(error_between(robot, rolling, from, to), w), -40.0 * kRadius, 1e-9);
  }
  const auto pitched = [&](double pitch) {
    return moved(home(robot),
                 Eigen::Isometry3d(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY())));
  };
  for (double pitch = -3.2; pitch < 3.2; pitch += 0.1) {
    const Eigen::VectorXd a = pitched(pitch), b = pitched(pitch + 0.1);
    const Eigen::VectorXd e = error_between(robot, rolling, a, b);
    for (int w = 0; w < 4; ++w) {
      const double travelled = wheel_at(b, w).centre.x() - wheel_at(a, w).centre.x();
      EXPECT_NEAR(longitudinal(e, w), sign(w) * (travelled - kRadius * 0.1), 1e-5);
    }
  }
}

/// CENTAURO and the plane under it turned and moved as one: wheels know no vertical.
TEST_F(Wheels, StandAndRollOnAnyPlaneAsOnTheGround) {
  Random random(23);
  const Eigen::VectorXd from = random.configuration(robot.model(), 1.0, 0.0);
  Eigen::VectorXd to(from.size());
  const Eigen::VectorXd step = random.vector(robot.model().tangent_size(), 0.2);
  robot.model().integrate(from.data(), step.data(), to.data());
  const Eigen::VectorXd rolled = error_between(robot, rolling, from, to);
  const Eigen::VectorXd stood = contact(from);

  Eigen::Isometry3d motion(Eigen::Translation3d(3.0, -2.0, 0.7));
  motion.rotate(Eigen::AngleAxisd(1.2, Eigen::Vector3d(0.6, 0.0, 0.8)));
  for (Contact& wheel : robot.wheels) {
    wheel.position = motion * Eigen::Vector3d(2.0, -1.0, 0.0);
    wheel.normal = 0.3 * (motion.linear() * Eigen::Vector3d::UnitZ());
  }
  const Eigen::VectorXd a = moved(from, motion), b = moved(to, motion);
  EXPECT_LE((error_between(robot, rolling, a, b) - rolled).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE((contact(a) - stood).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(Wheels, ThatAreLockedNeitherMoveNorTurn) {
  robot.wheels[1].locked = true;
  const EdgeRolling held = rolling_of(graph_of(robot));
  Eigen::VectorXd to = shifted(home(robot), 0.2, 0.03);
  for (int w = 0; w < 4; ++w) to[spin(w)] += sign(w) * 0.2 / kRadius;
  const Eigen::VectorXd e = error_between(robot, held, home(robot), to);
  ASSERT_EQ(e.size(), 9);
  EXPECT_NEAR(e[1], 0.0, 1e-5) << "the first rolls";
  EXPECT_NEAR(e[2], sign(1) * 0.03, 1e-5);
  EXPECT_NEAR(e[3], sign(1) * 0.2, 1e-5);
  EXPECT_NEAR(e[4], sign(1) * 0.2, 1e-5) << "the way its rim has turned";
  EXPECT_NEAR(e[6], 0.0, 1e-5) << "the third rolls";
  EXPECT_EQ(held.weights.size(), 9);
}

TEST_F(Wheels, ThatAreLockedTurnBackWhatTheirCarriersPitch) {
  robot.wheels[1].locked = true;
  const EdgeRolling held = rolling_of(graph_of(robot));
  Eigen::VectorXd from = home(robot);
  // With the leg straight ahead its pitch joints turn about the wheel's axle.
  from[at("hip_yaw_", 1)] = from[at("ankle_yaw_", 1)] = 0.0;
  Eigen::VectorXd to = from;
  to[at("knee_pitch_", 1)] += 0.2;
  const Eigen::Vector3d back = wheel_at(from, 1).centre - wheel_at(to, 1).centre;
  to = shifted(to, back.x(), back.y(), back.z());
  const Eigen::AngleAxisd turned(wheel_at(to, 1).rotation * wheel_at(from, 1).rotation.transpose());
  const double about_axle = turned.angle() * turned.axis().dot(wheel_at(from, 1).axle);
  EXPECT_NEAR(std::abs(about_axle), 0.2, 1e-6);
  const Eigen::VectorXd turns = error_between(robot, held, from, to);
  EXPECT_NEAR(turns[3], 0.0, 1e-6);
  EXPECT_NEAR(turns[4], kRadius * about_axle, 1e-6);
  to[spin(1)] -= about_axle;
  EXPECT_NEAR(error_between(robot, held, from, to)[4], 0.0, 1e-6);
}

/// A way straight on, all wheels steered evenly: what slips sideways adds up until half-way and is
/// taken back behind.
TEST_F(Wheels, ThatSteerWhileTheyRollSlipHalfWay) {
  const double way = 0.2, steered = 0.3;
  const auto at_fraction = [&](double t) {
    Eigen::VectorXd q = shifted(home(robot), way * t, 0.0);
    for (int w = 0; w < 4; ++w) q[at("ankle_yaw_", w)] += steered * (t - 0.5);
    return q;
  };
  const auto slip = [&](int from, int to) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int k = from; k < to; ++k) {
      const Eigen::VectorXd e =
          error_between(robot, rolling, at_fraction(0.01 * k), at_fraction(0.01 * (k + 1)));
      for (int w = 0; w < 4; ++w) sum[w] += lateral(e, w);
    }
    return sum;
  };
  const Eigen::Vector4d half = slip(0, 50), whole = slip(0, 100);
  const EdgeSteeringSlip edge = steering_slip_of(graph_of(robot), 0.002);
  const Eigen::VectorXd e = error_between(robot, edge, at_fraction(0.0), at_fraction(1.0));
  ASSERT_EQ(e.size(), 4);
  for (int w = 0; w < 4; ++w) {
    EXPECT_NEAR(whole[w], 0.0, 1e-6);
    EXPECT_GT(std::abs(half[w]), 0.007);
    EXPECT_NEAR(e[w] + 0.002, std::abs(half[w]), 1e-4);
  }
  EXPECT_EQ(error_between(robot, edge, at_fraction(0.4), at_fraction(0.6)).norm(), 0.0);
}

TEST_F(Wheels, AreNotSteeredHalfRoundUnnoticed) {
  for (const double steer : {0.5, 2.0, 3.1}) {
    Eigen::VectorXd to = home(robot);
    for (int w = 0; w < 4; ++w) to[at("ankle_yaw_", w)] += steer;
    const Eigen::VectorXd e = error_between(robot, rolling, home(robot), to);
    for (int w = 0; w < 4; ++w) {
      // A wheel's centre lies on its steering axis up to a millimetre.
      const double beyond = std::max(0.0, steer - 0.5 * std::numbers::pi);
      EXPECT_NEAR(std::abs(lateral(e, w)), kRadius * beyond, 5e-3);
    }
  }
}

}  // namespace
}  // namespace locograph::test
