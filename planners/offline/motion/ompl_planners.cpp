#include <locograph/planners/offline/motion/ompl_manifold.h>
#include <locograph/planners/offline/motion/ompl_planners.h>
#include <locograph/planners/offline/motion/shorten_way.h>
#include <ompl/base/ConstrainedSpaceInformation.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>

#include <algorithm>
#include <mutex>
#include <utility>

namespace locograph {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr double kTreeRange = 0.6;  // of one branch [m, rad]
constexpr double kShorteningRange = 1.5;
constexpr int kShortcuts = 80;
/// A way is shortened for as many states as it took to find it, or this part of the most of them.
constexpr int kLeastShortening = 4;

/// OMPL prints nothing while there is one of these. What was there before comes back with the last.
class SilentOmpl {
 public:
  SilentOmpl() {
    const std::lock_guard lock(mutex());
    if (count()++ > 0) return;
    before() = ompl::msg::getLogLevel();
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  }
  ~SilentOmpl() {
    const std::lock_guard lock(mutex());
    if (--count() == 0) ompl::msg::setLogLevel(before());
  }
  SilentOmpl(const SilentOmpl&) = delete;
  SilentOmpl& operator=(const SilentOmpl&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static int& count() {
    static int count = 0;
    return count;
  }
  static ompl::msg::LogLevel& before() {
    static ompl::msg::LogLevel level = ompl::msg::LOG_NONE;
    return level;
  }
};

/// OMPL's planners with a seed of their own, and with neighbours found without chance.
template <class Tree>
class SeededTree : public Tree {
 public:
  SeededTree(const ob::SpaceInformationPtr& information, std::uint64_t seed) : Tree(information) {
    this->rng_.setLocalSeed(static_cast<std::uint_fast32_t>(seed));
    this->setRange(kTreeRange);
    this->template setNearestNeighbors<ompl::NearestNeighborsLinear>();
  }
};

/// RRT* that begins with a way. By itself it hardly finds one: it has one tree, which grows to the
/// goal only where it comes near it.
class ShorteningTree : public SeededTree<og::RRTstar> {
 public:
  ShorteningTree(const ob::SpaceInformationPtr& information, std::uint64_t seed)
      : SeededTree(information, seed) {
    setNewStateRejection(true);  // of what cannot shorten the way
    setRange(kShorteningRange);
  }

  /// After setup(): the way becomes the tree. From the start to the goal.
  void begin_with(const std::vector<ob::State*>& way) {
    pis_.nextStart();  // is the way's first
    Motion* before = nullptr;
    for (const ob::State* const state : way) {
      auto* const motion = new Motion(si_);  // freed by the tree
      si_->copyState(motion->state, state);
      motion->parent = before;
      motion->cost = motion->incCost = opt_->identityCost();
      if (before != nullptr) {
        motion->incCost = opt_->motionCost(before->state, state);
        motion->cost = opt_->combineCosts(before->cost, motion->incCost);
        before->children.push_back(motion);
      }
      if (before == nullptr) startMotions_.push_back(motion);
      nn_->add(motion);
      before = motion;
    }
    before->inGoal = true;
    goalMotions_.push_back(before);
    bestGoalMotion_ = before;
    bestCost_ = before->cost;
  }
};

/// A search by OMPL: the problem, and how what is found becomes a path.
class TreeSearch {
 public:
  /// way: where the manifold draws samples; first both ends, then the way that was found.
  TreeSearch(SegmentSpace& space, Waypoints& way, const SegmentOptions& options,
             std::shared_ptr<ob::ConstrainedStateSpace> manifold)
      : space_(space),
        way_(way),
        options_(options),
        manifold_(std::move(manifold)),
        information_(std::make_shared<ob::ConstrainedSpaceInformation>(manifold_)),
        from_(manifold_),
        to_(manifold_) {
    manifold_->setDelta(kTreeStep);
    information_->setStateValidityChecker([this](const ob::State* state) {
      ++states_;
      return space_.valid(configuration_of(state));
    });
    information_->setup();
    coordinates_of(from_.get()) = to_coordinates(space.from(), space.from());
    coordinates_of(to_.get()) = to_coordinates(space.to(), space.from());
  }

  const ob::State* from() const { return from_.get(); }
  const ob::State* to() const { return to_.get(); }

  /// Two trees find a way; where it is to be, a third one shortens it.
  bool run(bool shortened, SegmentPath& path) {
    const bool found = search(shortened, path);
    path.statistics.iterations = states_;
    return found;
  }

 private:
  bool search(bool shortened, SegmentPath& path) {
    SeededTree<og::RRTConnect> trees(information_, options_.seed + 1);
    const ob::ProblemDefinitionPtr first = begin(trees);
    end(trees, options_.max_states);
    if (!first->hasExactSolution()) {
      path.reason = "no way among " + std::to_string(states_) + " states";
      return false;
    }
    auto* way = first->getSolutionPath()->as<og::PathGeometric>();
    path.first_length = way->length();
    ShorteningTree shortening(information_, options_.seed + 2);
    const ob::ProblemDefinitionPtr second = begin(shortening);
    if (shortened) {
      way_.clear();
      for (const ob::State* const state : way->getStates()) way_.push_back(configuration_of(state));
      shortening.begin_with(way->getStates());
      end(shortening, std::max(2 * states_, states_ + options_.max_states / kLeastShortening));
      way = second->getSolutionPath()->as<og::PathGeometric>();
    }
    path.tree_length = way->length();
    return complete(way->getStates(), path);
  }

  ob::ProblemDefinitionPtr begin(ob::Planner& tree) {
    auto problem = std::make_shared<ob::ProblemDefinition>(information_);
    problem->setStartAndGoalStates(from_, to_);
    problem->setOptimizationObjective(
        std::make_shared<ob::PathLengthOptimizationObjective>(information_));
    tree.setProblemDefinition(problem);
    tree.setup();
    return problem;
  }

