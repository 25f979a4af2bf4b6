// What a cycle of the online planner asks the system for.
#include <locograph/planners/online/local_planner.h>

#include <array>

#include "common/allocation_counter.h"
#include "planners/online/drive_past_box.h"

namespace locograph {
namespace cycle_allocations_test {

// A box on the way that goes to and fro, and then another one: the search optimises, proposes,
// follows, raises, and begins anew.
TEST(CycleAllocations, AreNoneOnWheelsAfterTheFirstCycles) {
  if (!test::allocations_are_counted()) GTEST_SKIP() << "a sanitizer has its own malloc";
  Graph graph = drive();
  LocalPlanner planner(graph, {});
  std::array<std::shared_ptr<const WorldSnapshot>, 4> worlds;
  for (int k = 0; k < 4; ++k) {
    const double x_m = k < 2 ? 1.6 : 3.1, y_m = k % 2 == 0 ? -0.02 : 0.02;
    worlds[k] = seeing({box("box", {x_m, y_m, 0.25}, {0.5, 0.5, 0.5})});
  }
  constexpr int kFirst = 12, kCycles = 40;  // until all of the search has been gone through
  int detours = 0, iterations = 0, infeasible = 0;
  // At the end of the plan windows get shorter: problems of other patterns.
  for (int at = 0; planner.last_of_window(at) + 1 < planner.plan_size(); ++at) {
    if (at % 2 == 0) planner.show(worlds[static_cast<std::size_t>(at / 2 % 2 + (at < 16 ? 0 : 2))]);
    for (int c = 0; c < kCycles; ++c) {
      const long before = test::allocation_count();
      const CycleReport report = planner.cycle(at, {.max_iterations = 1});
      const long made = test::allocation_count() - before;
      if (at < kFirst) continue;
      detours += report.detour ? 1 : 0;
      iterations += report.statistics.iterations;
      infeasible += report.success() ? 0 : 1;
      EXPECT_EQ(made, 0) << "cycle " << c << " at " << at << (report.detour ? ", a proposal" : "");
    }
  }
  EXPECT_GT(detours, 0);
  EXPECT_GT(iterations, 20);
  EXPECT_GT(infeasible, 0);
}

}  // namespace cycle_allocations_test
}  // namespace locograph
