#include <gtest/gtest.h>
#include <locograph/common/deadline.h>

#include <limits>

namespace locograph {
namespace {

TEST(Deadline, NeverPassesUnlessOneWasSet) { EXPECT_FALSE(Deadline().passed()); }

TEST(Deadline, OfNoTimeOrInThePastHasPassed) {
  EXPECT_TRUE(Deadline::after(0.0).passed());
  EXPECT_TRUE(Deadline::after(-1.0).passed());
}

TEST(Deadline, FarAwayHasNotPassed) { EXPECT_FALSE(Deadline::after(3600.0).passed()); }

TEST(Deadline, FurtherAwayThanTheClockCountsNeverPasses) {
  for (const double seconds : {2e9, 1e10, 1e19, 1e300, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(Deadline::after(seconds).passed()) << seconds;
  }
  EXPECT_TRUE(Deadline::after(-1e300).passed());
}

TEST(Deadline, OfALimitOfNoneNeverPasses) {
  EXPECT_FALSE(Deadline::of_limit(0.0).exists());
  EXPECT_TRUE(Deadline::of_limit(1e-3).exists());
}

TEST(Stopwatch, NeverRunsBackwards) {
  Stopwatch watch;
  const double first = watch.seconds();
  const double second = watch.seconds();
  EXPECT_GE(first, 0.0);
  EXPECT_GE(second, first);
  EXPECT_GE(watch.lap(), second);
}

}  // namespace
}  // namespace locograph
