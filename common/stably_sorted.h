#pragma once
/// Sorting that keeps the order of equals, for types of any alignment: the buffer that GCC 12's
/// std::stable_sort allocates is aligned to 16 bytes only, and Eigen's members may ask for 64.
///
///     std::vector<int> numbers = {2, 3, 1};
///     numbers = stably_sorted(std::move(numbers), std::greater<int>());

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace locograph {

template <class T, class Before>
std::vector<T> stably_sorted(std::vector<T> items, Before before) {
  std::vector<std::size_t> order(items.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (before(items[a], items[b])) return true;
    return !before(items[b], items[a]) && a < b;
  });
  std::vector<T> sorted;
  sorted.reserve(items.size());
  for (const std::size_t i : order) sorted.push_back(std::move(items[i]));
  return sorted;
}

}  // namespace locograph
