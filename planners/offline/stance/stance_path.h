#pragma once
/// A way through stances as planners find it, and what they all do with it: shorten it, and tell
/// it.
///
///     StancePath path;
///     path.append(footing, configuration);
///     shorten(space, path, 0);
///     const Motion motion = path_motion(space, path);

#include <locograph/planners/offline/stance/stance_space.h>

#include <vector>

namespace locograph {

struct StancePath {
  std::vector<Footing> footings;
  std::vector<Eigen::VectorXd> configurations;  ///< the first one's, then of each change

  std::size_t changes() const { return footings.size() - 1; }
  void append(Footing footing, Eigen::VectorXd configuration) {
    footings.push_back(std::move(footing));
    configurations.push_back(std::move(configuration));
  }
};

/// Leaves out moves that checked transitions make unnecessary. The footings up to number `first`
/// stay, and so does the last one. Returns how many stances fewer.
int shorten(StanceSpace& space, StancePath& path, std::size_t first);

/// Finds a transition that was found before again if balls would slip to it since the configuration
/// before: as near as can be. False: not found.
bool roll_to(StanceSpace& space, const Footing& from, const Footing& to,
             const Eigen::VectorXd& before, Eigen::VectorXd& q);
/// Likewise all transitions from number `first` on. Returns the number of one that is not found; 0:
/// none.
std::size_t roll_on(StanceSpace& space, StancePath& path, std::size_t first);

/// See stances_motion. From number `first` on, with balls touching down where they are there.
Motion path_motion(StanceSpace& space, const StancePath& path, std::size_t first = 0);

}  // namespace locograph
