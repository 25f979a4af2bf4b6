#pragma once
/// What trajectory files of all kinds share; see trajectory_file.h.

#include <locograph/apps/plan_file.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace locograph {

/// A huge plan, and no more: what is read takes some ten times as much memory.
inline constexpr std::uintmax_t kMostTrajectoryBytes = std::uintmax_t{128} << 20;

/// Throws Error for a plan of stances.
void require_motion(const PlanFile& file);

/// The lines of a graph file for its parameters, as far as they say something of configurations.
std::vector<std::string> parameter_lines(const Graph& graph, const std::filesystem::path& folder);

/// Where the names of a file's joints are among the robot's active ones: each is there once.
/// Otherwise, what is wrong in `what` and `expected`, and nothing.
std::vector<int> joint_order(const Robot& robot, const std::vector<std::string>& names,
                             std::string& what, std::string& expected);

/// Adds configurations to a graph of parameters, each from the words of its line.
class ConfigurationReader {
 public:
  /// Throws Error naming the file without a PARAMS_ROBOT.
  ConfigurationReader(Graph& graph, std::string file);

  const Robot& robot() const { return *robot_->robot; }
  /// time, stance (`-`: not known), base, joints and slopes: fields of a VERTEX_CONFIGURATION after
  /// the number of its robot. line: for errors. Times must increase.
  void add(const std::vector<std::string>& fields, int line);

 private:
  Graph& graph_;
  FileLine where_;
  std::shared_ptr<const RobotParameter> robot_;
  int robot_number_ = 0, count_ = 0;
  double last_s_ = 0.0;
};

}  // namespace locograph
