#pragma once
/// What the examples of robots/ take for granted.

#include <locograph/robots/capsule.h>
#include <locograph/robots/contact.h>
#include <locograph/robots/covering_capsules.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/triangle_tree.h>
#include <locograph/robots/urdf_reader.h>

#include <string>

namespace locograph::documentation::in_robots {

extern const Robot robot;
extern RobotState state;
extern const Link link;
extern const Capsule capsule;
extern const Contact contact;
extern const TriangleTree mesh;
extern const Eigen::Vector3d point;
extern double worst, area;
extern const std::string file;
extern const int line;
extern const UrdfModel urdf;
void report(const std::string& link, int count, double worst_m);
void draw_sphere(const Eigen::Isometry3d& world_from_sphere, double radius_m);
void use(const Eigen::Vector3d& point);

namespace contact_closure_h {
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
}
namespace mimic_joints_h {
extern UrdfModel model;
}
namespace orientation_error_h {
extern const Eigen::Isometry3d world_from_target, world_from_frame;
extern Eigen::Matrix<double, 6, 1> e;
}  // namespace orientation_error_h

}  // namespace locograph::documentation::in_robots
