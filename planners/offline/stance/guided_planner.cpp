#include <locograph/common/uniform.h>
#include <locograph/planners/offline/stance/guided_planner.h>
#include <locograph/planners/offline/stance/plan_stances.h>
#include <locograph/planners/offline/stance/stance_tree.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <random>
#include <unordered_map>
#include <unordered_set>

namespace locograph {
namespace {

constexpr double kGreed = 3.0, kNoise = 4.0, kUnlikely = 4.0, kFailedHere = 1.0, kCrowded = 2.0,
                 kLater = 6.0;
constexpr int kFirstTree = 75, kMostMoves = 40, kMostDeadEnds = 20, kLiftRestarts = 4,
              kLaterRestarts = 2;
constexpr double kTreeGrowth = 1.25;
/// Of its reach, what an end effector gets ahead in a move on average.
constexpr double kUsualShare = 0.7;
/// Of its reach: how far apart contacts of an end effector are that count as roughly the same.
constexpr double kRoughShare = 0.3;

/// How often moves like one were found: of the same length; to the same side of the same other
/// contact.
class Experience {
 public:
  explicit Experience(const StanceSpace& space) : space_(space) {}

  void learn(const Footing& footing, int effector, int place, double share, bool found) {
    each_likeness(footing, effector, place, share, [&](std::uint64_t likeness) {
      Count& count = counts_[likeness];
      count.tried += 1.0;
      if (found) count.found += 1.0;
    });
  }
  /// Minus the logarithm of the share found of moves like this, where that is least.
  double unlikelihood(const Footing& footing, int effector, int place, double share) const {
    double least = 1.0;
    each_likeness(footing, effector, place, share, [&](std::uint64_t likeness) {
      const auto known = counts_.find(likeness);
      if (known == counts_.end()) return;
      least = std::min(least, known->second.found / known->second.tried);
    });
    return -std::log(least);
  }

 private:
  struct Count {
    double tried = 2.0, found = 1.8;  ///< before anything is known
  };

  template <class F>
  void each_likeness(const Footing& footing, int effector, int place, double share, F&& f) const {
    constexpr double kLength = 0.125, kSide_m = 0.15;
    f(static_cast<std::uint64_t>(effector) << 32 |
      static_cast<std::uint64_t>(std::floor(share / kLength)));
    const Eigen::Vector3d& at = space_.place(place).bearing.contact.position;
    for (std::size_t o = 0; o < footing.size(); ++o) {
      if (static_cast<int>(o) == effector || footing[o] == kFree) continue;
      const Eigen::Vector3d off = at - space_.place(footing[o]).bearing.contact.position;
      std::uint64_t key = 1 + static_cast<std::uint64_t>(effector) * footing.size() + o;
      for (int i = 0; i < 3; ++i) {
        key = key << 16 | (static_cast<std::uint64_t>(std::floor(off[i] / kSide_m)) & 0xffff);
      }
      f(key);
    }
  }

  const StanceSpace& space_;
  std::unordered_map<std::uint64_t, Count> counts_;
};

struct Node {
  Footing footing;
  Eigen::VectorXd configuration;
  int parent;  ///< -1: the root
  int stances;
  std::vector<int> failed;  ///< of each end effector: moves from here
  /// Of each end effector in contact: the configuration with it lifted, once it was tried.
  std::vector<Eigen::VectorXd> lifted;
  std::vector<signed char> lift_tried;
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

class GuidedSearch {
 public:
  GuidedSearch(StanceSpace& space, const StancePlannerOptions& options, StancePlan& result)
      : space_(space),
        result_(result),
        tree_(space, options, result),
        random_(options.seed),
        experience_(space) {}

  /// Appends the way to the goal; false if there is none.
  bool reach(const Footing& goal, StancePath& path) {
    goal_ = goal;
    double most = kFirstTree;
    int tree = 0, dead_ends = 0;
    while (!space_.ended()) {
      choose_manner(tree++);
      grow_until_ =
          space_.transitions + std::min(static_cast<int>(most), space_.transitions_left());
      const int found = grow(path.footings.back(), path.configurations.back());
      if (found >= 0) {
        trace(found, path);
        return true;
      }
      // Other noise, other moves; but not for ever where there are none.
      if (exhausted_ && ++dead_ends >= kMostDeadEnds) return false;
      if (space_.tried_enough()) return false;
      most *= kTreeGrowth;
    }
    return false;
  }

