#include <locograph/check/limits.h>
#include <locograph/common/error.h>
#include <locograph/planners/task/skin_frames.h>
#include <locograph/world/effector_skin.h>

#include <cmath>
#include <cstdio>

namespace locograph {

std::vector<SkinFrame> snap_to_skin(const Robot& robot, std::vector<EndEffector>& effectors) {
  std::vector<SkinFrame> off;
  for (EndEffector& effector : effectors) {
    try {
      require_sound_effector(robot, effector);
    } catch (const Error&) {
      continue;  // told where it is used, with its line
    }
    const double beyond_m = beyond_frame_m(robot, effector).value_or(0.0);
    if (beyond_m <= limits::kDepthRounding_m && beyond_m > -kTold_m) continue;
    const bool snapped = beyond_m > 0.0 && beyond_m <= kMostSnap_m;
    if (snapped) effector.point -= beyond_m * axes_in_link(effector).col(2);
    off.push_back({effector.name, effector.link, beyond_m, snapped});
  }
  return off;
}

std::string skin_text(const SkinFrame& frame) {
  char number[32];
  std::snprintf(number, sizeof number, "%.3g", 1e3 * std::abs(frame.beyond_m));
  if (frame.beyond_m < 0.0) {
    return frame.end_effector + ": its frame lies " + number +
           " mm outside of the shapes fixed to " + frame.link +
           ", which hang in the air by as much";
  }
  return frame.end_effector + ": shapes fixed to " + frame.link + " reach " + number +
         " mm beyond its frame" +
         (frame.snapped ? "; it touches with these"
                        : ", more than the 2 mm that are made up for: it is in what it touches");
}

}  // namespace locograph
