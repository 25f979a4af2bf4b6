#include <locograph/core/optimiser.h>
#include <locograph/planners/offline/motion/optimisation.h>
#include <locograph/planners/offline/motion/swing.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>
#include <locograph/solvers/linear_solvers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

namespace locograph {
namespace {

/// Between neighbours of a way as long as the straight one [m, rad].
constexpr double kSpacing = 0.06;
constexpr int kFewest = 24, kMost = 48;
constexpr int kMostIterations = 30;
/// What reaches into something between neighbours shows once there are twice as many.
constexpr int kTries = 2;
constexpr double kGain = 1e-3;
/// On squared errors in m, rad; that of the whole way counts with 1.
constexpr double kHeldWeight = 1e5, kRoomWeight = 1e4, kArcWeight = 100.0, kArcTurnWeight = 1.0;
/// What rows ask for beyond what is valid.
constexpr double kRoom = 5e-3;
/// This part of the segment after an end that has less than that.
constexpr double kGrowing = 0.15;
/// Rows of one configuration that are short of it.
constexpr Eigen::Index kMostShort = 96;
constexpr double kFineStep = 0.05;

/// How far each row is to be from being violated: as at the ends there, growing to kRoom from each.
/// The space must outlive it.
class WantedRoom {
 public:
  explicit WantedRoom(SegmentSpace& of)
      : space(of), held_(touching_links(of.robot(), of.segment().held)) {
    ends_[0] = rooms_at(of.segment().from);
    ends_[1] = rooms_at(of.segment().to);
  }

  /// t: in [0, 1] along the segment.
  double of(const TransitionRows& rows, const TransitionRows::Row& row, double t) const {
    const int link = rows.links(row).first;
    const bool held = row.kind == TransitionFailure::kSurface && link >= 0 &&
                      held_[static_cast<std::size_t>(link)];
    double room = kRoom;
    for (std::size_t end = 0; end < ends_.size(); ++end) {
      const auto found = ends_[end].find({row.kind, row.first, row.second});
      if (found == ends_[end].end()) continue;
      const double grown = held ? 0.0 : kRoom * (end == 0 ? t : 1.0 - t) / kGrowing;
      room = std::min(room, found->second + grown);
    }
    return room;
  }

  SegmentSpace& space;

 private:
  using Rooms = std::map<std::tuple<TransitionFailure, int, int>, double>;

  /// Of the rows that have less than kRoom.
  Rooms rooms_at(const Eigen::VectorXd& q) const {
    Rooms rooms;
    for (const TransitionRows::Row& row : space.rows_at(q, true).rows()) {
      if (row.value < kRoom) rooms[{row.kind, row.first, row.second}] = std::max(0.0, row.value);
    }
    return rooms;
  }

  std::vector<bool> held_;  ///< links that touch all along
  std::array<Rooms, 2> ends_;
};

/// What the rows of a segment's configuration lack. Error: max(0, wanted − value) of those that are
/// short, in the order of the rows.
struct EdgeSegmentRoom : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr ConstraintKind kConstraint = ConstraintKind::kNone;
  /// The last configuration; its rows are worked out once for error and Jacobian.
  struct Seen {
    Eigen::VectorXd q, error;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian;
  };
  std::shared_ptr<const WantedRoom> wanted;
  double t = 0.0;  ///< in [0, 1] along the segment
  std::shared_ptr<Seen> seen = std::make_shared<Seen>();

  EdgeSegmentRoom() = default;
  EdgeSegmentRoom(std::shared_ptr<const WantedRoom> room, double along)
      : wanted(std::move(room)), t(along) {
    weights.setConstant(kMostShort, kRoomWeight);
  }

