#include <gtest/gtest.h>
#include <locograph/common/thread_pool.h>

#include <numeric>

namespace locograph {
namespace {

TEST(ThreadPool, RunsEveryChunkExactlyOnce) {
  for (const int size : {1, 2, 3}) {
    ThreadPool threads(size);
    EXPECT_EQ(threads.size(), size);
    for (int round = 0; round < 200; ++round) {
      std::vector<int> runs(round, 0);
      threads.run(round, [&](int i) { ++runs[i]; });
      for (const int n : runs) ASSERT_EQ(n, 1);
    }
  }
}

TEST(ThreadPool, WakesAfterASleep) {
  ThreadPool threads(2);
  for (int round = 0; round < 3; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::vector<int> values(64, 0);
    threads.run(64, [&](int i) { values[i] = i; });
    EXPECT_EQ(std::accumulate(values.begin(), values.end(), 0), 63 * 64 / 2);
  }
}

TEST(ThreadPool, ThrowsTheErrorOfTheLowestChunk) {
  for (const int size : {1, 2}) {
    ThreadPool threads(size);
    const auto fail = [](int i) {
      if (i >= 3) throw Error("chunk " + std::to_string(i), "no error");
    };
    try {
      threads.run(16, fail);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("chunk 3"), std::string::npos) << error.what();
    }
    int ran = 0;
    threads.run(1, [&](int) { ++ran; });
    EXPECT_EQ(ran, 1);
  }
}

TEST(ThreadPool, RefusesToHaveNoThread) { EXPECT_THROW(ThreadPool(0), Error); }

}  // namespace
}  // namespace locograph
