#include <locograph/planners/offline/stance/judged_path.h>
#include <locograph/planners/offline/stance/standing_wheels.h>

namespace locograph {
namespace {

/// The last one of those changes that a motion was made for already.
std::size_t last_moved(StanceSpace& space, const StancePath& path) {
  constexpr double kSlipped_m = 1e-5;
  std::size_t i = path.footings.size() - 1;
  while (i > 0 && space.slip_m(path.footings[i - 1], path.configurations[i - 1],
                               path.configurations[i]) <= kSlipped_m) {
    --i;
  }
  return i;
}

}  // namespace

JudgedPath judge_path(StanceSpace& space, const Judge& judge, StancePath& path) {
  JudgedPath judged;
  const CheckOptions& options = space.task().check;
  constexpr int kMostMended = 20;
  const std::size_t begin = last_moved(space, path);
  for (int mended = 0;; ++mended) {
    hold_wheels(space, path);
    judged.report = judge.check(path_motion(space, path, begin), options);
    if (judged.report.feasible) return judged;
    const std::vector<const Violation*> violated = judged.report.violated();
    const std::size_t at =
        violated.empty() ? 0 : begin + static_cast<std::size_t>(violated.front()->at_vertex);
    if (at <= begin || at >= path.footings.size()) return judged;  // the start is the task's own
    const Footing &from = path.footings[at - 1], &to = path.footings[at];
    space.count_failure(changed_effector(from, to), "judge: " + violated.front()->constraint);
    bool better = false;
    if (mended < kMostMended) {
      const StanceSpace::Attempt attempt =
          space.try_harder(from, to, path.configurations[at], &path.configurations[at - 1]);
      if (attempt.found) {
        const Eigen::VectorXd& q = attempt.configuration;
        const Motion alone = stances_motion(
            {space.rolled_stance(from, from, q), space.rolled_stance(to, from, q)}, {q, q});
        better = judge.check(alone, options).feasible;
        if (better) path.configurations[at] = q;
      }
    }
    const std::size_t slips = better ? roll_on(space, path, at + 1) : at;
    if (slips > 0) {
      judged.refused = slips;
      space.forbid(path.footings[slips - 1], path.footings[slips]);
      return judged;
    }
  }
}

}  // namespace locograph
