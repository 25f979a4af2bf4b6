#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/simd_level.h>
#include <locograph/solvers/kernels.h>

#include <algorithm>
#include <cstdlib>

namespace locograph {
namespace {

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
