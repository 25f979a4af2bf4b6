#pragma once
/// Lines that must be refused where they stand: the last one of a plan that is good without it.
///
///     const BadLine kBadLines[] = {{"FrameOfAWorld", "PARAMS_FRAME 9 2 arm …", "a PARAMS_WORLD"}};
///     TEST_P(BadFrames, AreAnErrorWithFileAndLine) { expect_bad_line(folder, kGood, GetParam()); }

#include <algorithm>

#include "plugins/plugin_test_support.h"

namespace locograph::test {

struct BadLine {
  const char* name;
  const char* text;
  const char* message;  ///< a part of it
};

inline void PrintTo(const BadLine& bad, std::ostream* out) { *out << bad.name; }

inline std::string bad_line_name(const testing::TestParamInfo<BadLine>& info) {
  return info.param.name;
}

/// The plan `good` is read; with the bad line behind it, it is an error at that line.
inline void expect_bad_line(const TemporaryFolder& folder, const std::string& good,
                            const BadLine& bad) {
  const std::filesystem::path plan = folder.write("plan.g2o", good);
  ASSERT_NO_THROW(read_graph(plan, robot_types()));
  const int line = 1 + static_cast<int>(std::ranges::count(good, '\n'));
  folder.write("plan.g2o", good + bad.text + "\n");
  ASSERT_STRNE(bad.message, "");
  try {
    read_graph(plan, robot_types());
    FAIL() << "was read: " << bad.text;
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find(bad.message), std::string::npos) << what;
    EXPECT_EQ(what.find(plan.string() + ":" + std::to_string(line) + ": "), 0u) << what;
    EXPECT_EQ(error.file(), plan.string());
    EXPECT_EQ(error.line(), line);
  }
}

}  // namespace locograph::test
