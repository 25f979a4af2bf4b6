#include <locograph/planners/offline/stance/stance_path.h>
#include <locograph/planners/offline/stance/standing_wheels.h>

#include <algorithm>

namespace locograph {
namespace {

/// The path with one end effector held, from change `from`, which frees or places it, up to and
/// with change `to`, where it is as without. Nothing where a transition on the way is not found.
bool without_changes(StanceSpace& space, const StancePath& path, std::size_t from, std::size_t to,
                     int effector, StancePath& shorter) {
  shorter.footings.assign(path.footings.begin(),
                          path.footings.begin() + static_cast<std::ptrdiff_t>(from));
  shorter.configurations.assign(path.configurations.begin(),
                                path.configurations.begin() + static_cast<std::ptrdiff_t>(from));
  const int held = path.footings[from - 1][static_cast<std::size_t>(effector)];
  for (std::size_t i = from; i <= to; ++i) {
    Footing next = i < to ? with(path.footings[i], effector, held) : path.footings[i];
    if (next == shorter.footings.back()) continue;
    const StanceSpace::Attempt attempt =
        space.try_transition(shorter.footings.back(), next, path.configurations[i], 0);
    if (!attempt.found) return false;
    shorter.append(std::move(next), attempt.configuration);
  }
  // What comes after depends on its own stances only.
  for (std::size_t i = to + 1; i < path.footings.size(); ++i) {
    shorter.append(path.footings[i], path.configurations[i]);
  }
  return true;
}

}  // namespace

int shorten(StanceSpace& space, StancePath& path, std::size_t first) {
  int fewer = 0;
  for (std::size_t i = first + 1; i < path.footings.size() && !space.ended();) {
    const int effector = changed_effector(path.footings[i - 1], path.footings[i]);
    const std::size_t e = static_cast<std::size_t>(effector);
    // Where a contact comes back to later, or is moved on from: leave out all in between.
    std::size_t to = 0;
    const int held = path.footings[i - 1][e];
    for (std::size_t j = i + 1; j < path.footings.size(); ++j) {
      const int at = path.footings[j][e];
      const int before = path.footings[j - 1][e];
      // A move that ends where it began, or one place left out: lifted from there anyway.
      if (at == before) continue;
      if (at == held) {
        to = j;
        break;
      }
      if (at == kFree && held != kFree && before != held) {
        to = j;
        break;
      }
    }
    StancePath shorter;
    if (to == 0 || !without_changes(space, path, i, to, effector, shorter) ||
        shorter.footings.size() >= path.footings.size()) {
      ++i;
      continue;
    }
    fewer += static_cast<int>(path.footings.size() - shorter.footings.size());
    path = std::move(shorter);
  }
  return fewer;
}

Motion path_motion(const StanceSpace& space, const StancePath& path) {
  std::vector<Stance> stances;
  for (const Footing& footing : path.footings) stances.push_back(space.stance(footing));
  return stances_motion(std::move(stances), path.configurations);
}

JudgedPath judge_path(StanceSpace& space, const Judge& judge, StancePath& path) {
  JudgedPath judged;
  const CheckOptions& options = space.problem().check;
  constexpr int kMostMended = 20;
  for (int mended = 0;; ++mended) {
    hold_wheels(space, path);
    judged.report = judge.check(path_motion(space, path), options);
    if (judged.report.feasible) return judged;
    const std::vector<const Violation*> violated = judged.report.violated();
    const std::size_t at =
        violated.empty() ? 0 : static_cast<std::size_t>(violated.front()->at_vertex);
    if (at == 0 || at >= path.footings.size()) return judged;  // the start is the problem's own
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
