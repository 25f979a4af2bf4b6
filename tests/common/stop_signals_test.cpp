#include <gtest/gtest.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/stop_signals.h>

#include <csignal>
#include <cstdlib>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

using test::TemporaryFolder;

TEST(StopSignals, EndTheProgramAndRemoveTheFilesThatAreNotDone) {
  const TemporaryFolder folder;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::filesystem::path done = folder.write("done", ""), half = folder.write("half", "");
    EXPECT_EXIT(
        {
          take_stop_signals();
          { const RemovedOnSignal written(done); }
          const RemovedOnSignal being_written(half);
          std::raise(signal);
        },
        testing::KilledBySignal(signal), "");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"done"});
  }
}

TEST(StopSignals, StayIgnoredWhereTheyAre) {
  EXPECT_EXIT(
      {
        std::signal(SIGHUP, SIG_IGN);
        take_stop_signals();
        std::raise(SIGHUP);
        std::exit(7);
      },
      testing::ExitedWithCode(7), "");
}

TEST(StopSignals, LetAJobFinishThatHasSomethingToShow) {
  EXPECT_EXIT(
      {
        take_stop_signals();
        const FinishOnSignal finish;
        if (stop_requested()) std::exit(1);
        std::raise(SIGINT);
        std::exit(stop_requested() ? 7 : 1);
      },
      testing::ExitedWithCode(7), "");
}

TEST(StopSignals, EndTheProgramTheSecondTime) {
  EXPECT_EXIT(
      {
        take_stop_signals();
        const FinishOnSignal finish;
        std::raise(SIGTERM);
        std::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(StopSignals, EndTheProgramOnceTheJobIsOver) {
  EXPECT_EXIT(
      {
        take_stop_signals();
        { const FinishOnSignal finish; }
        std::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(StopSignals, EndAProgramThatWasAskedToStopAsIfItHadNotWaited) {
  EXPECT_EXIT(
      {
        take_stop_signals();
        const FinishOnSignal finish;
        std::raise(SIGHUP);
        end_by_stop_signal();
      },
      testing::KilledBySignal(SIGHUP), "");
}

TEST(StopSignals, LeaveALimitOnTheSizeOfFilesToTheWrite) {
  EXPECT_EXIT(
      {
        take_stop_signals();
        std::raise(SIGXFSZ);
        std::exit(7);
      },
      testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace locograph
