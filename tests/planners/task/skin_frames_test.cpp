// Soles whose frames lie in their shapes, or outside of them.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/planners/task/skin_frames.h>
#include <locograph/world/effector_skin.h>

#include <string>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

/// A foot of 4 cm on an ankle, and a sole's frame fixed to it, `inside_m` above its lower side.
Robot footed(double inside_m) {
  const test::TemporaryFolder folder;
  return Robot::load(folder.write(
      "r.urdf",
      "<robot name='r'><link name='trunk'/><link name='foot'><collision><origin xyz='0.1 0 -0.02' "
      "rpy='0 0 0'/><geometry><box size='0.2 0.1 0.04'/></geometry></collision></link><link "
      "name='sole'/><joint name='ankle' type='revolute'><parent link='trunk'/><child link='foot'/>"
      "<axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='9' velocity='1'/></joint><joint "
      "name='fixed' type='fixed'><parent link='foot'/><child link='sole'/><origin xyz='0.1 0 " +
          std::to_string(-0.04 + inside_m) + "' rpy='0 0 0.3'/></joint></robot>"));
}

EndEffector sole() {
  EndEffector effector;
  effector.name = "left_foot";
  effector.link = "sole";
  effector.kind = ContactKind::kSurface;
  effector.half_x_m = 0.08;
  effector.half_y_m = 0.04;
  effector.friction = 0.7;
  effector.max_force_N = 100.0;
  return effector;
}

TEST(SkinFrames, AFrameInsideIsMovedOntoTheSkinAndTold) {
  const Robot robot = footed(4e-4);
  EXPECT_NEAR(beyond_frame_m(robot, sole()).value(), 4e-4, 1e-9);
  std::vector<EndEffector> effectors = {sole()};
  const std::vector<SkinFrame> off = snap_to_skin(robot, effectors);
  ASSERT_EQ(off.size(), 1u);
  EXPECT_TRUE(off[0].snapped);
  EXPECT_EQ(skin_text(off[0]),
            "left_foot: shapes fixed to sole reach 0.4 mm beyond its frame; it touches with these");
  EXPECT_NEAR(effectors[0].point.z(), -4e-4, 1e-9);
  EXPECT_NEAR(beyond_frame_m(robot, effectors[0]).value(), 0.0, 1e-12);
  EXPECT_TRUE(snap_to_skin(robot, effectors).empty()) << "it is there now";
}

TEST(SkinFrames, MoreThanTwoMillimetresAreToldAndLeft) {
  std::vector<EndEffector> effectors = {sole()};
  const std::vector<SkinFrame> off = snap_to_skin(footed(3e-3), effectors);
  ASSERT_EQ(off.size(), 1u);
  EXPECT_FALSE(off[0].snapped);
  EXPECT_NE(skin_text(off[0]).find("3 mm beyond its frame, more than"), std::string::npos);
  EXPECT_EQ(effectors[0].point, Eigen::Vector3d::Zero());
}

TEST(SkinFrames, AFrameOutsideIsToldAndLeft) {
  std::vector<EndEffector> effectors = {sole()};
  const std::vector<SkinFrame> off = snap_to_skin(footed(-5e-4), effectors);
  ASSERT_EQ(off.size(), 1u);
  EXPECT_FALSE(off[0].snapped);
  EXPECT_FALSE(off[0].matters());
  EXPECT_NE(skin_text(off[0]).find("its frame lies 0.5 mm outside"), std::string::npos);
  EXPECT_EQ(effectors[0].point, Eigen::Vector3d::Zero());
  EXPECT_NEAR(beyond_frame_m(footed(-5e-4), sole()).value(), -5e-4, 1e-9);
}

TEST(SkinFrames, AlongANormalThatIsTurned) {
  EndEffector front = sole();
  front.link = "foot";
  front.point = {0.199, 0.0, -0.02};
  front.normal = -Eigen::Vector3d::UnitX();
  front.forward = Eigen::Vector3d::UnitZ();
  std::vector<EndEffector> effectors = {front};
  ASSERT_EQ(snap_to_skin(footed(0.0), effectors).size(), 1u);
  EXPECT_NEAR(effectors[0].point.x(), 0.2, 1e-9);
}

TEST(SkinFrames, OtherKindsAndWhatIsUnsoundAreNotLookedAt) {
  EndEffector point = sole(), lost = sole(), flat = sole();
  point.kind = ContactKind::kPoint;
  lost.link = "nowhere";
  flat.normal.setZero();
  std::vector<EndEffector> effectors = {point, lost, flat};
  EXPECT_TRUE(snap_to_skin(footed(4e-4), effectors).empty());
  EXPECT_THROW(beyond_frame_m(footed(0.0), lost), Error);
  EXPECT_FALSE(beyond_frame_m(footed(0.0), point));
}

}  // namespace
}  // namespace locograph
