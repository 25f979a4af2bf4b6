#pragma once
/// What the examples of check/ take for granted.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>

namespace locograph::documentation::in_check {

extern const Robot robot;
extern const Eigen::VectorXd q0, q1;
extern const Stance both_feet;

}  // namespace locograph::documentation::in_check
