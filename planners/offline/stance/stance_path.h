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

/// See stances_motion.
Motion path_motion(const StanceSpace& space, const StancePath& path);

}  // namespace locograph
