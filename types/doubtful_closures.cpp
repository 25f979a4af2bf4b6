#include <locograph/common/check_option.h>
#include <locograph/common/skew.h>
#include <locograph/core/graduated_non_convexity.h>
#include <locograph/types/doubtful_closures.h>
#include <locograph/types/parts.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>

namespace locograph {
namespace {

/// The two kinds of pose, alike for the templates below. An error e of a pose P is that of P exp(e)
/// to first order, in the order and units of the edges' errors.
struct Planar {
  static constexpr int kAxes = 2, kDimension = 3;
  using Pose = SE2<double>;
  using Error = Eigen::Vector3d;
  using Covariance = Eigen::Matrix3d;
  using Edge = EdgeSE2;
  using OffsetEdge = EdgeSE2Offset;

  static Error error(const Pose& pose) {
    return {pose.translation()[0], pose.translation()[1], wrap_angle(pose.angle())};
  }
  /// A with P exp(A e) = exp(e) P.
  static Covariance carry(const Pose& pose) {
    const Eigen::Vector2d t = pose.translation();
    Covariance a = Covariance::Identity();
    a.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-pose.angle()).toRotationMatrix();
    a.topRightCorner<2, 1>() = pose.inverse_rotate(Eigen::Vector2d(-t[1], t[0]));
    return a;
  }
  /// Of all errors in a map of this diameter; of those within an ellipsoid with unit half-axes.
  static double volume(double diameter) {
    return 0.25 * std::numbers::pi * diameter * diameter * 2.0 * std::numbers::pi;
  }
  static constexpr double kUnitBall = 4.0 / 3.0 * std::numbers::pi;
};

struct Spatial {
  static constexpr int kAxes = 3, kDimension = 6;
  using Pose = SE3<double>;
  using Error = Eigen::Matrix<double, 6, 1>;
  using Covariance = Eigen::Matrix<double, 6, 6>;
  using Edge = EdgeSE3;
  using OffsetEdge = EdgeSE3Offset;

  static Error error(const Pose& pose) {
    Error e;
    pose_error<double>(pose, e);
    return e;
  }
  /// The vector part of a quaternion is half the angle.
  static Covariance carry(const Pose& pose) {
    const Eigen::Matrix3d turn = pose.rotation().conjugate().toRotationMatrix();
    const Eigen::Vector3d t = pose.translation();
    Covariance a = Covariance::Zero();
    a.topLeftCorner<3, 3>() = turn;
    a.bottomRightCorner<3, 3>() = turn;
    a.topRightCorner<3, 3>() = -2.0 * turn * skew(t);
    return a;
  }
  static double volume(double diameter) {
    return std::numbers::pi / 6.0 * std::pow(diameter, 3) * 4.0 / 3.0 * std::numbers::pi;
  }
  static constexpr double kUnitBall = std::numbers::pi * std::numbers::pi * std::numbers::pi / 6.0;
};

template <class S>
class Cycles {
 public:
  Cycles(const Graph& graph, const std::vector<bool>& trusted, const ConsistencyOptions& options)
      : graph_(graph), options_(options), tie_(graph.edge_slots(), -1) {
    for (int slot = 0; slot < graph.edge_slots(); ++slot) {
      if (!graph.edge_alive(slot)) continue;
      const std::optional<Motion> motion = measured(slot);
      if (!motion) continue;
      const std::span<const int> ends = graph.edge_vertices(slot);
      tie_[slot] = static_cast<int>(ties_.size());
      ties_.push_back({slot, ends[0], ends[1], trusted[slot], trusted[slot], *motion});
      if (!trusted[slot]) ++closures_;
    }
  }

  void append_doubted(std::vector<int>& slots) {
    if (closures_ == 0) return;
    passes_below_ =
        chi_squared_quantile(S::kDimension, 1.0 - (1.0 - options_.inlier_probability) / closures_);
    volume_ = S::volume(diameter());
    confirm_pairs();
    for (int steps = std::min(10, options_.path_steps);;) {
      if (confirm_cycles(steps)) continue;
      if (steps >= options_.path_steps) break;
      steps = std::min(2 * steps, options_.path_steps);
    }
    Parts parts(graph_.vertex_slots());
    for (const Tie& tie : ties_) {
      if (tie.confirmed) parts.join(tie.a, tie.b);
    }
    for (const Tie& tie : ties_) {
      if (!tie.confirmed && parts.first(tie.a) == parts.first(tie.b)) slots.push_back(tie.slot);
    }
  }

