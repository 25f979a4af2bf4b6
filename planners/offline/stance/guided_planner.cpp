#include <locograph/common/uniform.h>
#include <locograph/planners/offline/stance/guided_planner.h>
#include <locograph/planners/offline/stance/plan_stances.h>
#include <locograph/planners/offline/stance/stance_tree.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <random>
#include <unordered_map>

namespace locograph {
namespace {

constexpr double kGreed = 3.0, kNoise = 4.0, kUnlikely = 4.0, kFailedHere = 1.0, kCrowded = 2.0,
                 kLater = 6.0;
constexpr int kFirstTree = 75, kMostMoves = 40, kMostDeadEnds = 20, kLiftRestarts = 4,
              kLaterRestarts = 2, kStandAttempts = 4;
/// Trees that look around: some moves more of each end effector, more transitions; how little the
/// length of the way counts.
constexpr int kMoreAround = 10;
constexpr double kLookAroundLonger = 16.0, kLengthAround = 0.2;
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
  Footing aim;              ///< where its moves lead to
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

/// Grown from the start or, since a transition serves both ways, backwards from the goal.
struct Tree {
  bool backwards = false;
  std::vector<Node> nodes;
  std::priority_queue<Move> ahead;   ///< moves by how near they come to where they lead
  std::priority_queue<Move> around;  ///< the same moves by how new what they come to is
  std::unordered_map<Footing, int, FootingHash> known;            ///< the node of each footing
  std::unordered_map<std::vector<int>, int, FootingHash> crowds;  ///< nodes of each rough footing
};

class GuidedSearch {
 public:
  GuidedSearch(StanceSpace& space, const StancePlannerOptions& options, StancePlan& result)
      : space_(space),
        result_(result),
        kept_{{space, options, result}, {space, options, result}},
        random_(options.seed),
        experience_(space) {}

