#include <locograph/planners/answer/planner_answer.h>

#include <array>

namespace locograph {

const std::string& planner_status_name(PlannerStatus status) {
  static const std::array<std::string, 5> names = {"solved", "infeasible", "not_found", "deadline",
                                                   "stopped"};
  return names[static_cast<std::size_t>(status)];
}

std::optional<PlannerStatus> ended_as(const Termination& termination, int iterations) {
  if (termination.stopped()) return PlannerStatus::kStopped;
  if (termination.deadline.passed()) return PlannerStatus::kDeadline;
  if (termination.used_up(iterations)) return PlannerStatus::kNotFound;
  return std::nullopt;
}

const char* end_text(PlannerStatus ended) {
  if (ended == PlannerStatus::kStopped) return "interrupted (start again to go on)";
  if (ended == PlannerStatus::kDeadline) return "the time allowed is used up (allow more)";
  return "the iterations allowed are used up (allow more)";
}

std::optional<PlannerAnswer> end_by(const Termination& termination, int iterations) {
  const std::optional<PlannerStatus> ended = ended_as(termination, iterations);
  if (!ended) return std::nullopt;
  return PlannerAnswer{*ended, end_text(*ended)};
}

}  // namespace locograph
