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
/// Obstacles that come or go during a step are looked at one by one, for as long as they are there;
/// the others are there all along it.
/// Intervals whose bound could matter (see CheckOptions::clearance_resolution_m) are halved: for a
/// violation, and for a new smallest distance to obstacles and of the robot to itself.
///
/// What a link may touch is what the stance of the step says, at a vertex the stances on both
/// sides. Links of a contact that has opened and has been in its plane at every vertex since, and
/// of one that closes and stays in it until then, may be 0.1 mm in that plane, and those of a
/// contact in what is in its plane beside its area. In a plan of stances a grasp that begins or
/// ends at a vertex is closed there: its hand touches what it holds in both stances, as deep as a
/// hand may. Tallies get depths as positive numbers.
///
/// Where a clearance is asked for (CheckOptions::min_clearance_m), the distance to obstacles counts
/// surfaces, bars and solids, too, but for what a link touches in this stance, the one before or
/// the one after: it has to leave it and to get there.
///
/// Until the first time of a motion the robot stands in its first configuration, after the last one
/// in the last until CheckOptions::until_s: obstacles that move are looked at all along their way,
/// once round where they repeat it, and those that appear meanwhile. Nobody knows when a plan of
/// stances is carried out: they are looked at likewise in each configuration.

#include <locograph/check/check_context.h>
#include <locograph/check/obstacle_path.h>
#include <locograph/check/violation_tally.h>

#include <algorithm>
#include <array>
#include <limits>
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
  /// The step that is looked at, at the vertex that it begins with or ends at.
  int step_of(int vertex, const JudgedStance* stance) const;
  /// What has opened and has not left its plane yet, and what closes and does not leave it any
  /// more.
  void add_changing(int vertex, double fraction, const JudgedStance* stance, const LinkPoses& poses,
                    std::vector<CollisionWorld::Touch>& touches) const;
  /// `nearest` becomes what links are to keep away from of surfaces, bars and solids, if that is
  /// nearer.
  void keep_from_surfaces(int vertex, const JudgedStance* stance, CollisionWorld::Query query,
                          CollisionWorld::Closest& nearest) const;
  void find_stances_around();
  /// A contact of another stance that is not held at a vertex is in its plane there.
  bool is_near(const JudgedStance* other, int vertex);
  void run_step(int step, const JudgedStance* stance, const Sample& from, const Sample& to);
  /// One that is not there all along the step.
  void look_at_obstacle(int step, const JudgedStance* stance, std::size_t obstacle, double begin_s,
                        double end_s);
  void refine(int step, const JudgedStance* stance, const Sample& from, const Sample& to);
  /// In the configuration of a vertex, while obstacles move.
  void stand(int vertex, const JudgedStance* stance, double from_s, double to_s);
  double time_s(int step, double fraction) const {
    const double time_s =
        standing_ ? from_s_ + fraction * (to_s_ - from_s_) : context_.curve.time_s(step, fraction);
    return std::clamp(time_s, earliest_s_, latest_s_);
  }
  double path_bound(int step, const Sample& from, const Sample& to, const Channel& channel) const;

  CheckContext& context_;
  MotionSampler sampler_;
  std::optional<MovingShapes> shapes_;
  ObstaclePath obstacle_path_;
  bool standing_ = false;  // fractions are of the time between these
  double from_s_ = 0.0, to_s_ = 0.0;
  // Of samples: the obstacles that count; none: all that are there.
  std::optional<std::vector<std::size_t>> counted_;
  bool one_obstacle_ = false;  // and nothing but the one that counts
  // Fractions tell times up to rounding, which obstacles come and go at exactly.
  double earliest_s_ = -std::numeric_limits<double>::infinity();
  double latest_s_ = std::numeric_limits<double>::infinity();
  double further_m_;
  std::vector<Channel> channels_;
  bool keeps_from_surfaces_ = false;
  // Of each vertex: the other stances next to the one from there on; null: none.
  std::vector<const JudgedStance*> before_, after_;
  // Of each step: a contact of the stance before has not left its plane, one of the stance after
  // is in its plane to the end.
  std::vector<bool> leaves_, arrives_;
  bool self_ = false;
  int samples_ = 0;
};

}  // namespace locograph
