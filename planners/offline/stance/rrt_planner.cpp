#include <locograph/common/uniform.h>
#include <locograph/planners/offline/stance/rrt_planner.h>
#include <locograph/planners/offline/stance/stance_search.h>
#include <locograph/planners/offline/stance/stance_tree.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <unordered_map>
#include <unordered_set>

namespace locograph {
namespace {

constexpr double kGoalBias = 0.9;  ///< 1 in the published runs
/// Of what an end effector reaches (StanceSpace::reach_m): how far a contact is put.
constexpr double kReachShare = 0.5;
constexpr double kReachGrowth_m = 0.1;
constexpr int kMostGrowths = 3;
constexpr double kHalvedAfter = 5.0;  ///< attempts at a vertex
constexpr double kFar_m = 5.0;        ///< along each axis, from where the tree begins
constexpr double kNearest_m = 1e-4;   ///< distances below are taken for this one
constexpr int kMostIdle = 5000;       ///< iterations without a transition that was tried
/// Of each time that a step is tried: the same number again would fail again.
constexpr int kRestarts[] = {0, 4, 20};
constexpr int kNobody = -1;

/// Where an end effector is to go.
struct Target {
  int effector;
  std::optional<Eigen::Vector3d> point;  ///< none: off its contact, wherever that is
};

struct Vertex {
  Footing footing;
  Eigen::VectorXd configuration;
  int parent;  ///< -1: the root
  int added;   ///< end effector put down on the way from the parent, or kNobody
  std::vector<Eigen::Vector3d> positions;  ///< of the end effectors
  double weight = 1.0;                     ///< less with each attempt
};

/// What surfaces and bars lie in, but not further than kFar_m from a point.
Eigen::AlignedBox3d box_of_search(const World& world, const Eigen::Vector3d& centre) {
  Eigen::AlignedBox3d box(centre);
  for (const Surface& surface : world.surfaces) {
    const Eigen::Isometry3d& pose = surface.world_from_surface;
    const double most = (pose.translation() - centre).norm() + 2.0 * kFar_m;
    const double x = std::min(surface.half_x_m, most), y = std::min(surface.half_y_m, most);
    for (const double side : {-1.0, 1.0}) {
      box.extend(pose * Eigen::Vector3d(side * x, y, 0.0));
      box.extend(pose * Eigen::Vector3d(side * x, -y, 0.0));
    }
  }
  for (const Bar& bar : world.bars) box.extend(bar.from).extend(bar.to);
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(kFar_m);
  return box.clamp(Eigen::AlignedBox3d(centre - far, centre + far));
}

class RrtSearch final : public StanceSearch {
 public:
  RrtSearch(const Task& task, const StancePlannerOptions& options)
      : StanceSearch(task, options), tree_(space_, options, result_), random_(options.seed) {}

 private:
  bool reach(const Footing& goal, StancePath& path) override {
    begin(goal, path.footings.back(), path.configurations.back());
    if (vertices_.front().footing == goal) return true;
    for (int idle = 0; idle < kMostIdle && !space_.ended();) {
      if (space_.tried_enough()) return false;
      const int tried = space_.transitions;
      const int reached = iterate();
      if (reached >= 0 && vertex(reached).footing == goal_) {
        trace(reached, path);
        return true;
      }
      idle = space_.transitions > tried ? 0 : idle + 1;
    }
    return false;
  }

  void begin(const Footing& goal, const Footing& start, const Eigen::VectorXd& q) {
    goal_ = goal;
    fewest_ = std::max(1, std::min(contacts_of(start), contacts_of(goal)) - 1);
    vertices_.clear();
    known_.clear();
    tries_.clear();
    aims_.clear();
    for (int e = 0; e < space_.effectors(); ++e) {
      const std::size_t k = static_cast<std::size_t>(e);
      if (goal[k] != kFree || start[k] != kFree) aims_.push_back(e);
    }
    add(start, q, -1, kNobody);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    const std::vector<Eigen::Vector3d>& positions = vertices_.front().positions;
    for (const Eigen::Vector3d& position : positions) {
      centre += position / static_cast<double>(positions.size());
    }
    box_ = box_of_search(space_.task().world->world(), centre);
  }

  Vertex& vertex(int number) { return vertices_[static_cast<std::size_t>(number)]; }
  const Vertex& vertex(int number) const { return vertices_[static_cast<std::size_t>(number)]; }
  const Eigen::Vector3d& position_of(int place) const {
    return space_.place(place).bearing.contact.position;
  }

  /// The new vertex, or -1.
  int iterate() {
    ++space_.iterations;
    const Target target = draw_target();
    const int chosen = draw_vertex(target);
    return chosen < 0 ? -1 : expand(chosen, target);
  }

  Target draw_target() {
    if (uniform(random_, 0.0, 1.0) < kGoalBias) {
      const int effector = aims_[draw_index(aims_.size())];
      const int wanted = goal_[static_cast<std::size_t>(effector)];
      if (wanted == kFree) return {effector, {}};
      return {effector, position_of(wanted)};
    }
    const int effector = static_cast<int>(draw_index(goal_.size()));
    Eigen::Vector3d point;
    for (int i = 0; i < 3; ++i) point[i] = uniform(random_, box_.min()[i], box_.max()[i]);
    return {effector, point};
  }