  /// Appends the way to the goal; false if there is none.
  bool reach(const Footing& goal, StancePath& path) {
    goal_ = goal;
    goal_posture_.reset();
    double most = kFirstTree;
    int tree = 0, dead_ends = 0;
    while (!space_.ended()) {
      choose_manner(tree++, path.configurations.back());
      const int budget = static_cast<int>(look_around_ ? kLookAroundLonger * most : most);
      grow_until_ = space_.transitions + std::min(budget, space_.transitions_left());
      const bool found = grow(path.footings.back(), path.configurations.back());
      if (found) {
        trace(path);
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
    const int wanted = (*aim_)[static_cast<std::size_t>(effector)];
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
    const int number = static_cast<int>(own_->nodes.size());
    own_->known.emplace(footing, number);
    own_->nodes.push_back({std::move(footing), std::move(configuration), parent, stances, start_,
                           std::vector<int>(effectors, 0), std::vector<Eigen::VectorXd>(effectors),
                           std::vector<signed char>(effectors, 0)});
    Node& node = own_->nodes.back();
    if (own_->backwards && !from_both_ends_) return number;  // the goal, which others aim at
    ++result_.vertices_in_tree;
    ++own_->crowds[roughly(node.footing)];
    kept().add(node.footing, parent);
    if (!own_->backwards) note_best(result_, space_, node.footing, goal_);
    choose_aim(node);
    if (!other_->known.contains(node.footing)) push_moves(number);
    return number;
  }

  /// A node leads to what is nearest in the other tree.
  void choose_aim(Node& node) {
    locate(node);
    const Node* nearest = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const Node& there : other_->nodes) {
      measure(node, there.footing);
      double far = there.stances;
      for (const double to_go : to_go_of_node_) far += kGreed * 2.0 * to_go;
      if (far >= least) continue;
      least = far;
      nearest = &there;
    }
    if (nearest != nullptr) node.aim = nearest->footing;
  }

  /// Where the end effectors are in a node.
  void locate(const Node& node) {
    positions_.clear();
    for (int e = 0; e < space_.effectors(); ++e) {
      positions_.push_back(position(node, e, node.footing[static_cast<std::size_t>(e)]));
    }
  }

  /// The moves that each end effector has to go, from the node that was located.
  void measure(const Node& node, const Footing& aim) {
    aim_ = &aim;
    to_go_of_node_.clear();
    for (int e = 0; e < space_.effectors(); ++e) {
      const std::size_t k = static_cast<std::size_t>(e);
      to_go_of_node_.push_back(moves_to_go(e, node.footing[k], positions_[k]));
    }
  }

  /// Of the node that was located last.
  void push_moves(int number) {
    const Node& node = own_->nodes[static_cast<std::size_t>(number)];
    measure(node, node.aim);
    if (number == 0) first_to_go_ = to_go_of_node_;
    for (int e = 0; e < space_.effectors(); ++e) {
      const std::size_t k = static_cast<std::size_t>(e);
      const int now = node.footing[k], wanted = node.aim[k];
      // What was moved last is not moved again at once.
      if (node.parent >= 0 && now != kFree &&
          own_->nodes[static_cast<std::size_t>(node.parent)].footing[k] != now) {
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
        // Where the other tree is already, nothing is left to go.
        const bool meets = from_both_ends_ && other_->known.contains(with(node.footing, e, place));
        const double all_to_go = meets ? 0.0 : others + to_go;
        const double plain = node.stances + cost + kGreed * 2.0 * all_to_go +
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
      std::size_t kept = std::min<std::size_t>(moves_.size(), kMostMoves);
      std::partial_sort(moves_.begin(), moves_.begin() + static_cast<std::ptrdiff_t>(kept),
                        moves_.end(), [](const Move& a, const Move& b) { return a.f < b.f; });
      // Some of the others too, for those that look around.
      const std::size_t most =
          look_around_ ? std::min<std::size_t>(moves_.size(), kept + kMoreAround) : kept;
      for (; kept < most; ++kept) {
        const double drawn = uniform(random_, 0.0, static_cast<double>(moves_.size() - kept));
        const std::size_t other = kept + static_cast<std::size_t>(drawn);
        std::swap(moves_[kept], moves_[std::min(moves_.size() - 1, other)]);
      }
      for (std::size_t i = 0; i < kept; ++i) push(moves_[i]);
    }
  }

  void push(Move move) {
    move.number = static_cast<long>(followed_.size());
    followed_.push_back(false);
    own_->ahead.push(move);
    if (!look_around_) return;
    move.f = newness(move);
    own_->around.push(move);
  }

  /// Trees differ: in how long moves are and how evenly end effectors move, and whether they are
  /// grown from both ends.
  void choose_manner(int tree, const Eigen::VectorXd& q) {
    constexpr struct {
      double reach_share, uneven;
      bool from_both_ends, look_around;
    } kManners[] = {{0.5, 8.0, false, false}, {1.0, 0.0, true, false},  {0.7, 4.0, false, false},
                    {0.5, 0.0, true, false},  {0.4, 4.0, false, false}, {1.0, 0.0, true, true}};
    const auto& manner = kManners[tree % 6];
    reach_share_ = manner.reach_share;
    uneven_ = manner.uneven;
    from_both_ends_ = manner.from_both_ends && stand_at_goal(q);
    look_around_ = manner.look_around && from_both_ends_;
  }

  /// Whether there is a posture at the goal; looked for once for each goal.
  bool stand_at_goal(const Eigen::VectorXd& q) {
    for (int attempt = 0; attempt < kStandAttempts && !goal_posture_; ++attempt) {
      StanceSpace::Attempt stand = space_.stand(space_.stance(goal_), q, attempt);
      if (stand.found || attempt + 1 == kStandAttempts) goal_posture_ = std::move(stand);
    }
    return goal_posture_->found;
  }

  /// How much further some end effectors are on their way than others: those far ahead hold the
  /// others back.
  double unevenness() const {
    if (uneven_ == 0.0) return 0.0;
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
    const Node& node = own_->nodes[static_cast<std::size_t>(move.node)];
    return move.plain + kUnlikely * unlikelihood(move) +
           kFailedHere * node.failed[static_cast<std::size_t>(move.effector)] +
           kCrowded * crowd(with(node.footing, move.effector, move.place));
  }

  /// Nodes whose contacts are roughly where these are: hundreds of ways to put the hands must not
  /// keep the feet waiting.
  int crowd(const Footing& footing) const {
    const auto found = own_->crowds.find(roughly(footing));
    return found == own_->crowds.end() ? 0 : found->second;
  }

  /// As promise(), whatever the way to go: the least for what is unlike the nodes there are.
  double newness(const Move& move) const {
    const Node& node = own_->nodes[static_cast<std::size_t>(move.node)];
    return kLengthAround * node.stances + (move.restarts > 0 ? kLater : 0.0) + unlikelihood(move) +
           kFailedHere * node.failed[static_cast<std::size_t>(move.effector)] +
           kCrowded * crowd(with(node.footing, move.effector, move.place));
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
    const Node& node = own_->nodes[static_cast<std::size_t>(move.node)];
    return experience_.unlikelihood(node.footing, move.effector, move.place, move.share);
  }

  StanceTree& kept() { return kept_[own_->backwards ? 1 : 0]; }

  void take_turn(bool backwards) {
    own_ = &trees_[backwards ? 1 : 0];
    other_ = &trees_[backwards ? 0 : 1];
  }

  /// Whether the trees meet, at met_. exhausted_: there is nothing left to try.
  bool grow(const Footing& start, const Eigen::VectorXd& q) {
    trees_[0] = {};
    trees_[1] = {};
    trees_[1].backwards = true;
    followed_.clear();
    exhausted_ = false;
    start_ = met_ = start;
    take_turn(true);
    add(goal_, from_both_ends_ ? goal_posture_->configuration : q, -1, 0);
    take_turn(false);
    add(start, q, -1, 0);
    if (start == goal_) return true;
    for (int turn = 0; !trees_[0].ahead.empty() || !trees_[1].ahead.empty(); ++turn) {
      if (space_.ended() || space_.transitions >= grow_until_) return false;
      take_turn(from_both_ends_ && turn % 2 == 1);
      const bool around = look_around_ && turn / 2 % 2 == 1;
      const int reached = follow_best(around);
      if (reached < 0) continue;
      met_ = own_->nodes[static_cast<std::size_t>(reached)].footing;
      if (other_->known.contains(met_)) return true;
    }
    exhausted_ = true;
    return false;
  }

  /// The node that the best move leads to; -1: none.
  int follow_best(bool around) {
    std::priority_queue<Move>& queue = around ? own_->around : own_->ahead;
    while (!queue.empty()) {
      Move move = queue.top();
      queue.pop();
      if (followed_[static_cast<std::size_t>(move.number)]) continue;
      move.f = around ? newness(move) : promise(move);
      if (!queue.empty() && queue.top().f < move.f) {
        queue.push(move);
        continue;
      }
      followed_[static_cast<std::size_t>(move.number)] = true;
      return follow(move);
    }
    return -1;
  }

  /// The path goes from the start to the goal, whichever way the tree grows.
  StanceSpace::Attempt try_transition(const Footing& from, const Footing& to,
                                      const Eigen::VectorXd& q, int restarts) {
    return own_->backwards ? space_.try_transition(to, from, q, restarts)
                           : space_.try_transition(from, to, q, restarts);
  }

  int follow(const Move& move) {
    const std::size_t effector = static_cast<std::size_t>(move.effector);
    Node& node = own_->nodes[static_cast<std::size_t>(move.node)];
    const Footing after = with(node.footing, move.effector, move.place);
    if (own_->known.contains(after)) return -1;
    ++result_.iterations;
    const bool in_contact = node.footing[effector] != kFree;
    const Footing between = without(node.footing, move.effector);
    if (in_contact) {
      Eigen::VectorXd& lifted = node.lifted[effector];
      signed char& tried = node.lift_tried[effector];
      if (tried <= move.restarts && lifted.size() == 0) {
        StanceSpace::Attempt lift = try_transition(node.footing, between, node.configuration,
                                                   tried == 0 ? kLiftRestarts : 5 * move.restarts);
        tried = static_cast<signed char>(move.restarts + 1);
        if (lift.found) {
          lifted = std::move(lift.configuration);
        } else {
          kept().add_failed(between, move.node);
        }
      }
      if (lifted.size() == 0) {
        again(move);
        return -1;
      }
    }
    const Eigen::VectorXd& start = in_contact ? node.lifted[effector] : node.configuration;
    if (move.place == kFree) return add(after, start, move.node, node.stances + 1);
    StanceSpace::Attempt put = try_transition(between, after, start, move.restarts);
    experience_.learn(node.footing, move.effector, move.place, move.share, put.found);
    if (!put.found) {
      kept().add_failed(after, move.node);
      again(move);
      return -1;
    }
    return add(after, std::move(put.configuration), move.node, node.stances + (in_contact ? 2 : 1));
  }

  /// A failed move is tried once more, later and harder.
  void again(Move move) {
    ++own_->nodes[static_cast<std::size_t>(move.node)]
          .failed[static_cast<std::size_t>(move.effector)];
    if (move.restarts > 0) return;
    move.restarts = kLaterRestarts;
    move.plain += kLater;
    move.f = promise(move);
    push(move);
  }

  /// The numbers of the nodes from where the trees met to the root.
  std::vector<int> way_to_root(const Tree& tree) const {
    std::vector<int> way;
    for (int n = tree.known.at(met_); n >= 0; n = tree.nodes[static_cast<std::size_t>(n)].parent) {
      way.push_back(n);
    }
    return way;
  }

  /// From the start to where the trees met, and from there to the goal.
  void trace(StancePath& path) {
    std::vector<int> way = way_to_root(trees_[0]);
    std::reverse(way.begin(), way.end());
    append(0, way, path);
    append(1, way_to_root(trees_[1]), path);
  }

  /// What comes behind the first node of a way through a tree. The parent has the configuration in
  /// which its end effector is lifted, the child the one in which it is put down; from the goal the
  /// way leads from child to parent.
  void append(std::size_t tree, const std::vector<int>& way, StancePath& path) {
    if (tree == 0 || from_both_ends_) {
      for (const int n : way) kept_[tree].mark(n);
    }
    for (std::size_t i = 1; i < way.size(); ++i) {
      const Node& before = trees_[tree].nodes[static_cast<std::size_t>(way[i - 1])];
      const Node& after = trees_[tree].nodes[static_cast<std::size_t>(way[i])];
      const Node &parent = tree == 0 ? before : after, &child = tree == 0 ? after : before;
      const int moved = changed_effector(before.footing, after.footing);
      const std::size_t e = static_cast<std::size_t>(moved);
      if (before.footing[e] == kFree || after.footing[e] == kFree) {
        path.append(after.footing, child.configuration);
        continue;
      }
      const Eigen::VectorXd &lifted = parent.lifted[e], &put = child.configuration;
      path.append(without(before.footing, moved), tree == 0 ? lifted : put);
      path.append(after.footing, tree == 0 ? put : lifted);
    }
  }

  StanceSpace& space_;
  StancePlan& result_;
  StanceTree kept_[2];  ///< of each of trees_
  std::mt19937_64 random_;
  Experience experience_;
  Footing start_, goal_, met_;
  std::optional<StanceSpace::Attempt> goal_posture_;
  Tree trees_[2];  ///< from the start; from the goal, only the goal if not from_both_ends_
  Tree *own_ = nullptr, *other_ = nullptr;  ///< the one that grows, and the one it is to meet
  const Footing* aim_ = nullptr;            ///< what moves_to_go() is about; measure() sets it
  std::vector<bool> followed_;              ///< moves, by their numbers
  std::vector<Move> moves_;
  std::vector<Eigen::Vector3d> positions_;  ///< locate() gives them
  std::vector<double> to_go_of_node_;       ///< measure() gives them
  std::vector<double> to_go_, first_to_go_;
  double uneven_ = 0.0, reach_share_ = 0.0;  ///< choose_manner() sets them for each tree
  bool from_both_ends_ = false, look_around_ = false;
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
