#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/simd_level.h>
#include <locograph/solvers/kernels.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

namespace locograph {
namespace {

/// Leaves with the code that means "skipped" to ctest when LOCOGRAPH_SIMD names a level that is
/// not this machine's: all tests of the program would fail.
class LevelOfTheRun : public testing::Environment {
  void SetUp() override {
    const char* wanted = std::getenv("LOCOGRAPH_SIMD");
    if (wanted == nullptr) return;
    const std::vector<std::string> all = {"v2", "v3", "v4"}, here = simd_levels();
    const auto is_in = [&](const std::vector<std::string>& levels) {
      return std::find(levels.begin(), levels.end(), wanted) != levels.end();
    };
    if (!is_in(all) || is_in(here)) return;
    std::cout << "skipped: this processor lacks level " << wanted << std::endl;
    std::_Exit(77);
  }
};
const testing::Environment* const kLevelOfTheRun =
    testing::AddGlobalTestEnvironment(new LevelOfTheRun);

std::string message(const std::string& level) {
  try {
    kernels_at(level);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Kernels, TheHighestLevelRunsUnlessAnotherIsAskedFor) {
  const char* wanted = std::getenv("LOCOGRAPH_SIMD");
  EXPECT_EQ(kernels().level, wanted != nullptr ? wanted : simd_levels().back());
  EXPECT_EQ(&kernels(), &kernels_at(kernels().level));
}

TEST(Kernels, EveryLevelHasItsOwn) {
  int lanes = 0;
  for (const std::string& level : simd_levels()) {
    const Kernels& k = kernels_at(level);
    EXPECT_EQ(k.level, level);
    EXPECT_GT(k.lanes(), lanes);
    lanes = k.lanes();
    EXPECT_EQ(k.padded(0), 0);
    EXPECT_EQ(k.padded(1), lanes);
    EXPECT_EQ(k.padded(lanes), lanes);
    EXPECT_EQ(k.padded(lanes + 1), 2 * lanes);
  }
}

TEST(Kernels, AnUnknownLevelIsAnError) {
  for (const char* word : {"v9", "V3", "avx2", ""}) {
    EXPECT_NE(message(word).find(std::string("no level is called '") + word + "'"),
              std::string::npos);
    EXPECT_NE(message(word).find("expected one of " + simd_levels().front()), std::string::npos);
  }
}

TEST(Kernels, ALevelThatTheProcessorLacksIsAnError) {
  const std::vector<std::string> here = simd_levels();
  if (here.front() == "portable") GTEST_SKIP() << "the processor has one level only";
  if (here.back() == "v4") GTEST_SKIP() << "the processor has all levels";
  EXPECT_NE(message("v4").find("this processor lacks level 'v4'"), std::string::npos);
}

}  // namespace
}  // namespace locograph
