#pragma once
/// End effectors whose frames are not on their skin: where a frame lies a little inside of the
/// shapes it belongs to, the end effector touches with these.
///
///     std::vector<EndEffector> effectors = scenario.end_effectors;
///     for (const SkinFrame& off : snap_to_skin(robot, effectors)) std::cerr << skin_text(off);
///
/// A sole whose mesh reaches beyond its frame would be in the ground just before it touches down,
/// and no plan of it could be feasible.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>

#include <string>
#include <vector>

namespace locograph {

/// Up to here frames are moved.
inline constexpr double kMostSnap_m = 2e-3, kTold_m = 1e-4;

struct SkinFrame {
  std::string end_effector, link;
  double beyond_m = 0.0;  ///< that its shapes reach beyond its frame; negative: it lies outside
  bool snapped = false;

  /// Shapes reach beyond it, or it is further outside than would be made up for.
  bool matters() const { return beyond_m > 0.0 || beyond_m < -kMostSnap_m; }
};

/// Moves the points of end effectors beyond which shapes reach by up to kMostSnap_m onto their
/// skin, along their normals, and tells these, those where it is more, and those that lie outside
/// by kTold_m or more. Only surfaces are looked at. Throws Error as beyond_frame_m() does.
std::vector<SkinFrame> snap_to_skin(const Robot& robot, std::vector<EndEffector>& effectors);

/// In one sentence.
std::string skin_text(const SkinFrame& frame);

}  // namespace locograph
