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
/// sides. Tallies get depths as positive numbers.

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
  /// Keeps a reference to the context.
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
  void run_step(int step, const JudgedStance* stance, const Sample& from, const Sample& to);
  void refine(int step, const JudgedStance* stance, const Sample& from, const Sample& to);
  double path_bound(int step, const Sample& from, const Sample& to, const Channel& channel) const;

  CheckContext& context_;
  // The motion, and standing on after the last vertex until CheckOptions::until_s.
  std::optional<Motion> standing_;
  std::unique_ptr<MotionSampler> own_sampler_;
  MotionSampler& sampler_;
  ObstaclePath obstacle_path_;
  double further_m_;
  std::vector<Channel> channels_;
  bool self_ = false;
  int samples_ = 0;
};

}  // namespace locograph
