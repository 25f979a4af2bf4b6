#pragma once
/// What a robot with depth cameras knows while it walks along a plan: it sees what its cameras show
/// on the way, and judges steps by that.
///
///     CameraWalk eyes(graph, judging, perception, images);
///     options.verify = [&](const Motion& step) { return eyes.check_step(step); };
///     options.pace = [&](int executed) { return eyes.pace(executed); };
///     walk_plan(graph, [&](int executed) { return eyes.world_at(executed); }, options);
///
/// Before it starts the robot stands in its first configuration and looks: images with stamps until
/// then are shown. From one configuration to the next it goes along the plan's curve; perception is
/// given its configurations every 10 ms and at the plan's own, and every image at its stamp. All of
/// it is simulated time: the same bits again.

#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/world/perception/image_source.h>
#include <locograph/world/perception/perception.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace locograph {

struct CameraWalkOptions {
  /// With UnknownSpace::kSlow: how many times as long steps take while, within so many seconds, a
  /// collision sphere of the robot touches what was never seen.
  double slower = 2.0, ahead_s = 2.0;
  /// When it is set no more images are shown: walk_plan() is to end by the same flag. May be null.
  const std::atomic<bool>* stop = nullptr;

  void validate() const;
};

class CameraWalk {
 public:
  /// All but judging must outlive it. judging: by whose word steps are judged, its world aside.
  /// Throws Error for options out of range, and for a perception of a robot with another
  /// configuration.
  CameraWalk(const Graph& graph, const Judging& judging, Perception& perception,
             ImageSource& images, const CameraWalkOptions& options = {});

  /// For walk_plan(): shows all images until the robot is at this configuration. To be called for
  /// one after the other, from the first; once more for the same one where the graph has been
  /// planned on from there. Throws Error for images that cannot be read.
  std::shared_ptr<const WorldSnapshot> world_at(int executed);
  /// The same for a robot that is carried out in simulated time: it is there at that time of the
  /// plan's clock, which ascends from call to call.
  std::shared_ptr<const WorldSnapshot> world_from(double time_s, const Eigen::VectorXd& q);
  /// What was known beforehand, and as its map all of the window that is seen now: for planners.
  World seen() const;
  /// For WalkOptions::verify: of the motion everything in the world that was known beforehand, and
  /// of its last step that it keeps away from what is seen now. (Where the robot was earlier,
  /// things may be now.)
  CheckReport check_step(const Motion& motion) const;
  /// For WalkOptions::pace.
  double pace(int executed) const;

  const std::vector<double>& perception_s() const { return perception_s_; }  ///< of each image
  double images_s() const { return images_s_; }  ///< that taking or reading them took
  int refused() const { return refused_; }       ///< images that perception could not use
  const std::string& last_refusal() const { return last_refusal_; }

 private:
  const VertexConfiguration& vertex(int i) const;
  bool stopped() const { return options_.stop != nullptr && *options_.stop; }
  void stand();
  void step_to(int executed);
  /// where: fills in the robot's configuration at a time.
  void show_until(double time_s, const std::function<void(double, Eigen::VectorXd&)>& where);
  Eigen::AlignedBox3d around(const Motion& motion) const;
  bool touches_unknown(const RobotState& state) const;

  const Graph& graph_;
  Plan plan_;
  Judging judging_;  // in the world known beforehand
  Perception& perception_;
  ImageSource& images_;
  CameraWalkOptions options_;
  std::function<CheckReport(const Motion&)> check_known_;
  RobotState state_;
  int shown_to_ = -1;              ///< of world_at(); not yet
  double is_at_s_ = std::nan("");  ///< of world_from(); not yet
  Eigen::VectorXd is_at_;
  std::vector<double> perception_s_;
  double images_s_ = 0.0;
  int refused_ = 0;
  std::string last_refusal_;
};

}  // namespace locograph
