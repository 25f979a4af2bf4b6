#include <locograph/planners/answer/planner_answer.h>

#include <array>

namespace locograph {

const std::string& planner_status_name(PlannerStatus status) {
  static const std::array<std::string, 5> names = {"solved", "infeasible", "not_found", "deadline",
                                                   "stopped"};
  return names[static_cast<std::size_t>(status)];
}

std::optional<PlannerAnswer> end_by(const Termination& termination, int iterations) {
  if (termination.stopped()) {
    return PlannerAnswer{PlannerStatus::kStopped, "interrupted (start again to go on)"};
  }
  if (termination.deadline.passed()) {
    return PlannerAnswer{PlannerStatus::kDeadline, "the time allowed is used up (allow more)"};
  }
  if (termination.used_up(iterations)) {
    return PlannerAnswer{PlannerStatus::kNotFound,
                         "the iterations allowed are used up (allow more)"};
  }
  return std::nullopt;
}

}  // namespace locograph
