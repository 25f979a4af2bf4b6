#include <locograph/common/uniform.h>
#include <locograph/planners/offline/stance/guided_planner.h>
#include <locograph/planners/offline/stance/plan_stances.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <random>
#include <unordered_map>
#include <unordered_set>

namespace locograph {
namespace {

constexpr double kGreed = 3.0, kNoise = 4.0, kUnlikely = 4.0, kFailedHere = 1.0, kLater = 6.0;

constexpr int kFirstTree = 150, kMostMoves = 40, kMostDeadEnds = 20, kLiftRestarts = 4,
              kLaterRestarts = 2;
constexpr double kTreeGrowth = 1.25;
/// Of its reach, what an end effector gets ahead in a move on average.
constexpr double kUsualShare = 0.7;

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
        options_(options),
        result_(result),
        random_(options.seed),
        experience_(space) {}

  /// Appends the way to the goal; false if there is none.
  bool reach(const Footing& goal, StancePath& path) {
    if (goal_ != goal) began_ = space_.transitions;
    goal_ = goal;
    double most = kFirstTree;
    int tree = 0, dead_ends = 0;
    while (!space_.ended()) {
      choose_manner(tree++);
      grow_until_ = space_.transitions + static_cast<int>(most);
      const int limit = options_.max_transitions;
      if (limit > 0) grow_until_ = std::min(grow_until_, began_ + limit);
      const int found = grow(path.footings.back(), path.configurations.back());
      if (found >= 0) {
        trace(found, path);
        return true;
      }
      // Other noise, other moves; but not for ever where there are none.
      if (exhausted_ && ++dead_ends >= kMostDeadEnds) return false;
      if (limit > 0 && space_.transitions - began_ >= limit) return false;
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
    const int number = static_cast<int>(nodes_.size()) - 1;
    note_best(nodes_.back().footing);
    if (nodes_.back().footing != goal_) push_moves(number);
    return number;
  }

  void note_best(const Footing& footing) {
    int reached = 0;
    for (std::size_t e = 0; e < footing.size(); ++e) {
      if (goal_[e] != kFree && footing[e] == goal_[e]) ++reached;
    }
    if (reached <= result_.best_contacts) return;
    result_.best_contacts = reached;
    result_.best = space_.stance(footing);
  }

  void push_moves(int number) {
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    for (int e = 0; e < space_.effectors(); ++e) {
      const std::size_t k = static_cast<std::size_t>(e);
      const int now = node.footing[k], wanted = goal_[k];
      // What was moved last is not moved again at once.
      if (node.parent >= 0 && now != kFree &&
          nodes_[static_cast<std::size_t>(node.parent)].footing[k] != now) {
        continue;
      }
      double others = 0.0;
      to_go_.assign(static_cast<std::size_t>(space_.effectors()), 0.0);
      for (int o = 0; o < space_.effectors(); ++o) {
        if (o == e) continue;
        const int at = node.footing[static_cast<std::size_t>(o)];
        to_go_[static_cast<std::size_t>(o)] = moves_to_go(o, at, position(node, o, at));
        others += to_go_[static_cast<std::size_t>(o)];
      }
      const Eigen::Vector3d from = position(node, e, now);
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
    constexpr double kReaches[] = {0.7, 0.5, 1.0, 0.4};
    constexpr double kUneven[] = {4.0, 8.0, 2.0, 0.0};
    reach_share_ = kReaches[tree % 4];
    uneven_ = kUneven[(tree + tree / 4) % 4];
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
           kFailedHere * node.failed[static_cast<std::size_t>(move.effector)];
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
    exhausted_ = false;
    known_.insert(start);
    first_to_go_.assign(start.size(), 0.0);
    const Node root{start, q, -1, 0, {}, {}, {}};
    for (int e = 0; e < space_.effectors(); ++e) {
      const int at = start[static_cast<std::size_t>(e)];
      first_to_go_[static_cast<std::size_t>(e)] = moves_to_go(e, at, position(root, e, at));
    }
    if (add(start, q, -1, 0) >= 0 && start == goal_) return 0;
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
        if (lift.found) nodes_[n].lifted[effector] = lift.configuration;
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
    const Eigen::Vector3d from = position(nodes_[n], move.effector, before[effector]);
    const double share = (space_.place(move.place).bearing.contact.position - from).norm() /
                         space_.reach_m(move.effector);
    const StanceSpace::Attempt put = space_.try_transition(between, after, start, move.restarts);
    experience_.learn(before, move.effector, move.place, share, put.found);
    if (!put.found) {
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

  void trace(int node, StancePath& path) const {
    std::vector<int> way;
    for (int n = node; n >= 0; n = nodes_[static_cast<std::size_t>(n)].parent) way.push_back(n);
    std::reverse(way.begin(), way.end());
    for (std::size_t i = 1; i < way.size(); ++i) {
      const Node& before = nodes_[static_cast<std::size_t>(way[i - 1])];
      const Node& after = nodes_[static_cast<std::size_t>(way[i])];
      for (std::size_t e = 0; e < before.footing.size(); ++e) {
        if (before.footing[e] == after.footing[e]) continue;
        if (before.footing[e] != kFree && after.footing[e] != kFree) {
          path.append(without(before.footing, static_cast<int>(e)), before.lifted[e]);
        }
      }
      path.append(after.footing, after.configuration);
    }
  }

  StanceSpace& space_;
  const StancePlannerOptions& options_;
  StancePlan& result_;
  std::mt19937_64 random_;
  Experience experience_;
  Footing goal_;
  std::vector<Node> nodes_;
  std::priority_queue<Move> open_;
  std::unordered_set<Footing, FootingHash> known_;
  std::vector<Move> moves_;
  std::vector<double> to_go_, first_to_go_;
  double uneven_ = 6.0, reach_share_ = 1.0;
  long next_ = 0;
  int grow_until_ = 0;
  int began_ = 0;  ///< transitions tried before this goal
  bool exhausted_ = false;
};

}  // namespace

const std::string& GuidedPlanner::name() const {
  static const std::string own = "guided";
  return own;
}

StancePlan GuidedPlanner::plan(const StanceProblem& problem,
                               const StancePlannerOptions& options) const {
  return plan_stances(
      problem, options, [](StanceSpace& space, const StancePlannerOptions& o, StancePlan& result) {
        auto search = std::make_shared<GuidedSearch>(space, o, result);
        return
            [search](const Footing& goal, StancePath& path) { return search->reach(goal, path); };
      });
}

}  // namespace locograph
