#include <locograph/common/check_option.h>
#include <locograph/planners/online/window.h>

#include <algorithm>

namespace locograph {
namespace {

void add_once(std::vector<int>& slots, int slot) {
  if (std::find(slots.begin(), slots.end(), slot) == slots.end()) slots.push_back(slot);
}

}  // namespace

void Horizon::validate() const {
  check_option(steps >= 1, "horizon", "1 or more");
  check_option(seconds >= 0.0, "horizon_s", "0 (off) or more");
}

int Window::last_after(int executed) const {
  if (!(horizon_.seconds > 0.0)) return std::min(executed + horizon_.steps, plan_.last());
  const double until_s = plan_.time_s(executed) + horizon_.seconds;
  int last = std::min(executed + 1, plan_.last());
  while (last < plan_.last() && plan_.time_s(last + 1) <= until_s) ++last;
  return last;
}

void Window::move_to(int executed) {
  executed_ = executed;
  end_ = last_after(executed) + 1;
  first_entering_ = std::max(entered_end_, first());
  entered_end_ = std::max(entered_end_, end_);

  const std::vector<int>& slots = plan_.plan().slots;
  free_.assign(slots.begin() + first(), slots.begin() + end_);
  held_.assign(1, plan_.slot(executed));
  for (int i = first(); i < end_; ++i) {
    for (const int e : plan_.graph().incident_edges(plan_.slot(i))) {
      for (const int v : plan_.graph().edge_vertices(e)) {
        const int index = plan_.index_of(v);
        if (contains(index) || (index >= end_ && plan_.rolls(end_ - 1))) continue;
        if (index < 0 && owns(v)) {
          add_once(free_, v);
        } else {
          add_once(held_, v);
        }
      }
    }
  }
}

int Window::first_held() const {
  int first = executed_;
  for (const int slot : held_) {
    if (const int i = plan_.index_of(slot); i >= 0) first = std::min(first, i);
  }
  return first;
}

/// Whether the window decides a vertex of another type.
bool Window::owns(int slot) const {
  if (const int borne = plan_.borne_at(slot); borne >= 0) return borne >= executed_ && borne < end_;
  for (const int e : plan_.graph().incident_edges(slot)) {
    for (const int v : plan_.graph().edge_vertices(e)) {
      if (plan_.index_of(v) >= 0 && !contains(plan_.index_of(v))) return false;
    }
  }
  return true;
}

int Window::step_of(int edge) const {
  int step = 1;
  for (const int v : plan_.graph().edge_vertices(edge)) {
    step = std::max(step, plan_.first_index_on(v) - executed_);
  }
  return std::min(step, steps());
}

}  // namespace locograph
