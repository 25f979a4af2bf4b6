#include <locograph/planners/offline/stance/transition_problem.h>

#include <array>

namespace locograph {

const std::string& transition_failure_name(TransitionFailure failure) {
  static const std::array<std::string, 8> names = {"none",           "contact", "joint limit",
                                                   "self-collision", "surface", "obstacle",
                                                   "balance",        "torque"};
  return names[static_cast<std::size_t>(failure)];
}

}  // namespace locograph