  std::size_t draw_index(std::size_t size) {
    const double drawn = uniform(random_, 0.0, static_cast<double>(size));
    return std::min(static_cast<std::size_t>(drawn), size - 1);
  }

  /// -1 where the end effector cannot be moved from any.
  int draw_vertex(const Target& target) {
    double sum = 0.0;
    sums_.clear();
    for (const Vertex& one : vertices_) {
      if (can_expand(one, target)) sum += one.weight / distance(one, target);
      sums_.push_back(sum);
    }
    if (!(sum > 0.0)) return -1;
    const double drawn = std::min(uniform(random_, 0.0, sum), std::nextafter(sum, 0.0));
    return static_cast<int>(std::upper_bound(sums_.begin(), sums_.end(), drawn) - sums_.begin());
  }

  bool can_expand(const Vertex& from, const Target& target) const {
    if (target.effector == from.added) return false;
    const std::size_t k = static_cast<std::size_t>(target.effector);
    if (from.footing[k] == kFree) return target.point.has_value();
    return from.footing[k] != goal_[k] && contacts_of(from.footing) > fewest_;
  }

  static double distance(const Vertex& from, const Target& target) {
    if (!target.point) return 1.0;
    const std::size_t k = static_cast<std::size_t>(target.effector);
    return std::max(kNearest_m, (from.positions[k] - *target.point).norm());
  }

  int expand(int number, const Target& target) {
    static const double wear = std::exp2(-1.0 / kHalvedAfter);
    vertex(number).weight *= wear;
    Footing to = footing_after(vertex(number), target);
    if (known_.contains(to)) return -1;
    const Footing from = vertex(number).footing;
    std::size_t& tries = tries_[joined(from, to)];
    if (tries >= std::size(kRestarts)) return -1;
    const Eigen::VectorXd& q = vertex(number).configuration;
    StanceSpace::Attempt attempt = space_.try_transition(from, to, q, kRestarts[tries++], &q);
    if (!attempt.found) {
      tree_.add_failed(to, number);
      return -1;
    }
    const bool adds = contacts_of(to) > contacts_of(from);
    return add(std::move(to), std::move(attempt.configuration), number,
               adds ? target.effector : kNobody);
  }

  /// The vertex's footing itself where no contact is in reach.
  Footing footing_after(const Vertex& from, const Target& target) {
    const std::size_t k = static_cast<std::size_t>(target.effector);
    if (from.footing[k] != kFree) return without(from.footing, target.effector);
    return with(from.footing, target.effector,
                place_towards(target.effector, from.positions[k], *target.point));
  }

  int place_towards(int effector, const Eigen::Vector3d& from, const Eigen::Vector3d& point) {
    const int wanted = goal_[static_cast<std::size_t>(effector)];
    double reach = kReachShare * space_.reach_m(effector);
    for (int grown = 0; grown <= kMostGrowths; ++grown, reach += kReachGrowth_m) {
      std::vector<int> places;
      // First, so that it is taken before others that are as near.
      if (wanted != kFree && (position_of(wanted) - from).norm() <= reach) places = {wanted};
      const std::vector<int> near = space_.places_near(effector, from, reach);
      places.insert(places.end(), near.begin(), near.end());
      if (places.empty()) continue;
      return *std::min_element(places.begin(), places.end(), [&](int a, int b) {
        return (position_of(a) - point).squaredNorm() < (position_of(b) - point).squaredNorm();
      });
    }
    return kFree;
  }

  int add(Footing footing, Eigen::VectorXd q, int parent, int added) {
    std::vector<Eigen::Vector3d> positions;
    for (int e = 0; e < space_.effectors(); ++e) {
      const int place = footing[static_cast<std::size_t>(e)];
      positions.push_back(place != kFree ? position_of(place) : space_.position(e, q));
    }
    if (added != kNobody && std::find(aims_.begin(), aims_.end(), added) == aims_.end()) {
      aims_.push_back(added);  // not in the goal: to be lifted again
    }
    known_.insert(footing);
    note_best(footing, goal_);
    tree_.add(footing, parent);
    vertices_.push_back({std::move(footing), std::move(q), parent, added, std::move(positions)});
    ++result_.statistics.vertices_in_tree;
    return static_cast<int>(vertices_.size()) - 1;
  }

  void trace(int number, StancePath& path) {
    std::vector<int> way;
    for (int n = number; n > 0; n = vertex(n).parent) way.push_back(n);
    std::reverse(way.begin(), way.end());
    tree_.mark(0);
    for (const int n : way) {
      tree_.mark(n);
      path.append(vertex(n).footing, vertex(n).configuration);
    }
  }

  StanceTree tree_;
  std::mt19937_64 random_;
  Footing goal_;
  int fewest_ = 1;         ///< contacts that have to remain
  std::vector<int> aims_;  ///< end effectors in the goal or in contact somewhere in the tree
  Eigen::AlignedBox3d box_;
  std::vector<Vertex> vertices_;
  std::vector<double> sums_;
  std::unordered_set<Footing, FootingHash> known_;
  std::unordered_map<Footing, std::size_t, FootingHash> tries_;  ///< of transitions: joined()
};

}  // namespace

const std::string& RrtPlanner::name() const {
  static const std::string own = "rrt";
  return own;
}

std::unique_ptr<StanceSearch> RrtPlanner::begin(const Task& task,
                                                const StancePlannerOptions& options) const {
  return std::make_unique<RrtSearch>(task, options);
}

}  // namespace locograph
