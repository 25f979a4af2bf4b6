#include <locograph/planners/online/warm_start.h>

#include "planners/online/drive_past_box.h"

namespace locograph {
namespace warm_start_test {

/// The drive goes straight along x: y is to the left of the plan.
class Entering : public testing::Test {
 protected:
  void set_left(int i, double y_m) {
    plan_.configuration(i) = planned(i);
    plan_.configuration(i)[1] += y_m;
  }
  double left_m(int i) const { return std::as_const(plan_).configuration(i)[1] - planned(i)[1]; }
  const Eigen::VectorXd& planned(int i) const {
    return plan_.planned()[static_cast<std::size_t>(i)];
  }

  Graph graph_ = drive();
  OnlinePlan plan_{graph_};
  Window window_{plan_, {.steps = 3}};
  WarmStart warm_start_{plan_};
};

TEST_F(Entering, ConfigurationsStayAsPlannedWhereNothingHasMoved) {
  window_.move_to(10);
  warm_start_.enter(window_);
  for (int i = window_.first(); i < window_.end(); ++i) {
    const Eigen::VectorXd q = plan_.configuration(i);
    EXPECT_LT((q - planned(i)).cwiseAbs().maxCoeff(), 1e-3) << i;
  }
}

TEST_F(Entering, ConfigurationsContinueTheDriftOfTheStepBefore) {
  set_left(9, 0.01);
  set_left(10, 0.03);
  window_.move_to(10);
  warm_start_.enter(window_);
  EXPECT_NEAR(left_m(11), 0.05, 1e-9);
  EXPECT_NEAR(left_m(12), 0.07, 1e-9);
  EXPECT_NEAR(left_m(13), 0.09, 1e-9);
  EXPECT_NEAR(plan_.configuration(13)[0], planned(13)[0], 1e-9);
}

TEST_F(Entering, TheFirstConfigurationsHaveNoDrift) {
  set_left(0, 0.02);
  window_.move_to(0);
  warm_start_.enter(window_);
  EXPECT_NEAR(left_m(1), 0.02, 1e-9);
}

TEST_F(Entering, ConfigurationsThatHaveEnteredOrAreFixedKeepTheirPlaces) {
  graph_.set_fixed(plan_.slot(14), true);
  window_.move_to(10);
  warm_start_.enter(window_);
  set_left(13, 0.04);
  const Eigen::VectorXd entered = plan_.configuration(13), fixed = plan_.configuration(14);
  window_.move_to(11);
  warm_start_.enter(window_);
  EXPECT_EQ(plan_.configuration(13), entered);
  EXPECT_EQ(plan_.configuration(14), fixed);
}

TEST_F(Entering, AnUnfinishedWindowIsExtendedBesideTheOneInTheGraph) {
  window_.move_to(10);
  warm_start_.enter(window_);
  EXPECT_FALSE(warm_start_.has_unfinished());
  set_left(12, 0.2);
  set_left(13, 0.3);
  warm_start_.keep_unfinished(window_);
  for (int i = 11; i <= 13; ++i) set_left(i, 0.0);

  window_.move_to(11);
  warm_start_.enter(window_);
  EXPECT_TRUE(warm_start_.has_unfinished());
  EXPECT_NEAR(left_m(14), 0.0, 1e-9) << "in the graph";
  warm_start_.load_unfinished(window_);
  EXPECT_NEAR(left_m(12), 0.2, 1e-9);
  EXPECT_NEAR(left_m(13), 0.3, 1e-9);
  EXPECT_NEAR(left_m(14), 0.4, 1e-9);
}

TEST_F(Entering, AnUnfinishedWindowEndsWhereItIsDroppedOrExecuted) {
  window_.move_to(10);
  warm_start_.keep_unfinished(window_);
  warm_start_.drop_unfinished();
  EXPECT_FALSE(warm_start_.has_unfinished());
  warm_start_.keep_unfinished(window_);
  window_.move_to(13);
  warm_start_.enter(window_);
  EXPECT_FALSE(warm_start_.has_unfinished());
}

}  // namespace warm_start_test
}  // namespace locograph
