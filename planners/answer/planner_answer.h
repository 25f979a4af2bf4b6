#pragma once
/// What every planner answers, from a posture to a window: a status for programs, a reason for
/// people, and statistics under the same names.
///
///     const PostureResult result =
///         solver.solve(problem, {.termination = {.deadline = Deadline::after(1.0)}});
///     if (!result.success())
///       std::cerr << planner_status_name(result.status) << ": " << result.reason << '\n';
///     std::cout << result.statistics.iterations << " iterations in "
///               << result.statistics.total_s << " s\n";
///
/// Options of planners have a Termination (common/termination.h), whose iterations are those of the
/// statistics; what they found until it ended them is in the result. Bad input is no answer: it is
/// an Error.

#include <locograph/common/termination.h>

#include <optional>
#include <string>

namespace locograph {

enum class PlannerStatus {
  kSolved,      ///< the result is what was asked for
  kInfeasible,  ///< proved: there is none
  kNotFound,    ///< all was tried that the planner tries, or a count is used up
  kDeadline,
  kStopped,
};

/// What people are told of a job that a termination has ended so.
const char* end_text(PlannerStatus ended);

/// "solved", "infeasible", "not_found", "deadline", "stopped"
const std::string& planner_status_name(PlannerStatus status);

/// Results of planners begin with it.
struct PlannerAnswer {
  PlannerStatus status = PlannerStatus::kNotFound;
  std::string reason = {};  ///< of a failure: what was in the way, or what to allow more of

  bool success() const { return status == PlannerStatus::kSolved; }
};

/// What an answer took. Planners that have more to tell derive theirs from it: counts by what they
/// count, seconds as names that end with _s.
struct PlannerStatistics {
  int iterations = 0;
  double total_s = 0.0;  ///< from the call to the answer
};

/// How a termination ends a job that has made some iterations; nothing: it does not.
std::optional<PlannerStatus> ended_as(const Termination& termination, int iterations = 0);
/// The same as an answer, with what people are told.
std::optional<PlannerAnswer> end_by(const Termination& termination, int iterations = 0);

}  // namespace locograph
