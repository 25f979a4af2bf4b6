// One thread shows worlds while another runs cycles. scripts/test.sh runs this under
// ThreadSanitizer, too.
#include <locograph/planners/online/local_planner.h>

#include <thread>

#include "common/sanitized.h"
#include "planners/online/drive_past_box.h"

namespace locograph {
namespace local_planner_threads_test {

constexpr int kCycles = test::kSanitized ? 3 : 10;

/// A short drive, so that a cycle takes little time.
Graph short_drive() { return planned_drive(centauro_drive(1.2, 0.0, 16)); }

LocalPlannerOptions short_window() {
  LocalPlannerOptions options;
  options.horizon = 5;
  return options;
}

/// A cart that stands beside the way, a little further off each time.
std::shared_ptr<const WorldSnapshot> cart_seen_at(double time_s) {
  World world;
  world.obstacles = {box("cart", {0.6, 2.5 + 0.01 * time_s, 0.3}, {0.2, 0.2, 0.2})};
  return std::make_shared<const WorldSnapshot>(std::move(world), time_s);
}

TEST(LocalPlannerOnThreads, IsShownNewerWorldsWhileItPlans) {
  Graph graph = short_drive();
  LocalPlanner planner(graph, short_window());
  planner.show(cart_seen_at(1.0));
  const std::jthread sensors([&planner](const std::stop_token& walked) {
    for (int i = 2; !walked.stop_requested(); ++i) planner.show(cart_seen_at(i));
  });
  double before_s = 1.0;
  for (int executed = 0; executed < kCycles; ++executed) {
    EXPECT_TRUE(planner.cycle(executed).success()) << executed;
    const double seen_s = planner.online_plan().world().stamp_s();
    EXPECT_GE(seen_s, before_s) << "a cycle never goes back to an older world";
    before_s = seen_s;
  }
}

TEST(LocalPlannerOnThreads, EndsACycleInTheWorldThatItBeganWith) {
  Graph graph = short_drive();
  LocalPlannerOptions options = short_window();
  LocalPlanner* shown = nullptr;
  double seen_s = -1.0;
  /// A proposal is asked in the middle of a cycle: there a newer world is shown.
  struct ShowsOnTheWay : Proposal {
    LocalPlanner** planner;
    double* seen_s;
    Answer search(const OnlinePlan& plan, const Window&, const Termination&,
                  std::vector<Eigen::VectorXd>&) override {
      std::thread([this] { (*planner)->show(cart_seen_at(2.0)); }).join();
      *seen_s = plan.world().stamp_s();
      return Answer::kNone;
    }
  };
  options.blocked_m = -1.0;  // a proposal is asked in every cycle
  options.proposals = {[&](const OnlinePlan&) {
    auto proposal = std::make_unique<ShowsOnTheWay>();
    proposal->planner = &shown;
    proposal->seen_s = &seen_s;
    return proposal;
  }};
  LocalPlanner planner(graph, options);
  shown = &planner;
  planner.show(cart_seen_at(1.0));
  planner.cycle(0);
  EXPECT_EQ(seen_s, 1.0);
  EXPECT_EQ(planner.online_plan().world().stamp_s(), 1.0);
  planner.cycle(1);
  EXPECT_EQ(planner.online_plan().world().stamp_s(), 2.0);
}

TEST(LocalPlannerOnThreads, SharesAWorldWithOtherPlanners) {
  const std::shared_ptr<const WorldSnapshot> seen = cart_seen_at(1.0);
  const auto walk = [&seen](std::vector<Eigen::VectorXd>& way) {
    Graph graph = short_drive();
    LocalPlanner planner(graph, short_window());
    planner.show(seen);
    for (int executed = 0; executed < kCycles; ++executed) planner.cycle(executed);
    way = configurations(graph);
  };
  std::vector<Eigen::VectorXd> first, second;
  {
    std::jthread one([&] { walk(first); });
    std::jthread other([&] { walk(second); });
  }
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i], second[i]) << i;
}

}  // namespace local_planner_threads_test
}  // namespace locograph
