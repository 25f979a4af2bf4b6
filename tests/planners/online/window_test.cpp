#include <locograph/common/error.h>
#include <locograph/planners/online/window.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits_timed.h>

#include "planners/online/drive_past_box.h"

namespace locograph {
namespace window_test {

using Slots = std::vector<int>;

Slots free_of(const Window& window) {
  return {window.free_vertices().begin(), window.free_vertices().end()};
}
Slots held_of(const Window& window) {
  return {window.held_vertices().begin(), window.held_vertices().end()};
}

TEST(Window, FreesTheConfigurationsAfterTheExecutedOneAndHoldsThoseThatEdgesReachBackTo) {
  Graph graph = drive();
  const OnlinePlan plan(graph);
  Window window(plan, {.steps = 5});
  window.move_to(7);
  EXPECT_EQ(window.first(), 8);
  EXPECT_EQ(window.end(), 13);
  EXPECT_EQ(window.steps(), 5);
  EXPECT_FALSE(window.contains(7));
  EXPECT_TRUE(window.contains(12));
  EXPECT_FALSE(window.contains(13));
  const Slots& slots = plan.plan().slots;
  EXPECT_EQ(free_of(window), Slots(slots.begin() + 8, slots.begin() + 13));
  EXPECT_EQ(held_of(window), (Slots{slots[7], slots[6]})) << "accelerations reach back two steps";
}

TEST(Window, EndsWithThePlan) {
  Graph graph = drive();
  const OnlinePlan plan(graph);
  Window window(plan, {.steps = 5});
  window.move_to(plan.last() - 2);
  EXPECT_EQ(window.steps(), 2);
  EXPECT_EQ(window.last(), plan.last());
  window.move_to(plan.last() - 1);
  EXPECT_EQ(window.steps(), 1);
}

TEST(Window, EndsWithTheLastConfigurationWithinItsSeconds) {
  Graph graph = drive();
  const OnlinePlan plan(graph);
  const double three_steps_s = plan.time_s(10) - plan.time_s(7);
  EXPECT_EQ(Window(plan, {.steps = 20, .seconds = three_steps_s + 1e-6}).last_after(7), 10);
  EXPECT_EQ(Window(plan, {.steps = 20, .seconds = three_steps_s - 1e-6}).last_after(7), 9);
  EXPECT_EQ(Window(plan, {.steps = 20, .seconds = 1e-6}).last_after(7), 8) << "at least one";
  EXPECT_EQ(Window(plan, {.steps = 2, .seconds = 1e6}).last_after(7), plan.last());
  EXPECT_THROW((Horizon{.steps = 5, .seconds = -1.0}.validate()), Error);
  try {
    Horizon{.steps = 0}.validate();
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "option horizon is out of range, expected 1 or more");
  }
}

TEST(Window, TellsWhichConfigurationsEnterForTheFirstTime) {
  Graph graph = drive();
  const OnlinePlan plan(graph);
  Window window(plan, {.steps = 5});
  window.move_to(0);
  EXPECT_EQ(window.first_entering(), 1);
  window.move_to(1);
  EXPECT_EQ(window.first_entering(), 6);
  window.move_to(1);
  EXPECT_EQ(window.first_entering(), window.end());
  window.move_to(10);
  EXPECT_EQ(window.first_entering(), 11) << "configurations that were jumped over do not enter";
  window.move_to(5);
  EXPECT_GE(window.first_entering(), window.end());
}

/// The time from the third configuration to the fourth is an unknown.
class WithTimeStep : public testing::Test {
 protected:
  Graph graph_ = drive();
  const Slots slots_ = plan_of(graph_).slots;
  const VertexId<VertexTimeStep> step_ = graph_.add_vertex(1000, VertexTimeStep(0.8));
  const EdgeId edge_ = graph_.add_edge(
      EdgeVelocityLimitsTimed(*plan_of(graph_).robot->robot, 1.0, 0.0, 0.0, 1e4),
      VertexId<VertexConfiguration>{slots_[3]}, VertexId<VertexConfiguration>{slots_[4]}, step_);
  const OnlinePlan plan_{graph_};
};

TEST_F(WithTimeStep, AVertexWhoseConfigurationsLieInTheWindowIsFree) {
  Window window(plan_, {.steps = 5});
  window.move_to(0);
  Slots expected(slots_.begin() + 1, slots_.begin() + 6);
  expected.push_back(step_.slot);
  EXPECT_EQ(free_of(window), expected);
  EXPECT_EQ(held_of(window), Slots{slots_[0]});
  EXPECT_EQ(window.step_of(edge_.slot), 4);
}

TEST_F(WithTimeStep, AVertexThatIsSharedWithConfigurationsOutsideIsHeld) {
  Window before(plan_, {.steps = 3}), after(plan_, {.steps = 3});
  before.move_to(0);
  EXPECT_EQ(free_of(before), Slots(slots_.begin() + 1, slots_.begin() + 4));
  EXPECT_EQ(held_of(before), (Slots{slots_[0], step_.slot}));
  EXPECT_EQ(before.step_of(edge_.slot), 3) << "the last one of the window";
  after.move_to(3);
  EXPECT_EQ(free_of(after), Slots(slots_.begin() + 4, slots_.begin() + 7));
  const Slots held = held_of(after);
  EXPECT_EQ(std::count(held.begin(), held.end(), step_.slot), 1);
}

TEST_F(WithTimeStep, AnotherVertexHasTheIndexOfItsFirstConfiguration) {
  EXPECT_EQ(plan_.index_of(step_.slot), -1);
  EXPECT_EQ(plan_.first_index_on(step_.slot), 3);
  EXPECT_EQ(plan_.first_index_on(slots_[4]), 4);
}

}  // namespace window_test
}  // namespace locograph
