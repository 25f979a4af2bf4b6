#include <gtest/gtest.h>
#include <locograph/common/simd_level.h>

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

}  // namespace
}  // namespace locograph
