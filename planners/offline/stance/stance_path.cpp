#include <locograph/planners/offline/stance/stance_path.h>

#include <algorithm>

namespace locograph {
namespace {

/// One end effector's contact added, taken away or, over two changes, moved.
struct Change {
  int effector, place;
};

Change change_at(const StancePath& path, std::size_t i) {
  const Footing &before = path.footings[i - 1], &after = path.footings[i];
  for (std::size_t e = 0; e < before.size(); ++e) {
    if (before[e] != after[e]) return {static_cast<int>(e), after[e]};
  }
  return {0, after.front()};
}

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
    const Change change = change_at(path, i);
    // Where a contact comes back to later, or is moved on from: leave out all in between.
    std::size_t to = 0;
    const int held = path.footings[i - 1][static_cast<std::size_t>(change.effector)];
    for (std::size_t j = i + 1; j < path.footings.size(); ++j) {
      const int at = path.footings[j][static_cast<std::size_t>(change.effector)];
      const int before = path.footings[j - 1][static_cast<std::size_t>(change.effector)];
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
    if (to == 0 || !without_changes(space, path, i, to, change.effector, shorter) ||
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
  Motion motion;
  motion.stances_only = true;
  motion.configurations = path.configurations;
  for (std::size_t i = 0; i < path.footings.size(); ++i) {
    motion.time_s.push_back(static_cast<double>(i));
    motion.stances.push_back(space.stance(path.footings[i]));
    motion.stance_from.push_back(static_cast<int>(i));
  }
  return motion;
}

JudgedPath judge_path(StanceSpace& space, const Judge& judge, StancePath& path) {
  JudgedPath judged;
  const CheckOptions& options = space.problem().check;
  constexpr int kMostMended = 20;
  for (int mended = 0;; ++mended) {
    judged.report = judge.check(path_motion(space, path), options);
    if (judged.report.feasible) return judged;
    const std::vector<const Violation*> violated = judged.report.violated();
    const std::size_t at =
        violated.empty() ? 0 : static_cast<std::size_t>(violated.front()->at_vertex);
    if (at == 0 || at >= path.footings.size()) return judged;  // the start is the problem's own
    const Footing &from = path.footings[at - 1], &to = path.footings[at];
    for (std::size_t e = 0; e < from.size(); ++e) {
      if (from[e] != to[e]) {
        space.count_failure(static_cast<int>(e), "judge: " + violated.front()->constraint);
      }
    }
    bool better = false;
    if (mended < kMostMended) {
      StanceSpace::Attempt attempt = space.try_harder(from, to, path.configurations[at]);
      if (attempt.found) {
        Motion one;
        one.stances_only = true;
        one.time_s = {0.0, 1.0};
        one.configurations = {attempt.configuration, attempt.configuration};
        one.stances = {space.stance(from), space.stance(to)};
        one.stance_from = {0, 1};
        better = judge.check(one, options).feasible;
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
