#include <locograph/common/uniform.h>
#include <locograph/planners/offline/stance/experience.h>
#include <locograph/planners/offline/stance/guided_planner.h>
#include <locograph/planners/offline/stance/guided_tree.h>
#include <locograph/planners/offline/stance/stance_search.h>
#include <locograph/planners/offline/stance/stance_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace locograph {
namespace {

constexpr double kGreed = 3.0, kNoise = 4.0, kUnlikely = 4.0, kFailedHere = 1.0, kCrowded = 2.0,
                 kLater = 6.0;
/// What an unlikely lift counts, by promise and by newness, where torques are limited.
constexpr double kTooHeavy = 8.0, kTooHeavyAround = 2.0;
constexpr int kFirstTree = 75, kMostMoves = 40, kMostDeadEnds = 20, kLiftRestarts = 4,
              kLaterRestarts = 2, kStandAttempts = 4;
/// Trees that look around: some moves more of each end effector, more transitions; how little the
/// length of the way counts.
constexpr int kMoreAround = 10;
constexpr double kLookAroundLonger = 7.0, kLengthAround = 0.2;
/// An execution margin leaves less room: few manners of trees find a way then, and soon or never.
constexpr double kTreeGrowth = 1.25, kTreeGrowthInMargin = 1.05;
/// Of trees of all other manners, for each of those that look around.
constexpr int kRounds = 3;
/// Moves that are looked at for other threads, and how many of them for each thread are expected.
constexpr int kLookedAt = 32, kExpected = 3;
/// Of its reach, what an end effector gets ahead in a move on average.
constexpr double kUsualShare = 0.7;
/// Of its reach: how far apart contacts of an end effector are that count as roughly the same.
constexpr double kRoughShare = 0.3;

class GuidedSearch final : public StanceSearch {
 public:
  GuidedSearch(const Task& task, const StancePlannerOptions& options)
      : StanceSearch(task, options),
        kept_{{space_, options, result_}, {space_, options, result_}},
        random_(options.seed),
        experience_(space_) {}

 private:
  using Tree = GuidedTree;
  using Node = GuidedTree::Node;
  using Move = GuidedTree::Move;
  using Transition = StanceSpace::Expected;
  using Chain = std::vector<Transition>;

