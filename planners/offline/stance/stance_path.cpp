#include <locograph/planners/offline/stance/stance_path.h>

#include <algorithm>

namespace locograph {
namespace {

using Transition = StanceSpace::Expected;

/// Transitions ahead of those that are tried, of all that may be left out further on.
constexpr std::size_t kMostAhead = 16;
/// What balls slip or are off what they touch where transitions closed them.
constexpr double kRolled_m = 1e-7;
constexpr int kRollRestarts = 4;

/// How far the end effector of change `from` can be held where it is before: up to and with the
/// change that is returned; 0: it cannot.
std::size_t held_up_to(const StancePath& path, std::size_t from) {
  const std::size_t e =
      static_cast<std::size_t>(changed_effector(path.footings[from - 1], path.footings[from]));
  const int held = path.footings[from - 1][e];
  // Where a contact comes back to later, or is moved on from: leave out all in between.
  for (std::size_t j = from + 1; j < path.footings.size(); ++j) {
    const int at = path.footings[j][e];
    const int before = path.footings[j - 1][e];
    // A move that ends where it began, or one place left out: lifted from there anyway.
    if (at == before) continue;
    if (at == held || (at == kFree && held != kFree && before != held)) return j;
  }
  return 0;
}

/// The changes of the path with an end effector held from change `from`, which frees or places it,
/// up to and with change `to`, where it is as without.
std::vector<Transition> changes_held(const StancePath& path, std::size_t from, std::size_t to) {
  const int effector = changed_effector(path.footings[from - 1], path.footings[from]);
  const int held = path.footings[from - 1][static_cast<std::size_t>(effector)];
  std::vector<Transition> changes;
  Footing before = path.footings[from - 1];
  for (std::size_t i = from; i <= to; ++i) {
    Footing next = i < to ? with(path.footings[i], effector, held) : path.footings[i];
    if (next == before) continue;
    changes.push_back({before, next, path.configurations[i], 0, &path.configurations[i - 1]});
    before = std::move(next);
  }
  return changes;
}

/// What is tried if the change is not left out, and then if those after it are not.
void expect_changes(StanceSpace& space, const StancePath& path, std::size_t from) {
  if (space.threads() < 2) return;
  std::vector<std::vector<Transition>> expected;
  for (; from < path.footings.size() && expected.size() < kMostAhead; ++from) {
    const std::size_t to = held_up_to(path, from);
    if (to == 0) continue;
    for (Transition& change : changes_held(path, from, to)) {
      expected.push_back({std::move(change)});
    }
  }
  space.expect(expected);
}

/// Nothing where one of the changes is not found.
bool without_changes(StanceSpace& space, const StancePath& path, std::size_t from, std::size_t to,
                     StancePath& shorter) {
  const std::ptrdiff_t kept = static_cast<std::ptrdiff_t>(from);
  shorter.footings.assign(path.footings.begin(), path.footings.begin() + kept);
  shorter.configurations.assign(path.configurations.begin(), path.configurations.begin() + kept);
  for (Transition& change : changes_held(path, from, to)) {
    StanceSpace::Attempt attempt = space.try_transition(change.from, change.to, change.start, 0,
                                                        &shorter.configurations.back());
    if (!attempt.found) return false;
    shorter.append(std::move(change.to), std::move(attempt.configuration));
  }
  // What comes after depends on its own stances, and on where balls have rolled to.
  const std::size_t next = shorter.footings.size();
  for (std::size_t i = to + 1; i < path.footings.size(); ++i) {
    shorter.append(path.footings[i], path.configurations[i]);
  }
  return roll_on(space, shorter, next) == 0;
}

}  // namespace

int shorten(StanceSpace& space, StancePath& path, std::size_t first) {
  int fewer = 0;
  for (std::size_t i = first + 1; i < path.footings.size() && !space.ended();) {
    const std::size_t to = held_up_to(path, i);
    StancePath shorter;
    if (to != 0) expect_changes(space, path, i);
    if (to == 0 || !without_changes(space, path, i, to, shorter) ||
        shorter.footings.size() >= path.footings.size()) {
      ++i;
      continue;
    }
    fewer += static_cast<int>(path.footings.size() - shorter.footings.size());
    path = std::move(shorter);
  }
  return fewer;
}

bool roll_to(StanceSpace& space, const Footing& from, const Footing& to,
             const Eigen::VectorXd& before, Eigen::VectorXd& q) {
  if (space.slip_m(from, before, q) <= kRolled_m) return true;
  StanceSpace::Attempt attempt = space.try_nearby(from, to, q, &before);
  if (!attempt.found) attempt = space.try_transition(from, to, q, kRollRestarts, &before);
  if (attempt.found) q = std::move(attempt.configuration);
  return attempt.found;
}

std::size_t roll_on(StanceSpace& space, StancePath& path, std::size_t first) {
  for (std::size_t i = first; i < path.footings.size(); ++i) {
    if (!roll_to(space, path.footings[i - 1], path.footings[i], path.configurations[i - 1],
                 path.configurations[i])) {
      return i;
    }
  }
  return 0;
}

Motion path_motion(StanceSpace& space, const StancePath& path, std::size_t first) {
  std::vector<Stance> stances;
  Footing held = path.footings[first];
  for (std::size_t i = first; i < path.footings.size(); ++i) {
    for (std::size_t e = 0; e < held.size(); ++e) {
      if (path.footings[i][e] != held[e]) held[e] = kFree;
    }
    stances.push_back(
        first == 0 ? space.stance(path.footings[i])
                   : space.rolled_stance(path.footings[i], held, path.configurations[first]));
  }
  return stances_motion(std::move(stances),
                        {path.configurations.begin() + static_cast<std::ptrdiff_t>(first),
                         path.configurations.end()});
}

}  // namespace locograph