 private:
  double moves_to_go(int effector, int place, const Eigen::Vector3d& at) const {
    const int wanted = goal_[static_cast<std::size_t>(effector)];
    if (wanted == place) return 0.0;
    if (wanted == kFree) return 0.5;
    const Eigen::Vector3d& there = space_.place(wanted).bearing.contact.position;
    const double usual = kUsualShare * reach_share_ * space_.reach_m(effector);
    const double far = (there - at).norm() / usual;
    return std::max(1.0, far) * (place == kFree ? 0.5 + 0.5 * std::min(1.0, far) : 1.0);
  }

  Eigen::Vector3d position(const Node& node, int effector, int place) {
    if (place != kFree) return space_.place(place).bearing.contact.position;
    return space_.position(effector, node.configuration);
  }

  int add(Footing footing, Eigen::VectorXd configuration, int parent, int stances) {
    const std::size_t effectors = footing.size();
    nodes_.push_back({std::move(footing), std::move(configuration), parent, stances,
                      std::vector<int>(effectors, 0), std::vector<Eigen::VectorXd>(effectors),
                      std::vector<signed char>(effectors, 0)});
    ++result_.vertices_in_tree;
    tree_.add(nodes_.back().footing, parent);
    const int number = static_cast<int>(nodes_.size()) - 1;
    ++crowds_[roughly(nodes_.back().footing)];
    note_best(result_, space_, nodes_.back().footing, goal_);
    if (nodes_.back().footing != goal_) push_moves(number);
    return number;
  }

  /// Where the end effectors are in a node, and the moves that each has to go.
  void locate(const Node& node) {
    positions_.clear();
    to_go_of_node_.clear();
    for (int e = 0; e < space_.effectors(); ++e) {
      const int at = node.footing[static_cast<std::size_t>(e)];
      positions_.push_back(position(node, e, at));
      to_go_of_node_.push_back(moves_to_go(e, at, positions_.back()));
    }
  }

  void push_moves(int number) {
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    locate(node);
    for (int e = 0; e < space_.effectors(); ++e) {
      const std::size_t k = static_cast<std::size_t>(e);
      const int now = node.footing[k], wanted = goal_[k];
      // What was moved last is not moved again at once.
      if (node.parent >= 0 && now != kFree &&
          nodes_[static_cast<std::size_t>(node.parent)].footing[k] != now) {
        continue;
      }
      to_go_ = to_go_of_node_;
      double others = 0.0;
      for (std::size_t o = 0; o < to_go_.size(); ++o) {
        if (o != k) others += to_go_[o];
      }
      const Eigen::Vector3d from = positions_[k];
      const double reach = reach_share_ * space_.reach_m(e);
      const int cost = now == kFree ? 1 : 2;
      moves_.clear();
      const auto consider = [&](int place) {
        if (place == now) return;
        const Eigen::Vector3d& there = space_.place(place).bearing.contact.position;
        const double to_go = moves_to_go(e, place, there);
        to_go_[k] = to_go;
        const double plain = node.stances + cost + kGreed * 2.0 * (others + to_go) +
                             uneven_ * unevenness() + kNoise * uniform(random_, 0.0, 1.0);
        Move move{plain, plain, (there - from).norm() / space_.reach_m(e), 0, number, e, place, 0};
        move.f = promise(move);
        moves_.push_back(move);
      };
      if (now != kFree && wanted == kFree) {
        to_go_[k] = 0.0;
        const double plain = node.stances + 1 + kGreed * 2.0 * others + uneven_ * unevenness();
        moves_.push_back({plain, plain, 0.0, 0, number, e, kFree, 0});
      }
      if (wanted != kFree && wanted != now &&
          (space_.place(wanted).bearing.contact.position - from).norm() <= reach) {
        consider(wanted);
      }
      for (const int place : space_.places_near(e, from, reach)) {
        if (place != wanted) consider(place);
      }
      const std::size_t kept = std::min<std::size_t>(moves_.size(), kMostMoves);
      std::partial_sort(moves_.begin(), moves_.begin() + static_cast<std::ptrdiff_t>(kept),
                        moves_.end(), [](const Move& a, const Move& b) { return a.f < b.f; });
      for (std::size_t i = 0; i < kept; ++i) {
        moves_[i].number = next_++;
        open_.push(moves_[i]);
      }
    }
  }

