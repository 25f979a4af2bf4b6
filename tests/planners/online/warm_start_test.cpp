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

/// Off by `off`, as measured; the whole way back is in the window.
class DrivenBack : public Entering {
 protected:
  DrivenBack() : long_window_(plan_, {.steps = 20}) {}

  void push(double off_m) {
    long_window_.move_to(kPushed);
    warm_start_.enter(long_window_);
    const Eigen::VectorXd was = plan_.configuration(kPushed);
    planned_ = plan_.planned();
    Eigen::VectorXd now = was;
    now[1] += off_m;
    plan_.move_to(kPushed, now, kPushed);
    warm_start_.lead_back(long_window_, was);
  }
  double was_left_m(int i) const {
    return std::as_const(plan_).configuration(i)[1] - planned_[static_cast<std::size_t>(i)][1];
  }

  static constexpr int kPushed = 10;
  Window long_window_;
  std::vector<Eigen::VectorXd> planned_;
};

TEST_F(DrivenBack, ComesNearerEvenlyAndIsThere) {
  push(0.04);
  double before_m = 0.04;
  for (int i = kPushed + 1; i < long_window_.end(); ++i) {
    EXPECT_LE(was_left_m(i), before_m + 1e-9) << i;
    EXPECT_GT(was_left_m(i), -1e-6) << i;
    before_m = was_left_m(i);
  }
  EXPECT_GT(was_left_m(kPushed + 1), 0.03) << "it is not back at once";
  EXPECT_LT(was_left_m(kPushed + 6), 1e-9);
}

TEST_F(DrivenBack, IsWhatIsPlannedAndTrackedFromThenOn) {
  push(0.04);
  const auto tracked = tracked_configurations(graph_, plan_.plan());
  for (int i = kPushed; i < long_window_.end(); ++i) {
    EXPECT_TRUE(plan_.is_as_planned(i)) << i;
    EXPECT_NEAR(tracked[static_cast<std::size_t>(i)][1], plan_.configuration(i)[1], 1e-6) << i;
  }
  for (const EdgeVelocityTracking& edge : graph_.edges_of<EdgeVelocityTracking>()) {
    const int to = plan_.index_of(edge.vertices[1]);
    if (to <= kPushed || to >= long_window_.end()) continue;
    Eigen::VectorXd step(edge.step.size());
    plan_.robot().difference(plan_.configuration(to - 1).data(), plan_.configuration(to).data(),
                             step.data());
    EXPECT_LT((edge.step - step).head<6>().lpNorm<Eigen::Infinity>(), 1e-4) << to;
  }
}

/// The wheels head along it, and turn as far as they roll.
TEST_F(DrivenBack, WheelsRollAlongIt) {
  push(0.04);
  for (const EdgeRolling& edge : graph_.edges_of<EdgeRolling>()) {
    const int to = plan_.index_of(edge.vertices[1]);
    if (to <= kPushed + 1 || to >= long_window_.end()) continue;
    ConfigurationState a = graph_.vertex(VertexId<VertexConfiguration>{plan_.slot(to - 1)})
                               .make_derived(),
                       b = a;
    a.update(plan_.configuration(to - 1).data());
    b.update(plan_.configuration(to).data());
    Eigen::VectorXd slips(edge.weights.size());
    edge.error(a, b, slips);
    EXPECT_LT(slips.lpNorm<Eigen::Infinity>(), 3e-3) << to;
  }
}

TEST_F(DrivenBack, StaysBesideThePlanByAsMuchWhereAConfigurationIsFixed) {
  graph_.set_fixed(plan_.slot(kPushed + 3), true);
  push(0.04);
  EXPECT_NEAR(was_left_m(kPushed + 2), 0.04, 1e-6);
}

}  // namespace warm_start_test
}  // namespace locograph
