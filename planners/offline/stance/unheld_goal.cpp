#include <locograph/planners/offline/stance/stance_space.h>
#include <locograph/planners/offline/stance/unheld_goal.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/robots/robot_state.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <vector>

namespace locograph {
namespace {

/// Attempts for a goal, and for one with a contact moved; later ones have more restarts.
constexpr int kGoalAttempts = 5, kMovedGoalAttempts = 2;
/// Of the way to where the end effector would be, tried in this order; then halved up to the last.
constexpr double kShares[] = {0.125, 0.25, 0.5, 1.0};
constexpr double kShareTolerance = 1.0 / 64.0;
constexpr double kMillimetre = 1e-3;
constexpr std::size_t kMostSurfaces = 4;  // that a contact is moved to

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
      const int link = task_.robot->robot->link_index(contact.effector.link);
      const auto move = move_of(
          goal, c, state_.world_from_link(link) * contact.effector.point - contact.position);
      if (!move) continue;
      const bool touches_sooner = move->touches && !unheld.touches;
      const bool is_shorter =
          move->touches == unheld.touches && move->by_m.norm() < unheld.move_m.norm();
      if (!unheld.contact.empty() && !touches_sooner && !is_shorter) continue;
      unheld.contact = contact.name();
      unheld.move_m = move->by_m;
      unheld.touches = move->touches;
    }
  }

 private:
  static Task bare(const Task& task) {
    Task bare = task;
    bare.margin = ExecutionMargin::none();
    return bare;
  }

  struct Move {
    Eigen::Vector3d by_m;
    bool touches;  ///< something, where it leads to
  };

  static Contact moved(Contact contact, const Eigen::Vector3d& by) {
    contact.position += by;
    return contact;
  }

  bool holds_moved(const Stance& goal, std::size_t contact, const Eigen::Vector3d& by) {
    Stance other = goal;
    other.contacts[contact].position += by;
    return holds(other, kMovedGoalAttempts);
  }

  /// way: to where the end effector is while the other contacts are held. Along its plane, else to
  /// another surface, else through the air.
  std::optional<Move> move_of(const Stance& goal, std::size_t contact, const Eigen::Vector3d& way) {
    const Eigen::Vector3d normal = goal.contacts[contact].normal.normalized();
    const auto in_plane = least_move(goal, contact, way - way.dot(normal) * normal);
    if (in_plane && in_plane->touches) return in_plane;
    if (const auto elsewhere = move_to_surface(goal, contact, way)) return elsewhere;
    return in_plane ? in_plane : least_move(goal, contact, way);
  }

  /// To the places that are nearest to the end of the way, of surfaces that look alike.
  std::optional<Move> move_to_surface(const Stance& goal, std::size_t contact,
                                      const Eigen::Vector3d& way) {
    const Contact& given = goal.contacts[contact];
    const Eigen::Vector3d end = given.position + way;
    std::vector<Eigen::Vector3d> moves;
    for (const Surface& surface : task_.world->world().surfaces) {
      const Eigen::Isometry3d& pose = surface.world_from_surface;
      const Eigen::Vector3d by =
          pose * nearest_point(surface, pose.inverse() * end) - given.position;
      if (by.norm() > kMillimetre && lies_on(surface, moved(given, by))) moves.push_back(by);
    }
    std::ranges::sort(moves, {}, [&](const Eigen::Vector3d& by) { return (by - way).norm(); });
    if (moves.size() > kMostSurfaces) moves.resize(kMostSurfaces);
    for (const Eigen::Vector3d& by : moves) {
      if (!deadline_.passed() && holds_moved(goal, contact, by)) return Move{by, true};
    }
    return {};
  }

  std::optional<Move> least_move(const Stance& goal, std::size_t contact,
                                 const Eigen::Vector3d& along) {
    // To millimetres, away from where it is: what is told is what was tried.
    const auto rounded = [&](double share) {
      Eigen::Vector3d by = share * along / kMillimetre;
      for (double& value : by) value = std::copysign(std::ceil(std::abs(value) - 1e-6), value);
      return (kMillimetre * by).eval();
    };
    if (along.norm() < kMillimetre) return {};
    const auto held = std::ranges::find_if(
        kShares, [&](double s) { return holds_moved(goal, contact, rounded(s)); });
    if (held == std::end(kShares)) return {};
    double enough = *held, not_enough = held == std::begin(kShares) ? 0.0 : *std::prev(held);
    while (enough - not_enough > kShareTolerance && !deadline_.passed()) {
      const double middle = 0.5 * (not_enough + enough);
      (holds_moved(goal, contact, rounded(middle)) ? enough : not_enough) = middle;
    }
    const Eigen::Vector3d by = rounded(enough);
    return Move{by, lies_on_something(task_.world->world(), moved(goal.contacts[contact], by))};
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
  std::snprintf(by, sizeof by, " moved by (%.4g %.4g %.4g) m, %.3g m in all, one is found",
                unheld.move_m.x(), unheld.move_m.y(), unheld.move_m.z(), unheld.move_m.norm());
  text += "; with " + unheld.contact + by;
  return unheld.touches ? text : text + ", where there is nothing to touch as yet";
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