  /// Trees differ: in how long moves are and how evenly end effectors move.
  void choose_manner(int tree) {
    constexpr double kReaches[] = {0.5, 0.7, 0.4, 1.0};
    constexpr double kUneven[] = {8.0, 4.0, 4.0, 0.0};
    reach_share_ = kReaches[tree % 4];
    uneven_ = kUneven[tree % 4];
  }

  /// How much further some end effectors are on their way than others: those far ahead hold the
  /// others back.
  double unevenness() const {
    double mean = 0.0, sum = 0.0;
    int moving = 0;
    for (std::size_t e = 0; e < to_go_.size(); ++e) {
      if (!(first_to_go_[e] > 0.0)) continue;
      mean += to_go_[e] / first_to_go_[e];
      ++moving;
    }
    if (moving == 0) return 0.0;
    mean /= moving;
    for (std::size_t e = 0; e < to_go_.size(); ++e) {
      if (first_to_go_[e] > 0.0) sum += std::abs(to_go_[e] / first_to_go_[e] - mean);
    }
    return sum;
  }

  /// What has been learned since makes a move worth less.
  double promise(const Move& move) const {
    const Node& node = nodes_[static_cast<std::size_t>(move.node)];
    return move.plain + kUnlikely * unlikelihood(move) +
           kFailedHere * node.failed[static_cast<std::size_t>(move.effector)] +
           kCrowded * crowd(with(node.footing, move.effector, move.place));
  }

  /// Nodes whose contacts are roughly where these are: hundreds of ways to put the hands must not
  /// keep the feet waiting.
  int crowd(const Footing& footing) const {
    const auto found = crowds_.find(roughly(footing));
    return found == crowds_.end() ? 0 : found->second;
  }
  std::vector<int> roughly(const Footing& footing) const {
    std::vector<int> cells;
    for (std::size_t e = 0; e < footing.size(); ++e) {
      if (footing[e] == kFree) {
        cells.push_back(std::numeric_limits<int>::max());
        continue;
      }
      const Eigen::Vector3d& at = space_.place(footing[e]).bearing.contact.position;
      const double cell = kRoughShare * space_.reach_m(static_cast<int>(e));
      for (int i = 0; i < 3; ++i) cells.push_back(static_cast<int>(std::lround(at[i] / cell)));
    }
    return cells;
  }

  double unlikelihood(const Move& move) const {
    if (move.place == kFree) return 0.0;
    const Node& node = nodes_[static_cast<std::size_t>(move.node)];
    return experience_.unlikelihood(node.footing, move.effector, move.place, move.share);
  }

  /// The node that has reached the goal; -1: none. exhausted_: there is nothing left to try.
  int grow(const Footing& start, const Eigen::VectorXd& q) {
    nodes_.clear();
    open_ = {};
    known_.clear();
    crowds_.clear();
    exhausted_ = false;
    known_.insert(start);
    locate({start, q, -1, 0, {}, {}, {}});
    first_to_go_ = to_go_of_node_;
    add(start, q, -1, 0);
    if (start == goal_) return 0;
    while (!open_.empty()) {
      if (space_.ended() || space_.transitions >= grow_until_) return -1;
      Move move = open_.top();
      open_.pop();
      move.f = promise(move);
      if (!open_.empty() && open_.top().f < move.f) {
        open_.push(move);
        continue;
      }
      const int reached = follow(move);
      if (reached >= 0 && nodes_[static_cast<std::size_t>(reached)].footing == goal_) {
        return reached;
      }
    }
    exhausted_ = true;
    return -1;
  }

