#include <gtest/gtest.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/error.h>

#include <cstdlib>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

class DataFolder : public testing::Test {
 protected:
  void TearDown() override { ::unsetenv("LOCOGRAPH_DATA"); }
  test::TemporaryFolder folder;
};

TEST_F(DataFolder, IsToldByAVariableBeforeAllElse) {
  folder.write("robots/models/cart/cart.urdf", "");
  ::setenv("LOCOGRAPH_DATA", folder.path().c_str(), 1);
  EXPECT_EQ(data_folder(), folder.path());
}

TEST_F(DataFolder, IsMissingWhereTheVariableLeadsToNoRobots) {
  ::setenv("LOCOGRAPH_DATA", folder.path().c_str(), 1);
  EXPECT_FALSE(find_data_folder());
  EXPECT_THROW(data_folder(), Error);
}

}  // namespace
}  // namespace locograph