  void end(ob::Planner& tree, int most) {
    // Rounds count as well: not each of them comes to look at a state.
    tree.solve(ob::PlannerTerminationCondition(
        [&] { return ++states_ > most || options_.termination.ended(states_); }));
  }

  bool complete(const std::vector<ob::State*>& states, SegmentPath& path) {
    Waypoints middle;
    if (follow(states, middle)) {
      shorten(space_, middle, kShortcuts, options_.seed);
      path.waypoints = {space_.lifted().front()};
      if (append(space_.lifted(), true, path.waypoints) && append(middle, false, path.waypoints) &&
          append(space_.landing(), true, path.waypoints)) {
        return true;
      }
    }
    path.reason = space_.why_not();
    return false;
  }

  /// `way` goes on from where `part` begins.
  bool append(const Waypoints& part, bool swinging, Waypoints& way) {
    return std::all_of(part.begin() + 1, part.end(),
                       [&](const Eigen::VectorXd& q) { return join(space_, way, q, swinging); });
  }

  /// The way along the states of a tree, on which contacts are closed as well as can be.
  bool follow(const std::vector<ob::State*>& states, Waypoints& way) {
    way = {space_.from()};
    for (std::size_t i = 1; i < states.size(); ++i) {
      std::vector<ob::State*> between;
      // A branch was tried from one of its ends.
      if (!manifold_->discreteGeodesic(states[i - 1], states[i], true, &between)) {
        for (ob::State* const state : between) manifold_->freeState(state);
        manifold_->discreteGeodesic(states[i], states[i - 1], true, &between);
        std::reverse(between.begin(), between.end());
      }
      const std::size_t before = way.size();
      bool joined = true;
      for (ob::State* const state : between) {
        Eigen::VectorXd q = configuration_of(state);
        joined = joined && space_.project(q) && space_.valid(q) && join(space_, way, q);
        manifold_->freeState(state);
      }
      if (joined) continue;
      // Charts that are newer than the branch may lead another way.
      way.resize(before);
      Eigen::VectorXd q = configuration_of(states[i]);
      if (!space_.project(q) || !space_.valid(q) || !join(space_, way, q)) return false;
    }
    return join(space_, way, space_.to());
  }

  SegmentSpace& space_;
  Waypoints& way_;
  const SegmentOptions& options_;
  std::shared_ptr<ob::ConstrainedStateSpace> manifold_;
  ob::SpaceInformationPtr information_;
  ob::ScopedState<ob::ConstrainedStateSpace> from_, to_;
  int states_ = 0;  ///< looked at
};

/// What both planners do.
class TreePlanner : public SegmentPlanner {
 public:
  explicit TreePlanner(std::string name) : name_(std::move(name)) {}
  const std::string& name() const override { return name_; }

 private:
  bool search(SegmentSpace& space, const SegmentOptions& options,
              SegmentPath& path) const override {
    if (!space.lift_off()) {
      path.reason = space.why_not();
      return false;
    }
    const SilentOmpl silent;
    try {
      return grow_again(space, options, path);
    } catch (const ompl::Exception& error) {  // as where rows of the closure depend on each other
      path.reason = error.what();
      return false;
    }
  }

  /// Branches are looked at in steps: a way that is found may meet something in between, and that
  /// of other trees may not.
  bool grow_again(SegmentSpace& space, const SegmentOptions& options, SegmentPath& path) const {
    constexpr std::uint64_t kTrees = 3, kOtherSeeds = 7919;
    int states = 0;
    bool holds = false, found = true;
    for (std::uint64_t k = 0; k < kTrees && !holds && found; ++k) {
      if (k > 0 && (states >= options.max_states || options.termination.ended(states))) break;
      SegmentOptions own = options;
      own.seed += k * kOtherSeeds;
      own.max_states -= states;
      own.termination = options.termination.after(states);
      SegmentPath grown;
      holds = grow(space, own, grown);
      states += grown.statistics.iterations;
      found = grown.tree_length > 0.0;
      if (k == 0 || found) path = std::move(grown);
    }
    path.statistics.iterations = states;
    return holds;
  }
  virtual bool grow(SegmentSpace& space, const SegmentOptions& options,
                    SegmentPath& path) const = 0;

  std::string name_;
};

class RrtConnectPlanner : public TreePlanner {
 public:
  RrtConnectPlanner() : TreePlanner("rrt_connect") {}

 private:
  bool grow(SegmentSpace& space, const SegmentOptions& options, SegmentPath& path) const override {
    Waypoints way = {space.from(), space.to()};
    TreeSearch search(space, way, options, projected_manifold(space, way, options.seed));
    return search.run(false, path);
  }
};

class AtlasRrtStarPlanner : public TreePlanner {
 public:
  AtlasRrtStarPlanner() : TreePlanner("atlas_rrt_star") {}

 private:
  bool grow(SegmentSpace& space, const SegmentOptions& options, SegmentPath& path) const override {
    Waypoints way = {space.from(), space.to()};
    const auto atlas = atlas_manifold(space, way, options.seed);
    TreeSearch search(space, way, options, atlas);
    atlas->anchorChart(search.from());
    atlas->anchorChart(search.to());
    return search.run(true, path);
  }
};

}  // namespace

std::unique_ptr<SegmentPlanner> make_rrt_connect() { return std::make_unique<RrtConnectPlanner>(); }

std::unique_ptr<SegmentPlanner> make_atlas_rrt_star() {
  return std::make_unique<AtlasRrtStarPlanner>();
}

}  // namespace locograph
