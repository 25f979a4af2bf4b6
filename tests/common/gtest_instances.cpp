#include <common/gtest_instances.h>

namespace testing::internal {
LOCOGRAPH_GTEST_INSTANCES()
}
