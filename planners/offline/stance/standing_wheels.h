#pragma once
/// Wheels stand still while a stance holds them: what their carriers pitch, their joints turn back.
///
///     hold_wheels(space, path);
///
/// Turning a wheel about its axle closes no contact and opens none, so that transitions are found
/// without regard to how wheels turn, each by itself; this is done once it is known in which order
/// they come.

#include <locograph/planners/offline/stance/stance_path.h>

namespace locograph {

/// Sets the joints of wheels from change number `first` on: of those in contact before a change, so
/// that they do not turn on the ground; others stay as they are.
void hold_wheels(const StanceSpace& space, StancePath& path, std::size_t first = 1);

}  // namespace locograph
