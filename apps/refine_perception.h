#pragma once
/// `--cameras` and `--clouds DIR` of `refine` and `view`: the robot walks along its plan knowing of
/// the world what its depth cameras show.
///
///     PerceptionChoice choice;
///     add_perception_options(parser, choice);
///     RefinePerception eyes(file, judging, choice);      // once the plan is read
///     eyes.equip(walk_options);
///     walk_plan(file.graph, eyes.world_at(), walk_options);
///
/// With `--cameras` images are simulated in the true world, that of `judging`; of it the robot
/// knows beforehand the surfaces, bars and boxes that may be touched, and the map of `--known-map`.
/// With
/// `--clouds` nobody knows the truth: what is known beforehand is all that the plan, `--map` and
/// `--obstacles` tell.

#include <locograph/apps/option_parser.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/planners/online/camera_walk.h>
#include <locograph/planners/online/walk_plan.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

struct PerceptionChoice {
  bool cameras = false;
  std::string clouds;  ///< a folder; empty: none
  double rate_hz = SimulatedImagesOptions().rate_hz;
  std::string unknown = "free";
  std::string known_map, save_map;  ///< files; empty: none
  double voxel_m = LocalMapOptions().resolution_m;
  double window_m = LocalMapOptions().size_m.x();
  std::uint64_t seed = 0;

  bool given() const { return cameras || !clouds.empty(); }
};

/// All but `--save-map`. choice must outlive the parsing.
void add_perception_options(OptionParser& parser, PerceptionChoice& choice);

/// Throws Error for options that do not go together, and for a save_map that is one of the inputs
/// or cannot be written. After the parsing.
void check_perception_options(const OptionParser& parser, const PerceptionChoice& choice,
                              const std::vector<std::filesystem::path>& inputs);

/// A refined plan is a success if it is one for the judge. Where a robot went by what its cameras
/// showed, a part of a plan is no success either if the judge refuses it.
void take_verdict(const CheckReport& check, WalkReport& report);

class RefinePerception {
 public:
  /// The file must outlive it. Throws Error for files that cannot be used, a robot without cameras,
  /// a map of other voxels than the window's or all of it out of its reach, a window that is too
  /// large, and a save_map that is one of files().
  /// on_image: see PerceptionOptions.
  RefinePerception(const PlanFile& file, const Judging& judging, const PerceptionChoice& choice,
                   std::function<void(const FilteredImage&)> on_image = {});

  /// Of the plan and of recorded clouds: all that must not be written.
  const std::vector<std::filesystem::path>& files() const { return files_; }

  const Perception& perception() const { return *perception_; }
  const CameraWalk& walk() const { return *walk_; }
  /// Of the image that would come next; infinite: there is none.
  double next_stamp_s() const { return images_->next_stamp_s(); }

  /// Sets what is asked on the way: fallbacks, verify, and pace.
  void equip(WalkOptions& options);
  WorldAt world_at();
  /// See CameraWalk::world_from().
  std::shared_ptr<const WorldSnapshot> world_from(double time_s, const Eigen::VectorXd& q) {
    return walk_->world_from(time_s, q);
  }

  /// Fields of the command's result.
  void tell(Json& result) const;
  /// Of what was seen on the way.
  std::string text() const;
  /// Writes the map, if that was asked for.
  void save_map() const;

 private:
  int not_shown() const;

  PerceptionChoice choice_;
  std::vector<std::filesystem::path> files_;
  std::unique_ptr<Perception> perception_;
  std::unique_ptr<ImageSource> images_;
  int recorded_ = 0;  // images of the folder of clouds
  std::optional<CameraWalk> walk_;
};

}  // namespace locograph
