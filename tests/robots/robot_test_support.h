#pragma once
/// What the robot tests share: the public robots, random configurations.

#include <gtest/gtest.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/statics.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "common/temporary_folder.h"
#include "robots/mimic_robot.h"

namespace locograph::test {

inline std::filesystem::path public_robot(const std::string& file) {
  return std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "robots" / file;
}

inline std::filesystem::path model(const std::string& file) {
  return std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots" / "models" / file;
}

inline const std::vector<std::string>& public_robots() {
  static const std::vector<std::string> names = {
      "centauro", "centauro_capsule", "cogimon", "anymal", "go2", "simple_humanoid"};
  return names;
}

struct RobotFile {
  std::string name;
  std::filesystem::path urdf;
};

inline void PrintTo(const RobotFile& file, std::ostream* stream) { *stream << file.name; }

/// The public robots and those that come along, as robots/models/NAME/NAME.urdf.
inline std::vector<RobotFile> public_and_own_robots() {
  std::vector<RobotFile> robots;
  for (const std::string& name : public_robots()) {
    robots.push_back({"public_" + name, public_robot(name + ".urdf")});
  }
  std::vector<std::string> own;
  for (const std::filesystem::directory_entry& entry :
       std::filesystem::directory_iterator(model(""))) {
    const std::string name = entry.path().filename().string();
    if (std::filesystem::exists(entry.path() / (name + ".urdf"))) own.push_back(name);
  }
  std::sort(own.begin(), own.end());
  for (const std::string& name : own) robots.push_back({name, model(name + "/" + name + ".urdf")});
  return robots;
}

/// Unit-quaternion base anywhere within 2 m, joints within their limits (continuous: +-pi).
inline Eigen::VectorXd random_configuration(const Robot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> normal;
  Eigen::VectorXd q(robot.configuration_size());
  if (robot.floating_base()) {
    q.head<3>() << 2.0 * unit(random), 2.0 * unit(random), 2.0 * unit(random);
    q.segment<4>(3) << normal(random), normal(random), normal(random), normal(random);
    q.segment<4>(3).normalize();
  }
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    const bool limited = joint.type != JointType::kContinuous;
    const double lower = limited ? joint.lower : -3.14159;
    const double upper = limited ? joint.upper : 3.14159;
    q[robot.base_configuration_size() + i] = lower + (upper - lower) * 0.5 * (1.0 + unit(random));
  }
  return q;
}

/// The same with every other joint, on average, at one of its limits.
inline Eigen::VectorXd configuration_at_limits(const Robot& robot, std::mt19937& random) {
  Eigen::VectorXd q = random_configuration(robot, random);
  std::uniform_int_distribution<int> side(0, 3);
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    const int drawn = side(random);
    if (joint.type == JointType::kContinuous || drawn > 1) continue;
    q[robot.base_configuration_size() + i] = drawn == 0 ? joint.lower : joint.upper;
  }
  return q;
}

inline Eigen::VectorXd random_vector(int size, double scale, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-scale, scale);
  Eigen::VectorXd v(size);
  for (int i = 0; i < size; ++i) v[i] = unit(random);
  return v;
}

/// For measured errors in the reports of the tests.
inline std::string scientific(double value) {
  std::ostringstream text;
  text << std::scientific << value;
  return text.str();
}

/// A test of values against others that keeps the largest error, for its report.
template <class Parameter>
class ComparedTest : public testing::TestWithParam<Parameter> {
 protected:
  /// tolerance: of the largest entry.
  void compare(const Eigen::MatrixXd& ours, const Eigen::MatrixXd& expected, double tolerance) {
    const double error = (ours - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
    EXPECT_LT(error, tolerance);
    largest_error_ = std::max(largest_error_, error);
  }
  void TearDown() override { this->RecordProperty("largest_error", scientific(largest_error_)); }

 private:
  double largest_error_ = 0.0;
};

/// Of a test of a named robot with (true) and without a floating base.
template <class Named>
std::string floating_or_fixed(const testing::TestParamInfo<std::tuple<Named, bool>>& info) {
  return std::get<0>(info.param).name + (std::get<1>(info.param) ? "_floating" : "_fixed");
}

/// Wrenches of up to 300 N and 30 N m anywhere on the robot.
inline std::vector<PointWrench> random_wrenches(const Robot& robot, int count,
                                                std::mt19937& random) {
  std::uniform_int_distribution<int> link(0, static_cast<int>(robot.links().size()) - 1);
  std::vector<PointWrench> wrenches(static_cast<std::size_t>(count));
  for (PointWrench& wrench : wrenches) {
    wrench.link = link(random);
    wrench.point = random_vector(3, 0.3, random);
    wrench.force = random_vector(3, 300.0, random);
    wrench.moment = random_vector(3, 30.0, random);
  }
  return wrenches;
}

/// One revolute, one prismatic and one fixed joint; a mass on each link.
inline std::string small_robot_urdf() {
  return R"(<robot name="small">
  <link name="base"><inertial><mass value="3"/><origin xyz="0.1 0 0"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="arm"><inertial><mass value="2"/><origin xyz="0 0.2 0" rpy="0.3 0.1 -0.4"/>
    <inertia ixx="1" ixy="0.1" ixz="0" iyy="2" iyz="0" izz="3"/></inertial></link>
  <link name="slide"><inertial><mass value="1"/><origin xyz="0 0 0.3"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="tip"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0.3 0 0.1" rpy="0.1 0.2 0.3"/><axis xyz="0 3 4"/>
    <limit lower="0.5" upper="2" velocity="1.5" effort="20"/></joint>
  <joint name="push" type="prismatic"><parent link="arm"/><child link="slide"/>
    <origin xyz="0 0.4 0"/><axis xyz="1 0 1"/>
    <limit lower="-0.2" upper="0.4" velocity="0.5" effort="30"/></joint>
  <joint name="tip_joint" type="fixed"><parent link="slide"/><child link="tip"/>
    <origin xyz="0 0 0.2" rpy="0 0.5 0"/></joint>
</robot>
)";
}

/// A robot that is a file, or one that is written: "mimic", or the small one.
inline std::filesystem::path file_of(const std::string& name, const std::filesystem::path& urdf,
                                     const TemporaryFolder& folder) {
  if (!urdf.empty()) return urdf;
  return folder.write(name + ".urdf", name == "mimic" ? mimic_robot_urdf() : small_robot_urdf());
}

}  // namespace locograph::test
