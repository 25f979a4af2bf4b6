#pragma once
/// What the tests of scenarios share: scenarios as texts, and texts with a mistake.
///
///     Scenario scenario = scenario_of(with(kGood, "friction=\"0.8\"", ""));
///     expect_refused(kGood, {"NoRobot", "<robot urdf=\"r.urdf\"/>", "", 1, "no <robot>"});

#include "planners/mistakes.h"
#include "planners/planned_drive.h"

namespace locograph {

/// data: holds the files that the text names; it is written there as s.xml.
inline Scenario scenario_of(const DataFolder& data, const std::string& text) {
  return load_scenario(data.write("s.xml", text).string(), data.path());
}

inline Scenario scenario_of(const std::string& text) { return scenario_of(DataFolder(), text); }

/// A drive of a robot that nobody has, in this <environment>.
inline std::string drive_in(const std::string& environment) {
  return "<scenario version=\"1\" name=\"drive\">\n"
         "<robot urdf=\"r.urdf\"/>\n"
         "<wheels><wheel link=\"w\" radius=\"0.1\"/></wheels>\n" +
         environment +
         "\n<drive distance=\"2\" speed=\"0.2\" configurations=\"2\"/>\n"
         "</scenario>\n";
}

inline void expect_refused(const std::string& good, const Mistake& mistake) {
  const DataFolder data;
  expect_refused(data.write("s.xml", with(good, mistake.find, mistake.replace)), mistake,
                 [&](const auto& file) { load_scenario(file.string(), data.path()); });
}

}  // namespace locograph
