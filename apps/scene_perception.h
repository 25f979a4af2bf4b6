#pragma once
/// `perception` of a scene (doc/scene_format.md): what depth cameras show on the way along a plan,
/// what of it the self-filter takes, and the map around the robot that comes of it.
///
///     PerceptionScene seen(file, judging, choice);
///     scene["perception"] = seen.along_plan();                 // of the plan as it is
///
///     PerceptionScene live(file, judging, choice);             // of one that is being refined
///     walk_plan(file.graph, live.eyes().world_at(), walk_options);
///     message["perception"] = live.news(time_s);               // after each cycle

#include <locograph/apps/refine_perception.h>

#include <functional>
#include <memory>
#include <vector>

namespace locograph {

class PerceptionScene {
 public:
  /// The file must outlive it. Throws Error for a plan that does not move from one configuration to
  /// the next (stances_only), and as RefinePerception does.
  PerceptionScene(const PlanFile& file, const Judging& judging, const PerceptionChoice& choice);
  PerceptionScene(const PerceptionScene&) = delete;
  PerceptionScene& operator=(const PerceptionScene&) = delete;

  RefinePerception& eyes() { return eyes_; }
  /// The cameras and the map, before anything is seen.
  Json blank() const;
  /// What has come since this was last asked: the newest cloud of each camera, and the map.
  Json news(double time_s);
  /// Walks along the plan: blank() with what is new at its configurations, at no more than some
  /// sixty of them. on_progress: the share that is done; may be empty. Throws Error where no cloud
  /// of a folder falls into the plan's time; warns of clouds and images that are not shown.
  Json along_plan(const std::function<void(double)>& on_progress = {});

 private:
  struct Cloud {
    Eigen::Isometry3d world_from_optical;
    DepthImage kept, taken;
    bool is_new = false;
  };
  /// Of the squares of pixels that one is shown of, in pixels.
  int square(const DepthCamera& camera) const;
  void take(const FilteredImage& image);
  void warn_of_unseen() const;

  const PlanFile& file_;
  PerceptionChoice choice_;
  RefinePerception eyes_;
  std::vector<Cloud> newest_;  // of each camera
  std::shared_ptr<const LocalField> shown_;
};

}  // namespace locograph
