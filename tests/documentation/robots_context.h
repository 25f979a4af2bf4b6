#pragma once
/// What the examples of robots/ take for granted.

// Throws: robots/names.h

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <locograph/robots/capsule.h>
#include <locograph/robots/contact.h>
#include <locograph/robots/covering_capsules.h>
#include <locograph/robots/fit_cache.h>
#include <locograph/robots/mesh_file.h>
#include <locograph/robots/mimic_joints.h>
#include <locograph/robots/stl_file.h>
#include <locograph/robots/triangle_tree.h>
#include <locograph/robots/urdf_reader.h>

namespace locograph::documentation::in_robots {

/// CENTAURO at home, and its first wheel.
struct Context {
  const Robot& robot = *centauro();
  RobotState state = state_at(robot, robot.named_configuration("home"));
  const Contact contact = {.effector = {.name = "wheel_1",
                                        .link = "wheel_1",
                                        .kind = ContactKind::kWheel,
                                        .radius_m = 0.078,
                                        .friction = 0.5,
                                        .max_force_N = 1000.0},
                           .position = {0.3, 0.3, 0.0}};
  const Eigen::Vector3d point = {0.1, 0.05, 0.2};
  double worst = 0.0, area = 0.0;
  const std::string file = "robot.urdf";
  const int line = 12;

  static void report(const std::string&, int, double) {}
  static void draw_sphere(const Eigen::Isometry3d&, double) {}
  static void use(const Eigen::Vector3d&) {}
};

/// With the files of the robot and of a mesh.
struct FilesContext : Context {
  FilesContext() {
    copy_shipped_robot("centauro");
    write_example_file("thigh.stl", kTetrahedron);
  }
};

namespace approximation_h {
struct Context : in_robots::Context {
  const Robot robot = small_arm();
};
}  // namespace approximation_h
namespace capsule_surface_h {
struct Context : FilesContext {
  const Capsule capsule{{0.1, 0.1, 0.0}, {0.1, 0.1, 0.2}, 0.05};
  const TriangleTree mesh{stl_triangles("thigh.stl")};
};
}  // namespace capsule_surface_h
namespace contact_h {
struct Context {
  const Robot& robot = *coman_plus();
};
}  // namespace contact_h
namespace contact_closure_h {
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
}
namespace mesh_fit_h {
using Context = FilesContext;
}
namespace mimic_joints_h {
struct Context {
  UrdfModel model;
  Context() {
    for (const char* name : {"wrist", "finger_1", "finger_2", "finger_3"}) {
      model.joints.push_back({.name = name,
                              .type = JointType::kRevolute,
                              .lower = -1.0,
                              .upper = 1.0,
                              .max_velocity = 1.0});
    }
  }
};
}  // namespace mimic_joints_h
namespace orientation_error_h {
struct Context {
  const Eigen::Isometry3d world_from_target = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d world_from_frame{Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX())};
  Eigen::Matrix<double, 6, 1> e;
};
}  // namespace orientation_error_h
namespace robot_h {
using Context = FilesContext;
}
namespace rolling_ball_h {
struct Context : in_robots::Context {
  const Contact contact = {.effector = {.name = "hand",
                                        .link = "ball1_tip",
                                        .kind = ContactKind::kPoint,
                                        .radius_m = 0.05,
                                        .friction = 0.5,
                                        .max_force_N = 300.0}};
  const Eigen::VectorXd next = robot.named_configuration("home");
};
}  // namespace rolling_ball_h
namespace shape_covers_h {
struct Context : in_robots::Context {
  const Link& link = robot.links()[0];
};
}  // namespace shape_covers_h
namespace srdf_reader_h {
struct Context : FilesContext {
  const UrdfModel urdf = read_urdf("centauro.urdf");
};
}  // namespace srdf_reader_h
namespace states_together_h {
struct Context : in_robots::Context {
  std::vector<RobotState> states{4, RobotState(robot)};
  const std::vector<Eigen::VectorXd> q{4, robot.named_configuration("home")};
};
}  // namespace states_together_h
namespace fit_cache_h {
struct Context {
  const TriangleTree mesh = TriangleTree({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const MeshFitOptions options;
  std::vector<Capsule> capsules;
  static std::vector<Capsule> fit(const TriangleTree&, const MeshFitOptions&) { return {}; }
};
}  // namespace fit_cache_h
namespace mesh_file_h {
struct Context : FilesContext {
  std::size_t triangles = 0;
};
}  // namespace mesh_file_h
namespace stl_file_h {
using Context = FilesContext;
}
namespace triangle_tree_h {
using Context = FilesContext;
}
namespace urdf_reader_h {
using Context = FilesContext;
}
namespace xml_file_h {
struct Context {
  Context() { write_example_file("robot.urdf", "<robot name='r'><link name='pelvis'/></robot>"); }
};
}  // namespace xml_file_h
namespace urdfdom_model_h {
using Context = xml_file_h::Context;
}

}  // namespace locograph::documentation::in_robots
