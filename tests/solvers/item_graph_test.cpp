#include <gtest/gtest.h>
#include <locograph/solvers/item_graph.h>

#include <algorithm>
#include <atomic>
#include <random>

namespace locograph {
namespace {

std::vector<std::pair<int, int>> random_tree(int size, unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<std::pair<int, int>> dependencies;
  for (int i = 0; i + 1 < size; ++i) {
    const int above = i + 1 + static_cast<int>(engine() % static_cast<unsigned>(size - i - 1));
    dependencies.emplace_back(i, above);
  }
  return dependencies;
}

TEST(ItemRunner, RunsEveryItemOnceAndAfterThoseItWaitsFor) {
  for (const int count : {1, 2, 3, 4}) {
    ThreadPool threads(count);
    ItemRunner runner;
    for (unsigned seed = 0; seed < 30; ++seed) {
      const int size = 1 + static_cast<int>(seed) * 5;
      const auto dependencies = random_tree(size, seed);
      const ItemGraph graph(dependencies, std::vector<double>(size, 1.0));
      runner.prepare(size, count);
      std::vector<std::atomic<int>> done(size);
      std::atomic<int> early = 0;
      std::vector<std::vector<int>> before(size);
      for (const auto& [item, waiting] : dependencies) before[waiting].push_back(item);
      runner.run(graph, &threads, [&](int item, const ItemRunner::Crew&) {
        for (const int b : before[item]) early += done[b] != 1;
        ++done[item];
      });
      EXPECT_EQ(early, 0);
      for (int i = 0; i < size; ++i) EXPECT_EQ(done[i], 1) << i;
    }
  }
}

TEST(ItemRunner, RunsEveryChunkOfASharedLoopOnce) {
  ThreadPool threads(3);
  constexpr int kItems = 20, kLoops = 30, kChunks = 17;
  const ItemGraph graph(random_tree(kItems, 1), std::vector<double>(kItems, 1.0));
  ItemRunner runner;
  runner.prepare(kItems, threads.size());
  std::vector<std::atomic<int>> done(kItems * kChunks);
  std::atomic<int> unfinished = 0;
  runner.run(graph, &threads, [&](int item, const ItemRunner::Crew& crew) {
    for (int loop = 0; loop < kLoops; ++loop) {
      crew.share(kChunks, [&](int chunk) { ++done[item * kChunks + chunk]; });
      for (int i = 0; i < kChunks; ++i) unfinished += done[item * kChunks + i] != loop + 1;
    }
  });
  EXPECT_EQ(unfinished, 0);
}

TEST(ItemGraph, MeasuresTheWorkBehindEachItem) {
  const std::vector<std::pair<int, int>> dependencies = {{1, 2}};
  const ItemGraph graph(dependencies, std::vector<double>{2.0, 1.0, 5.0});
  EXPECT_DOUBLE_EQ(graph.path[0], 2.0);
  EXPECT_DOUBLE_EQ(graph.path[1], 6.0);
  EXPECT_DOUBLE_EQ(graph.path[2], 5.0);
}

TEST(ItemRunner, RunsInAscendingOrderWithoutAPool) {
  const ItemGraph graph(random_tree(10, 3), std::vector<double>(10, 1.0));
  ItemRunner runner;
  std::vector<int> order;
  runner.run(graph, nullptr, [&](int item, const ItemRunner::Crew& crew) {
    crew.share(2, [&](int chunk) { order.push_back(2 * item + chunk); });
  });
  ASSERT_EQ(order.size(), 20u);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

}  // namespace
}  // namespace locograph
