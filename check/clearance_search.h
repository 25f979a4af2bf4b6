#pragma once
/// The smallest distances along a motion, between the vertices as well, by branch and bound over
/// time: to obstacles, into surfaces, of what touches, or of the robot to itself.
///
///     ClearanceSearch search(context);
///     search.run_around(obstacle_distance, ground_penetration, touching_depth);
///     search.run_self(self_collision);
///
/// A distance changes by no more than what the things concerned travel. If it is d0 and d1 at the
/// ends of an interval in which they travel at most L, it is at least (d0 + d1 - L) / 2 inside.
/// Intervals whose bound could matter (see CheckOptions::clearance_resolution_m) are halved: for a
/// violation, and for a new smallest distance to obstacles and of the robot to itself.
///
/// What a link may touch is what the stance of the step says, at a vertex the stances on both
/// sides. In a plan of stances a grasp that begins or ends at a vertex is closed there: its hand
/// touches what it holds in both stances, as deep as a hand may. Tallies get depths as positive
/// numbers.
///
/// Where a clearance is asked for (CheckOptions::min_clearance_m), the distance to obstacles counts
/// surfaces, bars and solids, too, but for what a link touches in this stance, the one before or
/// the one after: it has to leave it and to get there.
///
/// Nobody knows when a plan of stances is carried out: obstacles that move are looked at all along
/// their way, as if each configuration was held for as long.

#include <locograph/check/check_context.h>
#include <locograph/check/obstacle_path.h>
#include <locograph/check/violation_tally.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

class ClearanceSearch {
 public:
  /// Keeps a reference to the context. Several may run at once.
  explicit ClearanceSearch(CheckContext& context);

  void run_around(ViolationTally& obstacle, ViolationTally& surface, ViolationTally& touching);
  void run_self(ViolationTally& tally);

  int samples() const { return samples_; }

 private:
  /// One of the distances that a sample has.
  struct Channel {
    ViolationTally* tally;
    double sign;                               // of the distance in the tally
    bool seeks_minimum;                        // not only violations
    bool exists = true;                        // there is something to come near to
    const std::vector<bool>* links = nullptr;  // that are concerned; null: all
  };
  struct Sample {
    double fraction = 0.0;
    std::array<double, 3> distances{};  // of the channels
    LinkPoses world_from_link;
  };

  Sample sample(int vertex, double fraction, const JudgedStance* stance);
  void add(std::size_t channel, CollisionWorld::Closest closest, int vertex, double time_s);
  /// What hands hold that close or open here, in the other one of a vertex's stances.
  void add_grasps(int vertex, const JudgedStance* stance, const LinkPoses& poses,
                  std::vector<CollisionWorld::Touch>& touches) const;
  /// `nearest` becomes what links are to keep away from of surfaces, bars and solids, if that is
  /// nearer.
  void keep_from_surfaces(int vertex, const JudgedStance* stance, CollisionWorld::Query query,
                          CollisionWorld::Closest& nearest) const;
  void find_stances_around();
  void run_step(int step, const JudgedStance* stance, const Sample& from, const Sample& to);
  void refine(int step, const JudgedStance* stance, const Sample& from, const Sample& to);
  /// All along the way of the obstacles, in the configuration of a vertex, from where they begin.
  void run_way(int vertex, const JudgedStance* stance, const Sample& from);
  double time_s(int step, double fraction) const {
    return way_s_ > 0.0 ? fraction * way_s_ : sampler_.time_s(step, fraction);
  }
  double path_bound(int step, const Sample& from, const Sample& to, const Channel& channel) const;

  CheckContext& context_;
  // The motion, and standing on after the last vertex until CheckOptions::until_s.
  std::optional<Motion> standing_;
  MotionSampler sampler_;
  std::optional<MovingShapes> shapes_;
  ObstaclePath obstacle_path_;
  double way_s_;  // what fractions are of in a plan of stances where something moves; else 0
  double further_m_;
  std::vector<Channel> channels_;
  bool keeps_from_surfaces_ = false;
  // Of each vertex: the other stances next to the one from there on; null: none.
  std::vector<const JudgedStance*> before_, after_;
  bool self_ = false;
  int samples_ = 0;
};

}  // namespace locograph
