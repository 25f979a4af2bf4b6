#pragma once
/// What `guided` grows: stances it has come to, and the moves from them that it may try.
///
///     GuidedTree tree;
///     tree.ahead.push(move);
///     tree.ahead.look(8, [](const GuidedTree::Move& likely) { prepare(likely); });

#include <locograph/planners/offline/stance/stance_path.h>

#include <algorithm>
#include <queue>
#include <unordered_map>
#include <vector>

namespace locograph {

/// A priority queue that can be looked into. The greatest of `<` comes first.
template <class Item>
class OpenQueue {
 public:
  bool empty() const { return items_.empty(); }
  const Item& top() const { return items_.front(); }
  void push(const Item& item) {
    items_.push_back(item);
    std::push_heap(items_.begin(), items_.end());
  }
  void pop() {
    std::pop_heap(items_.begin(), items_.end());
    items_.pop_back();
  }
  /// Of the first `most` items, in their order.
  template <class F>
  void look(std::size_t most, F&& f) const {
    const auto later = [this](std::size_t a, std::size_t b) { return items_[a] < items_[b]; };
    std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> next(later);
    if (!items_.empty()) next.push(0);
    for (; most > 0 && !next.empty(); --most) {
      const std::size_t i = next.top();
      next.pop();
      f(items_[i]);
      for (const std::size_t below : {2 * i + 1, 2 * i + 2}) {
        if (below < items_.size()) next.push(below);
      }
    }
  }

 private:
  std::vector<Item> items_;  ///< a heap
};

/// Grown from the start or, since a transition serves both ways, backwards from the goal.
struct GuidedTree {
  struct Node {
    Footing footing;
    Eigen::VectorXd configuration;
    int parent;  ///< -1: the root
    int stances;
    Footing aim;              ///< where its moves lead to
    std::vector<int> failed;  ///< of each end effector: moves from here
    /// Of each end effector in contact: the configuration with it lifted, once it was tried.
    std::vector<Eigen::VectorXd> lifted;
    std::vector<signed char> lift_tried;
    bool cut;  ///< no longer leads to the root
  };
  struct Move {
    double f;                   ///< the least first
    double plain;               ///< without what has failed
    double share;               ///< of the end effector's reach
    long number;                ///< breaks ties
    int node, effector, place;  ///< place kFree: lifted for good
    int restarts;
    bool operator<(const Move& other) const {
      return f != other.f ? f > other.f : number > other.number;
    }
  };

  bool backwards = false;
  std::vector<Node> nodes;
  OpenQueue<Move> ahead;   ///< moves by how near they come to where they lead
  OpenQueue<Move> around;  ///< the same moves by how new what they come to is
  std::unordered_map<Footing, int, FootingHash> known;            ///< the node of each footing
  std::unordered_map<std::vector<int>, int, FootingHash> crowds;  ///< nodes of each rough footing

  /// Whether the move's end effector is in contact, and was not lifted from there before.
  bool to_be_lifted(const Move& move) const;
  /// The numbers of the nodes from a footing to the root.
  std::vector<int> way_to_root(const Footing& from) const;
  /// A node, and those that lead to the root through it: they are not known any more.
  void cut_off(int node);
  /// What comes after the first node of a way from the root; an end effector that moves is lifted
  /// in between.
  void append(const std::vector<int>& way, StancePath& path) const;
};

}  // namespace locograph
