#pragma once
/// How often the links of a robot meet each other in random postures: which pairs the SRDF may
/// leave out of self-collision.
///
///     LinkPairs found = sample_link_pairs(robot, {.samples = 10000, .seed = 1});
///     for (const LinkPair& pair : found.pairs)
///       if (!pair.on && !pair.may_be_off(found.samples))
///         report(robot.links()[pair.first].name, "wrongly off");
///
/// Every active joint is drawn evenly from its limits (a continuous one from a turn), whatever the
/// others are. Shapes are the exact ones of collision_world.h. Same seed, same numbers, whatever
/// the threads. Throws Error for a mesh that is missing or cannot be read.

#include <locograph/robots/robot.h>

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

namespace locograph {

struct LinkPair {
  int first = -1, second = -1;  ///< links, first < second
  bool on = false;              ///< one of Robot::self_collision_pairs()
  bool adjacent = false;        ///< one joint that moves is between them
  int meets = 0;                ///< samples in which their shapes overlap
  int near = 0;                 ///< or are nearer than LinkPairOptions::near_m

  /// In more than 9 of 10 samples: the shapes overlap by construction, as those of links that a
  /// short one joins, except where the joints between are bent furthest.
  bool always_meets(int samples) const { return meets > 0.9 * samples; }
  /// Also of adjacent links: one that its joint can bend into the other is to be kept from it.
  bool may_be_off(int samples) const { return meets == 0 || always_meets(samples); }
};

struct LinkPairOptions {
  int samples = 10000;
  std::uint64_t seed = 0;
  int threads = 1;
  double near_m = 0.0;
  /// Pairs are not counted any further once they have come near and have not met in a tenth of all
  /// samples: they neither always meet nor never come near.
  bool stop_when_decided = false;
  /// Those to be counted; empty: all.
  std::vector<std::pair<int, int>> only = {};
};

struct LinkPairs {
  int samples = 0;
  /// All that have shapes and can move against each other, by first, then second link.
  std::vector<LinkPair> pairs;
};

/// Those of Robot::self_collision_pairs() that overlap in a configuration, or come nearer to each
/// other than within_m.
std::vector<std::pair<int, int>> overlapping_links(const Robot& robot,
                                                   const Eigen::VectorXd& configuration,
                                                   double within_m = 0.0);

LinkPairs sample_link_pairs(const Robot& robot, const LinkPairOptions& options);

}  // namespace locograph
