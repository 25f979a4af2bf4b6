#pragma once
/// Whether a posture holds the goals of a contact task, and which contact to move where none is
/// found: asked before stances are looked for, which get no nearer to such a goal in the end.
///
///     if (const std::optional<UnheldGoal> unheld = unheld_goal(task)) {
///       std::cerr << unheld->text << '\n';   // no posture is found that holds the goal …
///     }
///
/// Postures are those of the stance planner (StanceSpace::stand), without an execution margin, from
/// a few dozen starts. That none is found is no proof that there is none.

#include <locograph/common/deadline.h>
#include <locograph/planners/task/task.h>

#include <Eigen/Core>
#include <optional>
#include <string>

namespace locograph {

struct UnheldGoal {
  int goal = 0;      ///< of Task::goals
  std::string text;  ///< which goal, why, and what to move
  /// A contact which, moved by so much [m, world], leaves a goal that a posture was found for: in
  /// its plane if that does, else to another surface, else to where there is nothing as yet; the
  /// least that was found of all contacts. Empty: none.
  std::string contact;
  Eigen::Vector3d move_m = Eigen::Vector3d::Zero();
  bool touches = false;  ///< it lies on something there
};

/// Of the first goal that is not held; nothing: all are, or the deadline passed first.
std::optional<UnheldGoal> unheld_goal(const Task& task, const Deadline& deadline = {});

}  // namespace locograph
