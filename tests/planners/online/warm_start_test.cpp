#include <locograph/planners/online/warm_start.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>

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

/// Pushed to the left, by a few centimetres: eight times as far is some steps.
class DriveBackTest : public Entering {
 protected:
  DriveBackTest() : long_window_(plan_, {.steps = 20}) {}

  void push(double off_m) { push(off_m, long_window_); }
  void push(double off_m, Window& window) {
    window.move_to(kPushed);
    warm_start_.enter(window);
    const Eigen::VectorXd was = plan_.configuration(kPushed);
    came_ = plan_.planned();
    Eigen::VectorXd now = was;
    now[1] += off_m;
    plan_.move_to(kPushed, now, window.first_held());
    warm_start_.lead_back(window, was);
  }
  double planned_left_m(int i) const { return planned(i)[1] - came(i)[1]; }
  double is_left_m(int i) const { return std::as_const(plan_).configuration(i)[1] - came(i)[1]; }
  const Eigen::VectorXd& came(int i) const { return came_[static_cast<std::size_t>(i)]; }
  /// What the plan does there now.
  void expect_tracked() {
    const auto tracked = tracked_configurations(graph_, plan_.plan());
    for (int i = kPushed; i <= plan_.last(); ++i) {
      EXPECT_NEAR(tracked[static_cast<std::size_t>(i)][1], planned(i)[1], 1e-6) << i;
    }
    for (const EdgeVelocityTracking& edge : graph_.edges_of<EdgeVelocityTracking>()) {
      const int to = plan_.index_of(edge.vertices[1]);
      if (to <= kPushed) continue;
      Eigen::VectorXd step(edge.step.size());
      plan_.robot().difference(planned(to - 1).data(), planned(to).data(), step.data());
      EXPECT_LT((edge.step - step).head<6>().lpNorm<Eigen::Infinity>(), 1e-4) << to;
    }
  }

  static constexpr int kPushed = 10;
  Window long_window_;
  std::vector<Eigen::VectorXd> came_;
};

TEST_F(DriveBackTest, WhatIsPlannedAndTrackedComesNearerEvenlyAndIsThere) {
  push(0.04);
  double before_m = planned_left_m(kPushed);
  EXPECT_NEAR(before_m, 0.04, 1e-9);
  for (int i = kPushed + 1; i <= plan_.last(); ++i) {
    EXPECT_LE(planned_left_m(i), before_m + 1e-6) << i;
    EXPECT_GT(planned_left_m(i), -1e-6) << i;
    before_m = planned_left_m(i);
  }
  EXPECT_GT(planned_left_m(kPushed + 1), 0.03) << "it is not back at once";
  EXPECT_NEAR(planned_left_m(kPushed + 6), 0.0, 1e-9);
  expect_tracked();
  EXPECT_NEAR(is_left_m(kPushed + 6), 0.04, 1e-6) << "the window is what rolls at first";
}

TEST_F(DriveBackTest, ItGoesBeyondTheWindow) {
  Window two_steps(plan_, {.steps = 2});
  push(0.04, two_steps);
  EXPECT_GT(planned_left_m(kPushed + 3), 1e-3);
  EXPECT_NEAR(planned_left_m(kPushed + 6), 0.0, 1e-9);
  expect_tracked();
}

/// Those before it as well: how much a detour changes there counts.
TEST_F(DriveBackTest, ConfigurationsBeforeItArePlannedBesideTheirPlacesToo) {
  push(0.04);
  ASSERT_LT(long_window_.first_held(), kPushed);
  EXPECT_NEAR(planned_left_m(long_window_.first_held()), 0.04, 1e-9);
}

/// The wheels head along it, and turn as far as they roll.
TEST_F(DriveBackTest, WheelsRollAlongIt) {
  push(0.04);
  const auto state_of = [&](int i) {
    const VertexId<VertexConfiguration> id{plan_.slot(i)};
    ConfigurationState state = graph_.vertex(id).make_derived();
    graph_.vertex(id).derive(planned(i).data(), state);
    return state;
  };
  for (const EdgeRolling& edge : graph_.edges_of<EdgeRolling>()) {
    const int to = plan_.index_of(edge.vertices[1]);
    if (to <= kPushed || to > kPushed + 6) continue;
    Eigen::VectorXd slips(edge.weights.size());
    edge.error(state_of(to - 1), state_of(to), slips);
    EXPECT_LT(slips.lpNorm<Eigen::Infinity>(), 5e-3) << to;
  }
}

TEST_F(DriveBackTest, WhatIsPlannedStaysWhereAConfigurationIsFixedOnTheWay) {
  graph_.set_fixed(plan_.slot(kPushed + 3), true);
  push(0.04);
  EXPECT_NEAR(planned_left_m(kPushed + 1), 0.0, 1e-9);
  EXPECT_NEAR(is_left_m(kPushed + 2), 0.04, 1e-6);
}

}  // namespace warm_start_test
}  // namespace locograph
