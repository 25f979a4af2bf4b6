#pragma once
/// The shipped model of COMAN+, loaded once.

#include <locograph/robots/robot.h>

namespace locograph::test {

inline const Robot& coman_plus() {
  static const Robot robot =
      Robot::load(LOCOGRAPH_SOURCE_DIR "/robots/models/coman_plus/coman_plus.urdf",
                  LOCOGRAPH_SOURCE_DIR "/robots/models/coman_plus/coman_plus.srdf");
  return robot;
}

}  // namespace locograph::test
