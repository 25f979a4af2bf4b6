// Soles that are larger than what they stand on: what of them lies on it bears.
#include <apps/command_runner.h>

#include <algorithm>
#include <sstream>

namespace locograph::large_soles_test {
namespace {

/// A body on two feet that slide across, along and up; soles of this half length.
std::string slider(double half_m) {
  const std::string mass =
      "<mass value='1'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/>";
  std::string text =
      "<robot name='slider'><link name='body'><inertial><mass value='30'/><inertia ixx='1' ixy='0' "
      "ixz='0' iyy='1' iyz='0' izz='1'/></inertial><collision><geometry><box size='0.2 0.2 0.2'/>"
      "</geometry></collision></link>";
  const double across_m = std::min(half_m, 0.2);
  for (const std::string side : {"left", "right"}) {
    std::string above = "body";
    for (const std::string axis : {"0 1 0", "1 0 0", "0 0 1"}) {
      const bool sole = axis == "0 0 1";
      const std::string link = sole ? side + "_foot" : side + (axis == "0 1 0" ? "_y" : "_x");
      text += "<link name='" + link + "'><inertial>" + mass + "</inertial>";
      if (sole) {
        text += "<collision><origin xyz='0 0 0.02'/><geometry><box size='" +
                std::to_string(2.0 * half_m) + " " + std::to_string(2.0 * across_m) +
                " 0.04'/></geometry></collision>";
      }
      const std::string origin = above != "body"  ? "0 0 0"
                                 : side == "left" ? "0 0.25 -0.5"
                                                  : "0 -0.25 -0.5";
      text += "</link><joint name='to_" + link + "' type='prismatic'><parent link='" + above +
              "'/><child link='" + link + "'/><origin xyz='" + origin + "'/><axis xyz='" + axis +
              "'/><limit lower='-0.5' upper='0.5' velocity='1' effort='5000'/></joint>";
      above = link;
    }
  }
  return text + "</robot>\n";
}

std::string feet_at(double x) {
  std::string contacts;
  for (const std::string side : {"left", "right"}) {
    contacts += "<contact end_effector='" + side + "' position='" + std::to_string(x) +
                (side == "left" ? " 0.25" : " -0.25") + " 0' normal='0 0 1' forward='1 0 0'/>";
  }
  return contacts;
}

/// Over four pairs of pillars 0.2 m wide and 0.3 m apart; the feet are so far from their middles.
std::string over_pillars(double half_m, double off_m) {
  std::string text =
      "<scenario version='1' name='pillars'><robot urdf='slider.urdf'/>\n<end_effectors>";
  for (const std::string side : {"left", "right"}) {
    text += "<end_effector name='" + side + "' link='" + side + "_foot' kind='surface' half_x='" +
            std::to_string(half_m) + "' half_y='" + std::to_string(std::min(half_m, 0.2)) +
            "' max_force='1000'/>";
  }
  text += "</end_effectors>\n<environment friction='0.7'>";
  for (int i = 0; i < 4; ++i) {
    for (const std::string y : {"0.25", "-0.25"}) {
      text += "<box name='pillar" + std::to_string(i) + (y == "0.25" ? "l" : "r") + "' center='" +
              std::to_string(0.3 * i) + " " + y + " -0.1' size='0.2 0.2 0.2'/>";
    }
  }
  return text + "</environment>\n<start base='0 0 0.5 0 0 0 1'>" + feet_at(off_m) +
         "</start>\n<goal>" + feet_at(0.9 + off_m) +
         "</goal>\n<planner torque_limits='report'/></scenario>\n";
}

TEST(LargeSoles, GetWhereSmallOnesGet) {
  for (const double half_m : {0.08, 0.2, 0.35, 0.5}) {
    for (const double off_m : {0.0, 0.05}) {
      SCOPED_TRACE(testing::Message() << half_m << ' ' << off_m);
      const CommandRunner runner;
      runner.write("slider.urdf", slider(half_m));
      runner.write("pillars.xml", over_pillars(half_m, off_m));
      const Outcome planned = runner.run("plan pillars.xml --stances-only -o plan.g2o");
      EXPECT_EQ(planned.exit_code, 0) << planned.out << planned.err;
      EXPECT_EQ(runner.run("check plan.g2o").exit_code, 0);
    }
  }
}

TEST(LargeSoles, BearNothingBesideWhatTheyStandOn) {
  const CommandRunner runner;
  runner.write("slider.urdf", slider(0.5));
  // With their rear ends on the first pillars alone.
  std::string text = over_pillars(0.5, 0.0);
  const std::size_t second = text.find("<box name='pillar1l'"), end = text.find("</environment>");
  text.erase(second, end - second);
  const std::string start = feet_at(0.0);
  text.replace(text.find(start), start.size(), feet_at(0.45));
  const std::string goal = feet_at(0.9);
  text.replace(text.find(goal), goal.size(), feet_at(0.0));
  runner.write("pillars.xml", text);
  const Outcome planned = runner.run("plan pillars.xml --stances-only -o plan.g2o");
  ASSERT_EQ(planned.exit_code, 0) << planned.out << planned.err;
  std::istringstream in(runner.read("plan.g2o"));
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string tag, stance;
    double id = 0.0, robot = 0.0, time_s = 0.0, x = 0.0;
    fields >> tag >> id >> robot >> time_s >> stance >> x;
    if (tag != "VERTEX_CONFIGURATION") continue;
    EXPECT_LT(x, 0.13) << "the body stays above the pillars, as its mass is nearly all of it";
  }
}

}  // namespace
}  // namespace locograph::large_soles_test
