#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/types/bundle/camera_bal.h>
#include <locograph/types/bundle/camera_view.h>
#include <locograph/types/bundle/inverse_depth.h>
#include <locograph/types/bundle/pinhole.h>
#include <locograph/types/standard_types.h>

#include "types/expect_error.h"

namespace locograph::test {
namespace {

constexpr double kTolerance_px = 1e-9;

// A quarter turn about z takes (2, 1, −5) to (−1, 2, −5); t moves it to (−1, 2, −4). Then
// p = (−0.25, 0.5), r² = 0.3125, and the distortion is 1 + 0.1·0.3125 + 0.01·0.3125².
TEST(BalCamera, SeesAPointWhereTheFormulaSays) {
  const double distortion = 1.0 + 0.1 * 0.3125 + 0.01 * 0.3125 * 0.3125;
  expect_error(
      "VERTEX_CAMERA_BAL 0 0 0 1.5707963267948966 0 0 1 500 0.1 0.01\n"
      "VERTEX_TRACKXYZ 1 2 1 -5\n"
      "EDGE_PROJECT_BAL 0 1 10 20 1 0 1\n",
      {-0.25 * 500.0 * distortion - 10.0, 0.5 * 500.0 * distortion - 20.0}, kTolerance_px);
}

TEST(BalCamera, TurnsByItsRotationVectorAlsoWhenItIsTiny) {
  for (const double angle : {0.0, 1e-12, 1e-6, 1e-5, 3e-4, 1e-2, 1.0, 3.14, 4.0}) {
    VertexCameraBAL::State state;
    state << Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0 * angle, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0;
    const VertexCameraBAL camera(state);
    VertexCameraBAL::Derived derived = camera.make_derived();
    camera.derive(camera.state.data(), derived);
    const Eigen::Matrix3d expected =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0).toRotationMatrix();
    EXPECT_LE((derived.rotation - expected).norm(), 1e-14) << angle;
    // The left Jacobian is the mean of the rotations on the way: ∫₀¹ exp(s ω) ds, by Simpson.
    constexpr int kSteps = 400;
    Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
    for (int i = 0; i <= kSteps; ++i) {
      const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      mean += weight / (3.0 * kSteps) *
              Eigen::AngleAxisd(angle * i / kSteps, Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0)
                  .toRotationMatrix();
    }
    EXPECT_LE((derived.left - mean).norm(), 1e-10) << angle;
  }
}

// The camera sits 1 m up the z axis of a pose at x = 1 that is turned by 90° about y: its own z
// looks along world x. World (5, 2, 3) is (−3, 2, 4) in the pose, (−3, 2, 3) in the camera.
const char* kTurnedPose = "0.70710678118654757 0 0.70710678118654757";

TEST(PinholeCamera, SeesAPointThroughItsOffset) {
  expect_error(
      "PARAMS_CAMERACALIB 3 0 0 1 0 0 0 1 600 300 320 240\n"
      "VERTEX_SE3:QUAT 0 1 0 0 0 " +
          std::string(kTurnedPose) +
          "\n"
          "VERTEX_TRACKXYZ 1 5 2 3\n"
          "EDGE_PROJECT_PINHOLE 0 1 3 -270 400 1 0 1\n",
      {-280.0 + 270.0, 440.0 - 400.0}, kTolerance_px);
}

TEST(StereoCamera, SeesAPointInBothImages) {
  expect_error(
      "PARAMS_STEREOCALIB 3 0 0 1 0 0 0 1 600 300 320 240 0.5\n"
      "VERTEX_SE3:QUAT 0 1 0 0 0 " +
          std::string(kTurnedPose) +
          "\n"
          "VERTEX_TRACKXYZ 1 5 2 3\n"
          "EDGE_PROJECT_STEREO 0 1 3 -270 400 -370 1 0 0 1 0 1\n",
      {-280.0 + 270.0, 440.0 - 400.0, -380.0 + 370.0}, kTolerance_px);
}

TEST(CameraWithItsOwnCalibration, SeesAPointInOneImageAndInTwo) {
  const std::string vertices = "VERTEX_CAM 0 1 0 0 0 " + std::string(kTurnedPose) +
                               " 600 300 320 240 0.5\n"
                               "VERTEX_XYZ 1 5 2 3\n";  // (−3, 2, 4) in the camera
  expect_error(vertices + "EDGE_PROJECT_P2MC 1 0 -100 400 1 0 1\n", {-130.0 + 100.0, 390.0 - 400.0},
               kTolerance_px);
  expect_error(vertices + "EDGE_PROJECT_P2SC 1 0 -100 400 -200 1 0 0 1 0 1\n",
               {-130.0 + 100.0, 390.0 - 400.0, -205.0 + 200.0}, kTolerance_px);
}

TEST(CameraWithItsOwnCalibration, KeepsItsCalibration) {
  VertexCam camera({SE3<double>(), 600.0, 500.0, 320.0, 240.0, 0.1});
  const Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Constant(0.1);
  VertexCam::State moved;
  VertexCam::oplus(camera.state.data(), step.data(), moved.data());
  EXPECT_EQ(moved.tail<5>(), camera.state.tail<5>());
  EXPECT_GT((moved - camera.state).norm(), 0.1);
}

// In the anchor (0.5, −0.25, 1) / 0.25 = (2, −1, 4); the observer stands 2 m ahead of it.
TEST(InverseDepthPoint, IsSeenFromAnotherPose) {
  const std::string poses =
      "PARAMS_CAMERACALIB 0 0 0 0 0 0 0 1 100 200 320 240\n"
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
      "VERTEX_SE3:QUAT 1 0 0 2 0 0 0 1\n";
  expect_error(poses +
                   "VERTEX_INVERSE_DEPTH 2 0.5 -0.25 0.25\n"
                   "EDGE_PROJECT_INVERSE_DEPTH 0 1 2 0 400 100 1 0 1\n",
               {420.0 - 400.0, 140.0 - 100.0}, kTolerance_px);
  // Infinitely far: the observer sees it in the same direction.
  expect_error(poses +
                   "VERTEX_INVERSE_DEPTH 2 0.5 -0.25 0\n"
                   "EDGE_PROJECT_INVERSE_DEPTH 0 1 2 0 370 190 1 0 1\n",
               {0.0, 0.0}, kTolerance_px);
}

TEST(CameraCalibration, WithoutFocalLengthOrBaselineIsRefused) {
  for (const std::string line : {"PARAMS_STEREOCALIB 0 0 0 0 0 0 0 1 0 300 320 240 0.5",
                                 "PARAMS_STEREOCALIB 0 0 0 0 0 0 0 1 600 300 320 240 0",
                                 "VERTEX_CAM 0 0 0 0 0 0 0 1 600 0 320 240 0.5",
                                 "VERTEX_CAM 0 0 0 0 0 0 0 0 600 300 320 240 0.5"}) {
    try {
      read_graph_text("\n" + line + "\n", "case.g2o", {}, standard_types());
      ADD_FAILURE() << "accepted: " << line;
    } catch (const Error& error) {
      EXPECT_EQ(error.line(), 2) << error.what();
    }
  }
}

}  // namespace
}  // namespace locograph::test
