#pragma once
/// Plans as text: one that stands, and how to change the configurations of any.
///
///     runner.write("both.g2o", squat("2 4 5"));
///     PlanText plan(runner.read("plan.g2o"));
///     for (PlanText::Configuration& c : plan.configurations) c.q[2] += 1.0;
///     runner.write("raised.g2o", plan.text());

#include <locograph/robots/robot_state.h>

#include <sstream>
#include <string>
#include <vector>

#include "robots/coman_plus_postures.h"

namespace locograph {

/// COMAN+ in the published squat A0, on the stance of these contacts: 4 is its left sole, 5 the
/// right one; two of them hold it.
inline std::string squat(const std::string& contacts) {
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/coman_plus/coman_plus";
  const Robot robot = Robot::load(stem + ".urdf", stem + ".srdf");
  RobotState state(robot);
  const Eigen::VectorXd q = test::coman_postures()[0].configuration();
  state.update(q.data());
  std::ostringstream text;
  text.precision(17);
  text << "PARAMS_ROBOT 0 " << stem << ".urdf " << stem << ".srdf floating 0\nPARAMS_PLAN 1 3\n";
  for (const int number : {4, 5}) {
    const char* link = number == 4 ? "l_sole" : "r_sole";
    const Eigen::Isometry3d& sole = state.world_from_link(robot.link_index(link));
    text << "PARAMS_CONTACT " << number << " 0 \"\" " << link
         << " surface 0.08 0.035 0.5 1000 0 0 0 0 0 1 1 0 0 at " << sole.translation().transpose()
         << ' ' << sole.linear().col(2).transpose() << ' ' << sole.linear().col(0).transpose()
         << '\n';
  }
  text << "PARAMS_STANCE 6 " << contacts << "\nVERTEX_CONFIGURATION 7 0 0.0 6 " << q.transpose()
       << '\n';
  return text.str();
}

/// The parameters of a plan and its configurations, without its edges.
struct PlanText {
  struct Configuration {
    int id;
    double time_s;
    std::string stance;
    std::vector<double> q;
    std::vector<double> slopes = {};  ///< none: by the rule
  };
  std::vector<std::string> parameters;
  std::vector<Configuration> configurations;

  explicit PlanText(const std::string& text) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      if (line.rfind("PARAMS_", 0) == 0) parameters.push_back(line);
      std::istringstream fields(line);
      std::string tag, robot;
      Configuration c;
      if (!(fields >> tag) || tag != "VERTEX_CONFIGURATION") continue;
      fields >> c.id >> robot >> c.time_s >> c.stance;
      for (double value; fields >> value;) c.q.push_back(value);
      // COMAN+ has 7 + 28 numbers, CENTAURO on its legs 7 + 24: more are slopes.
      if (c.q.size() > 40) {
        const std::size_t positions = (c.q.size() + 1) / 2;
        c.slopes.assign(c.q.begin() + static_cast<std::ptrdiff_t>(positions), c.q.end());
        c.q.resize(positions);
      }
      configurations.push_back(c);
    }
  }

  void without_slopes() {
    for (Configuration& c : configurations) c.slopes.clear();
  }

  /// One more word in its PARAMS_PLAN.
  void mark(const std::string& word) {
    for (std::string& line : parameters)
      if (line.starts_with("PARAMS_PLAN ")) line += ' ' + word;
  }

  /// `count` copies of the first configuration, `step_s` apart, with slopes by the rule.
  void repeat_first(int count, double step_s) {
    configurations.resize(1);
    configurations.front().slopes.clear();
    for (int i = 1; i < count; ++i) {
      Configuration c = configurations.front();
      c.id += i;
      c.time_s += i * step_s;
      configurations.push_back(c);
    }
  }

  std::string text() const {
    std::ostringstream out;
    out.precision(17);
    for (const std::string& line : parameters) out << line << '\n';
    for (const Configuration& c : configurations) {
      out << "VERTEX_CONFIGURATION " << c.id << " 0 " << c.time_s << ' ' << c.stance;
      for (const double value : c.q) out << ' ' << value;
      for (const double value : c.slopes) out << ' ' << value;
      out << '\n';
    }
    return out.str();
  }
};

/// The squat for two seconds in two segments, 0 in stance 6 and 1 in stance 8, of the same
/// contacts: five configurations, 7 to 11, one every half second.
inline PlanText standing_segments() {
  PlanText plan(squat("2 4 5"));
  plan.parameters.push_back("PARAMS_STANCE 8 2 5 4");
  plan.parameters.push_back("PARAMS_SEGMENT 20 0 6 0 1 interpolation");
  plan.parameters.push_back("PARAMS_SEGMENT 21 1 8 1 1 \"by hand\"");
  plan.repeat_first(5, 0.5);
  for (std::size_t i = 2; i < 5; ++i) plan.configurations[i].stance = "8";
  return plan;
}

}  // namespace locograph