 private:
  using Pose = typename S::Pose;
  using Covariance = typename S::Covariance;

  /// A pose seen from another, and the covariance of its error.
  struct Motion {
    Pose pose;
    Covariance covariance = Covariance::Zero();

    Motion operator*(const Motion& next) const {
      const Covariance a = S::carry(next.pose);
      return {pose * next.pose, a * covariance * a.transpose() + next.covariance};
    }
    Motion inverse() const {
      const Pose back = pose.inverse();
      const Covariance a = S::carry(back);
      return {back, a * covariance * a.transpose()};
    }
  };
  struct Tie {
    int slot, a, b;
    bool trusted, confirmed;
    Motion motion;  ///< b seen from a

    int other(int vertex) const { return vertex == a ? b : a; }
    Motion from(int vertex) const { return vertex == a ? motion : motion.inverse(); }
  };
  struct Reached {
    int vertex, steps;
    Motion motion;
  };

  /// None when the edge is no relative pose, or does not measure all of it.
  std::optional<Motion> measured(int slot) const {
    const Graph::EdgeRecord& record = graph_.edge_record(slot);
    const EdgePool& pool = *graph_.edge_pools()[record.pool];
    const auto motion = [](const auto& edge) -> std::optional<Motion> {
      const Eigen::LLT<Covariance> information(edge.information);
      if (information.info() != Eigen::Success) return std::nullopt;
      const Covariance covariance = information.solve(Covariance::Identity());
      if (!covariance.allFinite()) return std::nullopt;
      return Motion{edge.measurement, covariance};
    };
    if (pool.type() == typeid(typename S::Edge)) {
      return motion(static_cast<const TypedEdgePool<typename S::Edge>&>(pool).edges[record.index]);
    }
    if (pool.type() == typeid(typename S::OffsetEdge)) {
      const auto& edge =
          static_cast<const TypedEdgePool<typename S::OffsetEdge>&>(pool).edges[record.index];
      const std::optional<Motion> between = motion(edge);
      if (!between) return std::nullopt;
      return Motion{edge.first} * *between * Motion{edge.second.inverse()};
    }
    return std::nullopt;
  }

  /// Of the box around the poses as the trusted edges place them, each part by itself.
  double diameter() const {
    using Position = Eigen::Matrix<double, S::kAxes, 1>;
    std::vector<bool> known(graph_.vertex_slots(), false);
    std::vector<Pose> pose(graph_.vertex_slots());
    std::deque<int> queue;
    double largest = 0.0;
    for (const Tie& start : ties_) {
      if (known[start.a]) continue;
      known[start.a] = true;
      queue.push_back(start.a);
      Position low = Position::Zero(), high = Position::Zero();
      while (!queue.empty()) {
        const int v = queue.front();
        queue.pop_front();
        low = low.cwiseMin(pose[v].translation());
        high = high.cwiseMax(pose[v].translation());
        for (const int e : graph_.incident_edges(v)) {
          if (tie_[e] < 0 || !ties_[tie_[e]].trusted) continue;
          const Tie& tie = ties_[tie_[e]];
          const int to = tie.other(v);
          if (known[to]) continue;
          known[to] = true;
          pose[to] = pose[v] * (v == tie.a ? tie.motion.pose : tie.motion.pose.inverse());
          queue.push_back(to);
        }
      }
      largest = std::max(largest, (high - low).norm());
    }
    return largest;
  }

  /// Breadth-first along confirmed edges, as long as a wrong closure would be told from a right
  /// one. Ends early when it reaches `goal`, which is then the last.
  void walk(int start, int most_steps, int goal, std::vector<Reached>& reached) {
    seen_.resize(graph_.vertex_slots(), 0);
    ++walks_;
    seen_[start] = walks_;
    reached.assign(1, {start, 0, {}});
    for (std::size_t i = 0; i < reached.size() && reached[i].steps < most_steps; ++i) {
      const int v = reached[i].vertex;
      for (const int e : graph_.incident_edges(v)) {
        if (tie_[e] < 0 || !ties_[tie_[e]].confirmed) continue;
        const Tie& tie = ties_[tie_[e]];
        const int to = tie.other(v);
        if (seen_[to] == walks_) continue;
        const Motion motion = reached[i].motion * tie.from(v);
        if (!tells(motion.covariance)) continue;
        seen_[to] = walks_;
        reached.push_back({to, reached[i].steps + 1, motion});
        if (to == goal) return;
      }
    }
  }