  int follow(const Move& move) {
    const std::size_t effector = static_cast<std::size_t>(move.effector);
    const std::size_t n = static_cast<std::size_t>(move.node);
    const Footing before = nodes_[n].footing;
    const Footing after = with(before, move.effector, move.place);
    if (known_.contains(after)) return -1;
    ++result_.iterations;
    const bool in_contact = before[effector] != kFree;
    const Footing between = without(before, move.effector);
    Eigen::VectorXd start = nodes_[n].configuration;
    if (in_contact) {
      signed char& tried = nodes_[n].lift_tried[effector];
      if (tried <= move.restarts && nodes_[n].lifted[effector].size() == 0) {
        const StanceSpace::Attempt lift =
            space_.try_transition(before, between, nodes_[n].configuration,
                                  tried == 0 ? kLiftRestarts : 5 * move.restarts);
        tried = static_cast<signed char>(move.restarts + 1);
        if (lift.found) {
          nodes_[n].lifted[effector] = lift.configuration;
        } else {
          tree_.add_failed(between, move.node);
        }
      }
      if (nodes_[n].lifted[effector].size() == 0) {
        again(move);
        return -1;
      }
      start = nodes_[n].lifted[effector];
    }
    if (move.place == kFree) {
      known_.insert(after);
      return add(after, start, move.node, nodes_[n].stances + 1);
    }
    const StanceSpace::Attempt put = space_.try_transition(between, after, start, move.restarts);
    experience_.learn(before, move.effector, move.place, move.share, put.found);
    if (!put.found) {
      tree_.add_failed(after, move.node);
      again(move);
      return -1;
    }
    known_.insert(after);
    return add(after, put.configuration, move.node, nodes_[n].stances + (in_contact ? 2 : 1));
  }

  /// A failed move is tried once more, later and harder.
  void again(Move move) {
    ++nodes_[static_cast<std::size_t>(move.node)].failed[static_cast<std::size_t>(move.effector)];
    if (move.restarts > 0) return;
    move.restarts = kLaterRestarts;
    move.plain += kLater;
    move.f = promise(move);
    move.number = next_++;
    open_.push(move);
  }

  void trace(int node, StancePath& path) {
    std::vector<int> way;
    for (int n = node; n >= 0; n = nodes_[static_cast<std::size_t>(n)].parent) way.push_back(n);
    std::reverse(way.begin(), way.end());
    for (const int n : way) tree_.mark(n);
    for (std::size_t i = 1; i < way.size(); ++i) {
      const Node& before = nodes_[static_cast<std::size_t>(way[i - 1])];
      const Node& after = nodes_[static_cast<std::size_t>(way[i])];
      const int moved = changed_effector(before.footing, after.footing);
      const std::size_t e = static_cast<std::size_t>(moved);
      if (before.footing[e] != kFree && after.footing[e] != kFree) {
        path.append(without(before.footing, moved), before.lifted[e]);
      }
      path.append(after.footing, after.configuration);
    }
  }

  StanceSpace& space_;
  StancePlan& result_;
  StanceTree tree_;
  std::mt19937_64 random_;
  Experience experience_;
  Footing goal_;
  std::vector<Node> nodes_;
  std::priority_queue<Move> open_;
  std::unordered_set<Footing, FootingHash> known_;
  std::unordered_map<std::vector<int>, int, FootingHash> crowds_;  ///< nodes of each rough footing
  std::vector<Move> moves_;
  std::vector<Eigen::Vector3d> positions_;  ///< locate() gives these two
  std::vector<double> to_go_of_node_;
  std::vector<double> to_go_, first_to_go_;
  double uneven_ = 0.0, reach_share_ = 0.0;  ///< choose_manner() sets them for each tree
  long next_ = 0;
  int grow_until_ = 0;
  bool exhausted_ = false;
};

}  // namespace

const std::string& GuidedPlanner::name() const {
  static const std::string own = "guided";
  return own;
}

StancePlan GuidedPlanner::plan(const StanceProblem& problem,
                               const StancePlannerOptions& options) const {
  return plan_with<GuidedSearch>(problem, options);
}

}  // namespace locograph