  void look(const Eigen::VectorXd& q) const {
    if (seen->q.size() > 0 && seen->q == q) return;
    const TransitionRows& rows = wanted->space.rows_at(q, true);
    seen->q = q;
    seen->error.setZero(dimension());
    seen->jacobian.setZero(dimension(), rows.robot().tangent_size());
    Eigen::Index next = 0;
    for (std::size_t i = 0; i < rows.rows().size() && next < dimension(); ++i) {
      const double lack = wanted->of(rows, rows.rows()[i], t) - rows.rows()[i].value;
      if (!(lack > 0.0)) continue;
      seen->error[next] = lack;
      seen->jacobian.row(next++) = -rows.gradients().row(static_cast<Eigen::Index>(i));
    }
  }

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
    look(q.q);
    e = seen->error;
  }
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeSegmentRoom, 0> j) const {
    look(q.q);
    j = seen->jacobian;
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SEGMENT_ROOM", EdgeSegmentRoom)

/// Where an attempt begins, and what it wishes for.
struct Attempt {
  ArcOptions arc;
  double bend = 0.0;  ///< half-way, towards a named configuration: the part of the way to it
};
constexpr std::array<Attempt, 6> kAttempts = {
    {{.arc = {.height_m = 0.05}},
     {.arc = {.height_m = 0.06, .with_axes = false, .away_m = 0.12, .climb_first = true}},
     {.arc = {.height_m = 0.12, .with_axes = false}},
     {.arc = {.height_m = 0.05, .with_axes = false, .away_m = 0.1}},
     {.arc = {.height_m = 0.05, .with_axes = false}, .bend = 0.5},
     {.arc = {.height_m = 0.05, .with_axes = false}, .bend = 1.0}}};

/// The graph of one attempt.
class SegmentGraph {
 public:
  SegmentGraph(SegmentSpace& space, const std::shared_ptr<const WantedRoom>& wanted,
               const std::vector<Swing>& swings, const Attempt& attempt,
               std::vector<Eigen::VectorXd> way)
      : robot_(space.rows_at(way.front(), true).state().robot) {
    graph_.parameters().set(number_++, robot_);
    std::vector<int> held;
    const HeldBalls balls = space.balls_at(space.segment().from);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      held.push_back(add_contact(space.segment().held[i], balls[i]));
    }
    const Eigen::Index size = space.robot().tangent_size();
    const int last = static_cast<int>(way.size()) - 1;
    const EdgeVelocityTracking together(Eigen::VectorXd::Zero(size),
                                        Eigen::VectorXd::Constant(size, last));
    for (int i = 0; i <= last; ++i) {
      const double t = static_cast<double>(i) / last;
      ids_.push_back(graph_.add_vertex(
          i, VertexConfiguration(0, robot_, t, std::move(way[static_cast<std::size_t>(i)]))));
      if (i > 0) graph_.add_edge(together, ids_[ids_.size() - 2], ids_.back());
      if (i == 0 || i == last) {
        graph_.set_fixed(ids_.back(), true);
        continue;
      }
      graph_.add_edge(EdgeSegmentRoom(wanted, t), ids_.back());
      for (const int contact : held) add_contact_edge(contact, kHeldWeight, kHeldWeight);
      std::vector<Contact> places;
      for (const Swing& swing : swings) swing.add_places(space.robot(), t, attempt.arc, places);
      for (const Contact& place : places) {
        add_contact_edge(add_contact(place), kArcWeight, kArcTurnWeight);
      }
    }
  }

  /// iterations: made before, and these as well.
  std::vector<Eigen::VectorXd> optimised(const Termination& termination, int& iterations) {
    OptimiserOptions lm;
    lm.max_iterations = termination.left_of(kMostIterations, iterations);
    lm.gain = kGain;
    lm.shorten_steps = true;
    lm.deadline = termination.deadline;
    lm.on_iteration = [&](const OptimiserResult&) { return !termination.stopped(); };
    iterations += optimise(graph_, lm, *make_linear_solver("banded")).iterations;
    std::vector<Eigen::VectorXd> way;
    for (const auto id : ids_) way.push_back(graph_.vertex(id).state);
    return way;
  }

 private:
  /// ball: from where it rolls, if it does.
  int add_contact(const Contact& contact, const std::optional<BallPose>& ball = {}) {
    const auto parameter = std::make_shared<ContactParameter>(robot_, 0, contact);
    if (ball) parameter->closure = ContactClosure(*robot_->robot, contact, *ball);
    graph_.parameters().set(number_, parameter);
    return number_++;
  }

  /// On the last vertex.
  void add_contact_edge(int number, double weight, double turn_weight) {
    const auto contact = graph_.parameters().get<ContactParameter>(number);
    EdgeContact edge(*contact, number, weight);
    for (int row = 0; row < edge.dimension(); ++row) {
      const bool turns = contact->closure.held()[static_cast<std::size_t>(row)] >= 3;
      if (turns) edge.weights[row] = turn_weight;
    }
    graph_.add_edge(std::move(edge), ids_.back());
  }

  std::shared_ptr<const RobotParameter> robot_;
  Graph graph_;
  int number_ = 0;  ///< of the next parameter
  std::vector<VertexId<VertexConfiguration>> ids_;
};

