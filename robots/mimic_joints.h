#pragma once
/// Mimic joints of a URDF, resolved: who leads whom, and what that leaves of the limits.
///
///     const MimicElement follower{.joint = 3, .leader = "finger_1", .line = 40};
///     lead_mimic_joints(model, {follower}, "gripper.urdf");
///     model.joints[3].mimics;                  // the index of finger_1

#include <locograph/robots/urdf_reader.h>

#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

/// A <mimic> element as it is written: its leader may be a mimic joint itself.
struct MimicElement {
  int joint = -1;  ///< index into UrdfModel::joints
  std::string leader;
  double multiplier = 1.0;
  double offset = 0.0;  ///< rad or m
  int line = 0;
};

/// Fills mimics, multiplier and offset of the joints, and narrows limits of position and velocity
/// of their leaders to what their mimic joints can follow. Limits that would leave a leader no room
/// to move contradict its own: they are left out, with a warning; so is a velocity limit of 0,
/// which files have where nobody measured one. Throws Error for a leader that is unknown or fixed,
/// and for joints that lead each other in a circle.
void lead_mimic_joints(UrdfModel& model, const std::vector<MimicElement>& elements,
                       const std::filesystem::path& file);

}  // namespace locograph
