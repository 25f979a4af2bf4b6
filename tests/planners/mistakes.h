#pragma once
/// Files with one mistake each, which are refused for it with file, line and reason.
///
///     const Mistake kMistakes[] = {{"NoRobot", "<robot urdf=\"r.urdf\"/>", "", 1, "no <robot>"}};
///     TEST_P(BadScenario, IsRefused) {
///       const auto file = folder.write("s.xml", with(kGood, GetParam().find, GetParam().replace));
///       expect_refused(file, GetParam(), [&](const auto& path) { load_scenario(path, folder); });
///     }
///     INSTANTIATE_TEST_SUITE_P(All, BadScenario, testing::ValuesIn(kMistakes), mistake_name);

#include <gtest/gtest.h>
#include <locograph/common/error.h>

#include <filesystem>
#include <ostream>
#include <stdexcept>
#include <string>

namespace locograph {

/// The text with its first `find` replaced.
inline std::string with(std::string text, const std::string& find, const std::string& replace) {
  const std::size_t at = text.find(find);
  if (at == std::string::npos) throw std::invalid_argument("no " + find);
  return text.replace(at, find.size(), replace);
}

struct Mistake {
  const char* name;
  const char* find;     ///< in the text that is good
  const char* replace;  ///< by this
  int line;
  const char* words;
};

inline void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

inline std::string mistake_name(const testing::TestParamInfo<Mistake>& info) {
  return info.param.name;
}

/// file: what the mistake is in. load: throws Error for it.
template <class Load>
void expect_refused(const std::filesystem::path& file, const Mistake& mistake, Load&& load) {
  try {
    load(file);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), file.string());
    EXPECT_EQ(error.line(), mistake.line) << error.what();
    EXPECT_NE(std::string(error.what()).find(mistake.words), std::string::npos) << error.what();
  }
}

}  // namespace locograph
