#include <locograph/planners/offline/stance/judged_path.h>
#include <locograph/planners/offline/stance/standing_wheels.h>

namespace locograph {

JudgedPath judge_path(StanceSpace& space, const Judge& judge, StancePath& path) {
  JudgedPath judged;
  const CheckOptions& options = space.task().check;
  constexpr int kMostMended = 20;
  for (int mended = 0;; ++mended) {
    hold_wheels(space, path);
    judged.report = judge.check(path_motion(space, path), options);
    if (judged.report.feasible) return judged;
    const std::vector<const Violation*> violated = judged.report.violated();
    const std::size_t at =
        violated.empty() ? 0 : static_cast<std::size_t>(violated.front()->at_vertex);
    if (at == 0 || at >= path.footings.size()) return judged;  // the start is the task's own
    const Footing &from = path.footings[at - 1], &to = path.footings[at];
    space.count_failure(changed_effector(from, to), "judge: " + violated.front()->constraint);
    bool better = false;
    if (mended < kMostMended) {
      StanceSpace::Attempt attempt = space.try_harder(from, to, path.configurations[at]);
      if (attempt.found) {
        const StancePath one{{from, to}, {attempt.configuration, attempt.configuration}};
        better = judge.check(path_motion(space, one), options).feasible;
        if (better) path.configurations[at] = std::move(attempt.configuration);
      }
    }
    if (!better) {
      judged.refused = at;
      space.forbid(from, to);
      return judged;
    }
  }
}

}  // namespace locograph
