#pragma once
/// The part of a plan that one cycle of the online planner optimises.
///
///     Window window(online, {.steps = 20});
///     window.move_to(executed);                                    // executed + 1 … executed + 20
///     problem.compile(graph, window.free_vertices(), window.held_vertices());
///
/// A half-open range of plan indices that slides with the executed configuration. Its
/// configurations are free, and so are the wrenches that bear them or the executed one, and
/// vertices of other types whose configurations all lie in it. Held are the executed configuration,
/// earlier ones that edges tie to the window (rolling, velocity, acceleration), and vertices that
/// the window shares with configurations outside. On wheels edges that reach beyond the end of the
/// window do not count: a detour may be longer. On legs configurations after it that edges tie to
/// it are held, where they are now.
///
/// Moving it takes time and memory by its length, not by that of the plan.

#include <locograph/planners/online/online_plan.h>

#include <span>
#include <vector>

namespace locograph {

struct Horizon {
  int steps = 20;
  /// Above 0 it counts instead of `steps`: the window ends with the last configuration within so
  /// many seconds of the executed one; the next one always belongs to it.
  double seconds = 0.0;

  void validate() const;
};

class Window {
 public:
  /// Empty. The plan must outlive it.
  Window(const OnlinePlan& plan, const Horizon& horizon) : plan_(plan), horizon_(horizon) {}

  void move_to(int executed);
  /// Last configuration of the window after an executed one.
  int last_after(int executed) const;

  Graph& graph() const { return plan_.graph(); }
  const OnlinePlan& plan() const { return plan_; }
  int executed() const { return executed_; }
  int first() const { return executed_ + 1; }
  /// The first configuration that is held because edges tie it to the window.
  int first_held() const;
  int end() const { return end_; }
  int last() const { return end_ - 1; }
  int steps() const { return end_ - first(); }
  bool contains(int index) const { return index >= first() && index < end_; }
  /// The first configuration that had never been in the window before it moved here; not below
  /// end() if all had.
  int first_entering() const { return first_entering_; }

  /// Slots in the graph: the configurations in their order, then vertices of other types.
  std::span<const int> free_vertices() const { return free_; }
  std::span<const int> held_vertices() const { return held_; }

  /// The last step of the window that an edge is on, from 1.
  int step_of(int edge) const;

 private:
  bool owns(int slot) const;

  const OnlinePlan& plan_;
  Horizon horizon_;
  int executed_ = 0, end_ = 1;
  int entered_end_ = 1, first_entering_ = 1;
  std::vector<int> free_, held_;
};

}  // namespace locograph
