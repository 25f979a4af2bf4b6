#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/plugins/configuration/execution_margin.h>

namespace locograph {
namespace {

TEST(ExecutionMargin, ScalesFromNoneToItself) {
  const ExecutionMargin margin;
  EXPECT_EQ(margin.scaled(0.0), ExecutionMargin::none());
  EXPECT_EQ(margin.scaled(1.0), margin);
  const ExecutionMargin half = margin.scaled(0.5);
  EXPECT_DOUBLE_EQ(half.friction, 0.825);
  EXPECT_DOUBLE_EQ(half.torque, 0.95);
  EXPECT_DOUBLE_EQ(half.least_force, 0.015);
  EXPECT_DOUBLE_EQ(half.dwell_s, 0.25);
  EXPECT_DOUBLE_EQ(half.self_distance_m, 0.005);
}

TEST(ExecutionMargin, NamesTheNumberThatIsOutOfRange) {
  EXPECT_NO_THROW(ExecutionMargin().validate());
  EXPECT_NO_THROW(ExecutionMargin::none().validate());
  EXPECT_THROW(ExecutionMargin{.friction = 1.1}.validate(), Error);
  EXPECT_THROW(ExecutionMargin{.area = 0.0}.validate(), Error);
  EXPECT_THROW(ExecutionMargin{.torque = -0.9}.validate(), Error);
  EXPECT_THROW(ExecutionMargin{.joint_rad = -1e-3}.validate(), Error);
  EXPECT_THROW(ExecutionMargin{.self_distance_m = 0.3}.validate(), Error);
  EXPECT_THROW(ExecutionMargin{.least_force = 1.0}.validate(), Error);
  EXPECT_THROW(ExecutionMargin{.dwell_s = 61.0}.validate(), Error);
}

}  // namespace
}  // namespace locograph