  bool reach(const Footing& goal, StancePath& path) override {
    goal_ = goal;
    goal_posture_.reset();
    const bool in_margin = space_.task().margin != ExecutionMargin::none();
    double most = kFirstTree;
    int tree = 0, dead_ends = 0;
    while (!space_.ended()) {
      choose_manner(tree++, path.configurations.back());
      const int budget = static_cast<int>(look_around_ ? kLookAroundLonger * most : most);
      grow_until_ = space_.transitions + std::min(budget, space_.transitions_left());
      if (grow(path.footings.back(), path.configurations.back())) {
        trace(path);
        return true;
      }
      // Other noise, other moves; but not for ever where there are none.
      if (exhausted_ && ++dead_ends >= kMostDeadEnds) return false;
      if (space_.tried_enough()) return false;
      most *= in_margin ? kTreeGrowthInMargin : kTreeGrowth;
    }
    return false;
  }

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
                           std::vector<signed char>(effectors, 0), false});
    Node& node = own_->nodes.back();
    if (own_->backwards && !from_both_ends_) return number;  // the goal, which others aim at
    ++result_.statistics.vertices_in_tree;
    ++own_->crowds[roughly(node.footing)];
    kept().add(node.footing, parent);
    if (!own_->backwards) note_best(node.footing, goal_);
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
      if (there.cut) continue;
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
  /// grown from both ends. What was learned of moves is forgotten now and then: by bad luck it
  /// keeps a search from moves that it needs.
  void choose_manner(int tree, const Eigen::VectorXd& q) {
    struct Manner {
      double reach_share, uneven;
      bool from_both_ends, look_around;
    };
    constexpr Manner kManners[] = {{0.5, 8.0, false, false},
                                   {1.0, 0.0, true, false},
                                   {0.7, 4.0, false, false},
                                   {0.5, 0.0, true, false},
                                   {0.4, 4.0, false, false}};
    constexpr Manner kAround = {1.0, 0.0, true, true};
    constexpr int kCount = static_cast<int>(std::size(kManners)), kLast = kRounds * kCount;
    const int turn = tree % (kLast + 1);
    if (tree > 0 && turn % kCount == 0 && turn < kLast) experience_.forget_moves();
    // Where lifts are too heavy, ways lead round about.
    const bool around = turn == kLast || (too_heavy_ && turn > kCount && turn % 2 == 0);
    const Manner& manner = around ? kAround : kManners[turn % kCount];
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
    return move.plain + kUnlikely * unlikelihood(move) + kTooHeavy * lifts_unlikely(move) +
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
           kTooHeavyAround * lifts_unlikely(move) +
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

  /// Of this lift, and then of those that are still to come where the move leads to.
  double lifts_unlikely(const Move& move) const {
    if (!too_heavy_) return 0.0;
    const Node& node = own_->nodes[static_cast<std::size_t>(move.node)];
    const Footing after = with(node.footing, move.effector, move.place);
    double sum =
        own_->to_be_lifted(move) ? experience_.lift_unlikelihood(node.footing, move.effector) : 0.0;
    for (std::size_t e = 0; e < after.size(); ++e) {
      const int effector = static_cast<int>(e);
      if (effector == move.effector || after[e] == kFree || after[e] == node.aim[e]) continue;
      sum += experience_.lift_unlikelihood(after, effector);
    }
    return sum;
  }

  StanceTree& kept() { return kept_[own_->backwards ? 1 : 0]; }

  void take_turn(bool backwards) {
    own_ = &trees_[backwards ? 1 : 0];
    other_ = &trees_[backwards ? 0 : 1];
  }

  /// Whether the start's tree comes to the goal. exhausted_: there is nothing left to try.
  bool grow(const Footing& start, const Eigen::VectorXd& q) {
    trees_[0] = {};
    trees_[1] = {};
    trees_[1].backwards = true;
    space_.expect_nothing();
    followed_.clear();
    exhausted_ = false;
    start_ = start;
    take_turn(true);
    add(goal_, from_both_ends_ ? goal_posture_->configuration : q, -1, 0);
    take_turn(false);
    add(start, q, -1, 0);
    if (start == goal_) return true;
    for (turn_ = 0; !trees_[0].ahead.empty() || !trees_[1].ahead.empty(); ++turn_) {
      if (space_.ended() || space_.transitions >= grow_until_) return false;
      take_turn(backwards_at(turn_));
      const int reached = follow_best(around_at(turn_));
      if (reached < 0) continue;
      const Footing& footing = own_->nodes[static_cast<std::size_t>(reached)].footing;
      if (other_->known.contains(footing) && join(Footing(footing))) return true;
    }
    exhausted_ = true;
    return false;
  }

  /// Where the trees have met, the start's goes on to the goal along the other one, in which balls
  /// are where they touch down: here they roll. False: they do not come to one of its nodes; what
  /// leads there is cut from the goal's tree.
  bool join(const Footing& met) {
    const bool has_moves = own_->backwards;  // the start's node was there before
    take_turn(false);
    const std::vector<int> way = trees_[1].way_to_root(met);
    std::vector<int> rolled = {own_->known.at(met)};
    for (std::size_t i = 1; i < way.size(); ++i) {
      const int next = roll_along(rolled.back(), way[i - 1], way[i]);
      if (next >= 0) {
        rolled.push_back(next);
        continue;
      }
      trees_[1].cut_off(way[i - 1]);
      for (std::size_t k = has_moves ? 1 : 0; k < rolled.size(); ++k) {
        choose_aim(own_->nodes[static_cast<std::size_t>(rolled[k])]);
        push_moves(rolled[k]);
      }
      return false;
    }
    return true;
  }

  /// The node of the start's tree that comes after one, as from child to parent in the goal's; -1:
  /// not found.
  int roll_along(int number, int child, int parent) {
    const Node &before = trees_[1].nodes[static_cast<std::size_t>(child)],
               &after = trees_[1].nodes[static_cast<std::size_t>(parent)];
    Node& node = own_->nodes[static_cast<std::size_t>(number)];
    const int moved = changed_effector(before.footing, after.footing);
    const std::size_t e = static_cast<std::size_t>(moved);
    const bool lifts = before.footing[e] != kFree && after.footing[e] != kFree;
    Footing between = before.footing;
    Eigen::VectorXd q = node.configuration, put = before.configuration;
    if (lifts) {
      between[e] = kFree;
      // Others may have rolled on from where it was lifted already.
      if (node.lifted[e].size() == 0) {
        if (!roll_to(space_, before.footing, between, q, put)) return -1;
        node.lifted[e] = put;
      }
      q = node.lifted[e];
      put = after.lifted[e];
    }
    if (!roll_to(space_, between, after.footing, q, put)) return -1;
    return add(after.footing, std::move(put), number, node.stances + (lifts ? 2 : 1));
  }

  bool backwards_at(int turn) const { return from_both_ends_ && turn % 2 == 1; }
  bool is_cut(const Move& move) const {
    return own_->nodes[static_cast<std::size_t>(move.node)].cut;
  }
  bool around_at(int turn) const { return look_around_ && turn / 2 % 2 == 1; }

  /// The node that the best move leads to; -1: none.
  int follow_best(bool around) {
    OpenQueue<Move>& queue = around ? own_->around : own_->ahead;
    while (!queue.empty()) {
      Move move = queue.top();
      queue.pop();
      if (followed_[static_cast<std::size_t>(move.number)] || is_cut(move)) continue;
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

  /// The path goes from the start to the goal, whichever way the tree grows. From the goal, balls
  /// are taken to be where they touch down: how they roll, join() finds.
  StanceSpace::Attempt try_transition(const Footing& from, const Footing& to,
                                      const Eigen::VectorXd& q, int restarts, const Move& move) {
    look_ahead(move);
    return own_->backwards ? space_.try_transition(to, from, q, restarts)
                           : space_.try_transition(from, to, q, restarts, &q);
  }

  /// While a transition of this move is worked out, other threads begin with those of the moves
  /// that come next if it fails.
  void look_ahead(const Move& now) {
    if (space_.threads() < 2) return;
    const bool backwards = own_->backwards;
    const std::vector<Chain> next = likely_at(turn_ + 1, now);
    const std::vector<Chain> later =
        from_both_ends_ ? likely_at(turn_ + 2, now) : std::vector<Chain>();
    take_turn(backwards);
    std::vector<Chain> expected;
    for (std::size_t i = 0; i < std::max(next.size(), later.size()); ++i) {
      if (i < next.size()) expected.push_back(next[i]);
      if (i < later.size()) expected.push_back(later[i]);
    }
    space_.expect(expected);
  }

  /// Takes that turn.
  std::vector<Chain> likely_at(int turn, const Move& now) {
    const Tree& growing = trees_[backwards_at(turn_) ? 1 : 0];
    take_turn(backwards_at(turn));
    const bool around = around_at(turn);
    moves_.clear();
    (around ? own_->around : own_->ahead).look(kLookedAt, [&](Move move) {
      if (followed_[static_cast<std::size_t>(move.number)] || is_cut(move)) return;
      move.f = around ? newness(move) : promise(move);
      if (own_ == &growing && move.node == now.node && move.effector == now.effector) {
        if (own_->to_be_lifted(move)) return;  // that is being tried
        move.f += kFailedHere;
      }
      moves_.push_back(move);
    });
    std::sort(moves_.begin(), moves_.end(), [](const Move& a, const Move& b) { return b < a; });
    std::vector<Chain> chains;
    for (const Move& move : moves_) {
      Chain chain = transitions_of(move);
      if (!chain.empty()) chains.push_back(std::move(chain));
      if (chains.size() >= static_cast<std::size_t>(kExpected * space_.threads())) break;
    }
    return chains;
  }

  /// Those that follow() would ask for.
  Chain transitions_of(const Move& move) const {
    const std::size_t effector = static_cast<std::size_t>(move.effector);
    const Node& node = own_->nodes[static_cast<std::size_t>(move.node)];
    const Footing between = without(node.footing, move.effector);
    const Footing after = with(node.footing, move.effector, move.place);
    if (own_->known.contains(after)) return {};
    Chain chain;
    if (own_->to_be_lifted(move)) {
      const signed char tried = node.lift_tried[effector];
      if (tried > move.restarts) return {};
      chain.push_back({node.footing, between, node.configuration, lift_restarts(move, tried),
                       &node.configuration});
    }
    if (move.place != kFree) {
      const bool in_contact = node.footing[effector] != kFree;
      const Eigen::VectorXd& start = in_contact ? node.lifted[effector] : node.configuration;
      chain.push_back(
          {between, after, start, move.restarts, start.size() > 0 ? &start : &node.configuration});
    }
    if (own_->backwards) {
      for (Transition& one : chain) {
        std::swap(one.from, one.to);
        one.before = nullptr;
      }
    }
    return chain;
  }

  static int lift_restarts(const Move& move, signed char tried) {
    return tried == 0 ? kLiftRestarts : 5 * move.restarts;
  }

  int follow(const Move& move) {
    const std::size_t effector = static_cast<std::size_t>(move.effector);
    Node& node = own_->nodes[static_cast<std::size_t>(move.node)];
    const Footing after = with(node.footing, move.effector, move.place);
    if (own_->known.contains(after)) return -1;
    ++space_.iterations;
    const bool in_contact = node.footing[effector] != kFree;
    const Footing between = without(node.footing, move.effector);
    if (in_contact) {
      Eigen::VectorXd& lifted = node.lifted[effector];
      signed char& tried = node.lift_tried[effector];
      if (tried <= move.restarts && lifted.size() == 0) {
        StanceSpace::Attempt lift = try_transition(node.footing, between, node.configuration,
                                                   lift_restarts(move, tried), move);
        tried = static_cast<signed char>(move.restarts + 1);
        const bool too_heavy = lift.failure == TransitionFailure::kTorque;
        too_heavy_ = too_heavy_ || too_heavy;
        if (lift.found || too_heavy) {
          experience_.learn_lift(node.footing, move.effector, lift.found);
        }
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
    StanceSpace::Attempt put = try_transition(between, after, start, move.restarts, move);
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

  /// From the start to the goal.
  void trace(StancePath& path) {
    std::vector<int> way = trees_[0].way_to_root(goal_);
    std::reverse(way.begin(), way.end());
    for (const int n : way) kept_[0].mark(n);
    trees_[0].append(way, path);
  }

  StanceTree kept_[2];  ///< of each of trees_
  std::mt19937_64 random_;
  Experience experience_;
  Footing start_, goal_;
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
  bool too_heavy_ = false;  ///< torques have refused a lift
  int grow_until_ = 0, turn_ = 0;
  bool exhausted_ = false;
};

}  // namespace

const std::string& GuidedPlanner::name() const {
  static const std::string own = "guided";
  return own;
}

std::unique_ptr<StanceSearch> GuidedPlanner::begin(const Task& task,
                                                   const StancePlannerOptions& options) const {
  return std::make_unique<GuidedSearch>(task, options);
}

}  // namespace locograph
