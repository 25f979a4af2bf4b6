#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/job_control.h>

namespace locograph {
namespace {

TEST(Termination, NeverEndsAJobUnlessItIsTold) {
  EXPECT_FALSE(Termination().ended());
  EXPECT_FALSE(Termination().ended(1'000'000));
}

TEST(Termination, EndsAJobByItsDeadlineItsFlagOrItsCount) {
  EXPECT_TRUE(Termination{.deadline = Deadline::after(0.0)}.ended());
  std::atomic<bool> stop = false;
  const Termination stoppable{.stop = &stop};
  EXPECT_FALSE(stoppable.ended());
  stop = true;
  EXPECT_TRUE(stoppable.ended());
  EXPECT_TRUE(stoppable.stopped());
  const Termination counted{.max_iterations = 3};
  EXPECT_FALSE(counted.ended(2));
  EXPECT_TRUE(counted.ended(3));
}

TEST(Termination, LeavesAPartOfAJobWhatIsLeftOfTheCount) {
  EXPECT_EQ(Termination().left_of(60, 1000), 60);
  const Termination counted{.max_iterations = 100};
  EXPECT_EQ(counted.left_of(60, 10), 60);
  EXPECT_EQ(counted.left_of(60, 70), 30);
  EXPECT_EQ(counted.left_of(60, 200), 0);
  EXPECT_EQ(counted.after(70).max_iterations, 30);
  EXPECT_EQ(Termination().after(70), Termination());
}

TEST(Termination, RefusesANegativeCount) {
  EXPECT_THROW(Termination{.max_iterations = -1}.validate(), Error);
  EXPECT_NO_THROW(Termination().validate());
}

TEST(JobControl, TellsHowFarAJobIs) {
  JobControl job;
  job.report_progress("nobody listens", 1, 4);
  double told = 0.0;
  job.report = [&told](std::string_view, double fraction) { told = fraction; };
  job.report_progress("a quarter", 1, 4);
  EXPECT_EQ(told, 0.25);
}

}  // namespace
}  // namespace locograph