class Optimisation : public SegmentPlanner {
 public:
  const std::string& name() const override {
    static const std::string name = "optimisation";
    return name;
  }

 private:
  bool search(SegmentSpace& space, const SegmentOptions& options,
              SegmentPath& path) const override {
    const std::vector<Swing> swings = swings_of(space);
    const auto wanted = std::make_shared<const WantedRoom>(space);
    int& iterations = path.statistics.iterations;
    for (const Attempt& attempt : kAttempts) {
      if (options.termination.ended(iterations)) return false;
      if (swings.empty() && &attempt != kAttempts.data() && attempt.bend == 0.0) continue;
      std::vector<Eigen::VectorXd> way = first_way(space, attempt);
      if (way.empty()) continue;
      for (int round = 0; round < kTries && !options.termination.used_up(iterations); ++round) {
        if (round > 0) halve(space, way);
        SegmentGraph graph(space, wanted, swings, attempt, std::move(way));
        way = graph.optimised(options.termination, iterations);
        path.waypoints = way;
        if (holds(space, path.waypoints, path.reason)) return true;
      }
    }
    return false;
  }

  /// Straight, or bent towards the first named configuration; empty: there is none.
  static std::vector<Eigen::VectorXd> first_way(SegmentSpace& space, const Attempt& attempt) {
    const Robot& robot = space.robot();
    const Eigen::VectorXd &from = space.segment().from, &to = space.segment().to;
    const std::vector<std::string> names = robot.configuration_names();
    Eigen::VectorXd aim;
    if (attempt.bend > 0.0) {
      if (names.empty()) return {};
      aim = robot.named_configuration(names.front());
    }
    const int steps =
        std::clamp(static_cast<int>(space.distance(from, to) / kSpacing), kFewest, kMost);
    std::vector<Eigen::VectorXd> way = {from};
    for (int i = 1; i < steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      Eigen::VectorXd q = space.half_way(from, to, t);
      const double share = attempt.bend * std::sin(std::numbers::pi * t);
      for (int j = 0; share > 0.0 && j < robot.active_joint_count(); ++j) {
        if (!std::isfinite(robot.active_joint(j).upper)) continue;
        double& joint = q[robot.base_configuration_size() + j];
        joint += share * (aim[robot.base_configuration_size() + j] - joint);
      }
      Eigen::VectorXd closed = q;
      way.push_back(space.project(closed) ? std::move(closed) : std::move(q));
    }
    way.push_back(to);
    return way;
  }

  /// Puts a configuration between all neighbours.
  static void halve(SegmentSpace& space, std::vector<Eigen::VectorXd>& way) {
    std::vector<Eigen::VectorXd> halved = {way.front()};
    for (std::size_t i = 1; i < way.size(); ++i) {
      Eigen::VectorXd middle = space.half_way(halved.back(), way[i]), closed = middle;
      halved.push_back(space.project(closed) ? std::move(closed) : std::move(middle));
      halved.push_back(std::move(way[i]));
    }
    way = std::move(halved);
  }

  /// Closes the way and looks whether it is valid.
  static bool holds(SegmentSpace& space, std::vector<Eigen::VectorXd>& way, std::string& reason) {
    for (std::size_t i = 1; i < way.size(); ++i) {
      const bool last = i + 1 == way.size();
      if (!last && !space.project(way[i])) {
        reason = "contacts do not close";
        return false;
      }
      if ((!last && !space.valid(way[i], true)) ||
          !space.valid_between(way[i - 1], way[i], kFineStep, true)) {
        reason = space.why_not();
        return false;
      }
    }
    return true;
  }
};

}  // namespace

std::unique_ptr<SegmentPlanner> make_optimisation() { return std::make_unique<Optimisation>(); }

}  // namespace locograph
