#include <gtest/gtest.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>

#include <Eigen/Dense>
#include <random>

namespace locograph {
namespace {

class Motions {
 public:
  SE2<double> planar() {
    return {3.0 * uniform_(engine_), uniform_(engine_), 3.1 * uniform_(engine_)};
  }
  SE3<double> spatial() {
    const Eigen::Quaterniond q(normal_(engine_), normal_(engine_), normal_(engine_),
                               normal_(engine_));
    return {vector(3.0), q.normalized()};
  }
  Eigen::Vector3d vector(double scale) {
    return scale * Eigen::Vector3d(uniform_(engine_), uniform_(engine_), uniform_(engine_));
  }

 private:
  std::mt19937 engine_{11};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
  std::normal_distribution<double> normal_;
};

Eigen::Matrix4d matrix(const SE3<double>& pose) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = pose.rotation().toRotationMatrix();
  m.topRightCorner<3, 1>() = pose.translation();
  return m;
}
Eigen::Matrix3d matrix(const SE2<double>& pose) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(pose.angle()).toRotationMatrix();
  m.topRightCorner<2, 1>() = pose.translation();
  return m;
}

TEST(SE2, ComposesAndInvertsLikeItsMatrices) {
  Motions motions;
  for (int i = 0; i < 100; ++i) {
    const SE2<double> a = motions.planar(), b = motions.planar();
    EXPECT_LE((matrix(a * b) - matrix(a) * matrix(b)).norm(), 1e-14);
    EXPECT_LE((matrix(a.inverse()) - matrix(a).inverse()).norm(), 1e-14);
    const Eigen::Vector2d p(0.3, -2.0);
    EXPECT_LE((a * p - (matrix(a) * p.homogeneous()).head<2>()).norm(), 1e-14);
  }
}

TEST(SE3, ComposesAndInvertsLikeItsMatrices) {
  Motions motions;
  for (int i = 0; i < 100; ++i) {
    const SE3<double> a = motions.spatial(), b = motions.spatial();
    EXPECT_LE((matrix(a * b) - matrix(a) * matrix(b)).norm(), 1e-14);
    EXPECT_LE((matrix(a.inverse()) - matrix(a).inverse()).norm(), 1e-13);
    const Eigen::Vector3d p(0.3, -2.0, 1.0);
    EXPECT_LE((a * p - (matrix(a) * p.homogeneous()).head<3>()).norm(), 1e-14);
  }
}

TEST(WrapAngle, TakesAWholeNumberOfTurnsOff) {
  for (double angle = -20.0; angle < 20.0; angle += 0.01) {
    const double wrapped = wrap_angle(angle);
    EXPECT_GE(wrapped, -std::numbers::pi - 1e-14);
    EXPECT_LE(wrapped, std::numbers::pi + 1e-14);
    EXPECT_NEAR(std::remainder(wrapped - angle, 2.0 * std::numbers::pi), 0.0, 1e-13);
  }
  EXPECT_EQ(wrap_angle(0.5), 0.5);
}

TEST(QuaternionExp, IsTheRotationByTheLengthOfTheVector) {
  Motions motions;
  for (const double scale : {0.0, 1e-9, 9e-7, 1.1e-6, 1e-3, 1.0, 3.0}) {
    const Eigen::Vector3d v = motions.vector(scale);
    const Eigen::Quaterniond expected(scale == 0.0 ? Eigen::AngleAxisd::Identity()
                                                   : Eigen::AngleAxisd(v.norm(), v.normalized()));
    EXPECT_LE((quaternion_exp<double>(v).coeffs() - expected.coeffs()).norm(), 1e-15) << scale;
  }
}

TEST(VertexSE3, StepsInItsOwnFrameAndKeepsAUnitQuaternion) {
  Motions motions;
  VertexSE3 vertex(motions.spatial());
  for (int i = 0; i < 10000; ++i) {
    const SE3<double> before = vertex.pose();
    Eigen::Matrix<double, 6, 1> d;
    d << motions.vector(0.5), motions.vector(0.5);
    VertexSE3 moved;
    VertexSE3::oplus(vertex.state.data(), d.data(), moved.state.data());
    const SE3<double> step(d.head<3>(), quaternion_exp<double>(d.tail<3>()));
    ASSERT_LE((matrix(moved.pose()) - matrix(before * step)).norm(),
              1e-14 * (1.0 + matrix(before).norm()));
    vertex = moved;
  }
  EXPECT_NEAR(vertex.pose().rotation().norm(), 1.0, 1e-15);
}

TEST(EdgeSE3, ErrorIsZeroAtTheMeasurementWhateverTheSignOfTheQuaternions) {
  Motions motions;
  for (int i = 0; i < 100; ++i) {
    const SE3<double> a = motions.spatial(), z = motions.spatial(), b = a * z;
    for (const double sign_a : {1.0, -1.0}) {
      for (const double sign_b : {1.0, -1.0}) {
        EdgeSE3 edge;
        edge.measurement = z;
        const SE3<double> a2(a.translation(), Eigen::Quaterniond(sign_a * a.rotation().coeffs()));
        const SE3<double> b2(b.translation(), Eigen::Quaterniond(sign_b * b.rotation().coeffs()));
        Eigen::Matrix<double, 6, 1> e;
        edge.error<double>(a2, b2, e);
        EXPECT_LE(e.norm(), 1e-14);
        EXPECT_LE((edge.predict_second(a).translation() - b.translation()).norm(), 1e-14);
        EXPECT_LE((edge.predict_first(b).translation() - a.translation()).norm(), 1e-13);
      }
    }
  }
}

TEST(EdgeSE3, ErrorIsTranslationAndVectorPartOfTheQuaternion) {
  EdgeSE3 edge;
  const SE3<double> b({1.0, 2.0, 3.0},
                      Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX())));
  Eigen::Matrix<double, 6, 1> e, expected;
  edge.error<double>(SE3<double>(), b, e);
  expected << 1.0, 2.0, 3.0, std::sin(0.2), 0.0, 0.0;
  EXPECT_LE((e - expected).norm(), 1e-15);
}

TEST(EdgeSE2, ErrorIsZeroAtTheMeasurementAlsoWhereHeadingsWrap) {
  Motions motions;
  for (int i = 0; i < 200; ++i) {
    const SE2<double> a = motions.planar(), z = motions.planar(), b = a * z;
    EdgeSE2 edge;
    edge.measurement = z;
    for (const double turns : {0.0, 2.0 * std::numbers::pi, -4.0 * std::numbers::pi}) {
      Eigen::Vector3d e;
      edge.error<double>(a, SE2<double>(b.translation(), b.angle() + turns), e);
      EXPECT_LE(e.norm(), 1e-14);
    }
  }
}

}  // namespace
}  // namespace locograph