  bool tells(const Covariance& covariance) const {
    const Eigen::LLT<Covariance> factor(covariance);
    const double root_of_determinant =
        factor.info() == Eigen::Success ? factor.matrixLLT().diagonal().prod() : 0.0;
    const double half_axes = root_of_determinant * std::pow(passes_below_, 0.5 * S::kDimension);
    return S::kUnitBall * half_axes <= options_.accident_probability * volume_;
  }

  /// Whether two ways to the same pose agree; nothing when the test would not tell.
  std::optional<bool> agree(const Motion& left, const Motion& right) const {
    const Covariance covariance = left.covariance + right.covariance;
    if (!tells(covariance)) return std::nullopt;
    const typename S::Error e = S::error(right.pose.inverse() * left.pose);
    const Eigen::LLT<Covariance> factor(covariance);
    if (factor.info() != Eigen::Success) return std::nullopt;
    return factor.matrixL().solve(e).squaredNorm() <= passes_below_;
  }

  void confirm_pairs() {
    std::vector<std::vector<Reached>> around(graph_.vertex_slots());
    for (const Tie& tie : ties_) {
      if (tie.trusted) continue;
      for (const int v : {tie.a, tie.b}) {
        if (around[v].empty()) walk(v, options_.pair_steps, -1, around[v]);
      }
    }
    std::vector<const Motion*> beyond(graph_.vertex_slots(), nullptr);  // seen from the second end
    std::vector<int> confirmed;
    for (std::size_t k = 0; k < ties_.size(); ++k) {
      const Tie& tie = ties_[k];
      if (tie.trusted) continue;
      for (const Reached& r : around[tie.b]) beyond[r.vertex] = &r.motion;
      int balance = 0;
      for (const Reached& r : around[tie.a]) {
        for (const int e : graph_.incident_edges(r.vertex)) {
          if (tie_[e] < 0 || tie_[e] == static_cast<int>(k) || ties_[tie_[e]].trusted) continue;
          const Tie& partner = ties_[tie_[e]];
          const Motion* rest = beyond[partner.other(r.vertex)];
          if (rest == nullptr) continue;
          const std::optional<bool> passes =
              agree(r.motion * partner.from(r.vertex), tie.motion * *rest);
          if (passes) balance += *passes ? 1 : -1;
        }
      }
      if (balance > 0) confirmed.push_back(static_cast<int>(k));
      for (const Reached& r : around[tie.b]) beyond[r.vertex] = nullptr;
    }
    for (const int k : confirmed) ties_[k].confirmed = true;
  }

  /// False when there was none to confirm.
  bool confirm_cycles(int most_steps) {
    std::vector<int> confirmed;
    for (std::size_t k = 0; k < ties_.size(); ++k) {
      const Tie& tie = ties_[k];
      if (tie.confirmed) continue;
      walk(tie.a, most_steps, tie.b, reached_);
      if (reached_.back().vertex != tie.b) continue;
      if (agree(tie.motion, reached_.back().motion).value_or(false)) {
        confirmed.push_back(static_cast<int>(k));
      }
    }
    for (const int k : confirmed) ties_[k].confirmed = true;
    return !confirmed.empty();
  }

  const Graph& graph_;
  const ConsistencyOptions& options_;
  std::vector<Tie> ties_;
  std::vector<int> tie_;  ///< number by edge slot, -1 for edges that are none
  int closures_ = 0;
  double passes_below_ = 0.0, volume_ = 0.0;
  std::vector<int> seen_;  ///< number of the walk that came by last, by vertex slot
  int walks_ = 0;
  std::vector<Reached> reached_;
};

}  // namespace

void ConsistencyOptions::validate() const {
  check_option(inlier_probability > 0.0 && inlier_probability < 1.0, "inlier_probability",
               "a probability in (0, 1)");
  check_option(accident_probability > 0.0 && accident_probability < 1.0, "accident_probability",
               "a probability in (0, 1)");
  check_option(pair_steps >= 0, "pair_steps", "0 or more");
  check_option(path_steps >= 1, "path_steps", "1 or more");
}

std::vector<int> doubtful_closures(const Graph& graph, std::span<const int> trusted,
                                   const ConsistencyOptions& options) {
  options.validate();
  std::vector<bool> is_trusted(graph.edge_slots(), false);
  for (const int slot : trusted) is_trusted[slot] = true;
  std::vector<int> doubted;
  Cycles<Planar>(graph, is_trusted, options).append_doubted(doubted);
  Cycles<Spatial>(graph, is_trusted, options).append_doubted(doubted);
  std::sort(doubted.begin(), doubted.end());
  return doubted;
}

}  // namespace locograph
