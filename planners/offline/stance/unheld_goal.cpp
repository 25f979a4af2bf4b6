#include <locograph/planners/offline/stance/stance_space.h>
#include <locograph/planners/offline/stance/unheld_goal.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/robots/robot_state.h>

#include <cmath>
#include <cstdio>

namespace locograph {
namespace {

/// Attempts for a goal, and for one with a contact moved; later ones have more restarts.
constexpr int kGoalAttempts = 5, kMovedGoalAttempts = 2;
constexpr int kHalvings = 6;
constexpr double kMillimetre = 1e-3;

class GoalPostures {
 public:
  GoalPostures(const Task& task, const Deadline& deadline)
      : task_(bare(task)),
        deadline_(deadline),
        space_(task_, options_),
        state_(*task.robot->robot) {}

  bool holds(const Stance& goal, int attempts = kGoalAttempts) {
    if (goal.contacts.empty()) return true;
    const Eigen::VectorXd near = placed_at(*task_.robot->robot, task_.start_configuration, goal);
    for (int attempt = 0; attempt < attempts && !deadline_.passed(); ++attempt) {
      for (const Eigen::VectorXd* start : {&near, &task_.start_configuration}) {
        const StanceSpace::Attempt found = space_.stand(goal, *start, attempt);
        if (found.found) {
          state_.update(found.configuration.data());
          return true;
        }
        reason_ = found.reason;
      }
    }
    return false;
  }

  const std::string& reason() const { return reason_; }

  /// The least move of one of its contacts that makes a goal holdable.
  void find_move(const Stance& goal, UnheldGoal& unheld) {
    for (std::size_t c = 0; c < goal.contacts.size(); ++c) {
      Stance without = goal;
      without.contacts.erase(without.contacts.begin() + static_cast<std::ptrdiff_t>(c));
      if (without.contacts.empty() || !holds(without, kMovedGoalAttempts)) continue;
      const Contact& contact = goal.contacts[c];
      const Eigen::Vector3d normal = contact.normal.normalized();
      const int link = task_.robot->robot->link_index(contact.effector.link);
      const Eigen::Vector3d way =
          state_.world_from_link(link) * contact.effector.point - contact.position;
      for (const Eigen::Vector3d& along : {(way - way.dot(normal) * normal).eval(), way}) {
        const auto move = least_move(goal, c, along);
        if (!move) continue;
        if (unheld.contact.empty() || move->norm() < unheld.move_m.norm()) {
          unheld.contact = contact.name();
          unheld.move_m = *move;
        }
        break;
      }
    }
  }

 private:
  static Task bare(const Task& task) {
    Task bare = task;
    bare.margin = ExecutionMargin::none();
    return bare;
  }

  std::optional<Eigen::Vector3d> least_move(const Stance& goal, std::size_t contact,
                                            const Eigen::Vector3d& along) {
    const auto holds_moved = [&](const Eigen::Vector3d& by) {
      Stance moved = goal;
      moved.contacts[contact].position += by;
      return holds(moved, kMovedGoalAttempts);
    };
    // To millimetres, away from where it is: what is told is what was tried.
    const auto rounded = [&](double share) {
      Eigen::Vector3d by = share * along / kMillimetre;
      for (double& value : by) value = std::copysign(std::ceil(std::abs(value) - 1e-6), value);
      return (kMillimetre * by).eval();
    };
    if (along.norm() < kMillimetre || !holds_moved(rounded(1.0))) return {};
    double not_enough = 0.0, enough = 1.0;
    for (int k = 0; k < kHalvings && !deadline_.passed(); ++k) {
      const double middle = 0.5 * (not_enough + enough);
      (holds_moved(rounded(middle)) ? enough : not_enough) = middle;
    }
    return rounded(enough);
  }

  const Task task_;
  const Deadline& deadline_;
  const StancePlannerOptions options_;
  StanceSpace space_;
  RobotState state_;  // of the last posture that was found
  std::string reason_;
};

std::string text_of(const UnheldGoal& unheld, std::size_t goals, const std::string& reason) {
  std::string text = "no posture is found that holds ";
  text += goals > 1 ? "goal " + std::to_string(unheld.goal + 1) + " of " + std::to_string(goals)
                    : "the goal";
  text += " (" + reason + ")";
  if (unheld.contact.empty()) return text + ", nor one with one of its contacts elsewhere";
  char by[120];
  std::snprintf(by, sizeof by, " moved by (%.3f %.3f %.3f) m, %.3f m in all, one is",
                unheld.move_m.x(), unheld.move_m.y(), unheld.move_m.z(), unheld.move_m.norm());
  return text + "; with " + unheld.contact + by;
}

}  // namespace

std::optional<UnheldGoal> unheld_goal(const Task& task, const Deadline& deadline) {
  GoalPostures postures(task, deadline);
  for (std::size_t g = 0; g < task.goals.size(); ++g) {
    if (postures.holds(task.goals[g])) continue;
    if (deadline.passed()) return {};
    UnheldGoal unheld;
    unheld.goal = static_cast<int>(g);
    const std::string reason = postures.reason();
    postures.find_move(task.goals[g], unheld);
    unheld.text = text_of(unheld, task.goals.size(), reason);
    return unheld;
  }
  return {};
}

}  // namespace locograph
