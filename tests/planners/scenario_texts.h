#pragma once
/// What the tests of scenarios share: texts with something changed, and mistakes in them.
///
///     Scenario scenario = scenario_of(with(kGood, "friction=\"0.8\"", ""));
///     expect_refused(kGood, {"NoRobot", "<robot urdf=\"r.urdf\"/>", "", 1, "no <robot>"});

#include <gtest/gtest.h>
#include <locograph/common/error.h>

#include <stdexcept>

#include "planners/planned_drive.h"

namespace locograph {

/// The text with its first `find` replaced.
inline std::string with(std::string text, const std::string& find, const std::string& replace) {
  const std::size_t at = text.find(find);
  if (at == std::string::npos) throw std::invalid_argument("no " + find);
  return text.replace(at, find.size(), replace);
}

inline Scenario scenario_of(const std::string& text) {
  const DataFolder data;
  return load_scenario(data.write("s.xml", text).string(), data.path());
}

struct Mistake {
  const char* name;
  const char* find;     ///< in the text that is good
  const char* replace;  ///< by this
  int line;
  const char* words;
};

inline void expect_refused(const std::string& good, const Mistake& mistake) {
  const DataFolder data;
  const std::filesystem::path file = data.write("s.xml", with(good, mistake.find, mistake.replace));
  try {
    load_scenario(file.string(), data.path());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), file.string());
    EXPECT_EQ(error.line(), mistake.line) << error.what();
    EXPECT_NE(std::string(error.what()).find(mistake.words), std::string::npos) << error.what();
  }
}

}  // namespace locograph
