#pragma once
/// What one thread needs to judge balance at vertices and in steps of a motion, see
/// balance_along.h.
///
///     BalanceWorker worker(context);
///     worker.judge_vertices(17, 32, found);  // writes only what is of these
///     worker.judge_steps(16, 32, found);     // once all vertices are judged

#include <locograph/check/balance_certificate.h>
#include <locograph/check/check_context.h>
#include <locograph/check/nearby_balance.h>

#include <array>
#include <limits>
#include <list>
#include <optional>
#include <vector>

namespace locograph {

/// A certificate by linear programming, and of what.
struct BalanceFinding {
  BalanceCertificate certificate;
  const JudgedStance* stance = nullptr;
  int vertex = 0;
  double time_s = 0.0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the base
  bool torques = false;                             ///< max_torque_ratio is to be told

  /// A margin without wrenches that could be verified is no proof.
  bool verified() const;
};

/// Of a whole motion.
struct BalanceFindings {
  struct Extremes {
    double margin = std::numeric_limits<double>::infinity();  ///< least so far
    double torque_ratio = -std::numeric_limits<double>::infinity();
    void add(const BalanceFinding& finding);
  };

  explicit BalanceFindings(std::size_t vertices)
      : at_vertices(vertices),
        in_steps(vertices),
        margins(vertices),
        wrenches(vertices),
        half_m(vertices, 0.1) {}

  using List = std::list<BalanceFinding>;  // whose entries stay where they are

  std::vector<List> at_vertices, in_steps;
  /// At each vertex as the step before it ends and as the one after it begins; lower bounds where
  /// no programme was needed.
  std::vector<std::array<double, 2>> margins;
  /// At each vertex, of the stance of the step after it, where they are asked for.
  std::vector<StanceWrenches> wrenches;
  std::vector<double> half_m;  ///< of the areas at each vertex, the smallest; at most 0.1
  Extremes known;              ///< to all pieces, when they begin
  double smallest_half_m = 0.1;
  bool prove_nearby = true;
};

class BalanceWorker {
 public:
  explicit BalanceWorker(CheckContext& context);

  /// Vertices from first to before last, with wrenches found at one before and at `last`. What is
  /// found is added, also where it is already known: beyond `found.known` it goes by that only.
  void judge_vertices(std::size_t first, std::size_t last, BalanceFindings& found);
  /// Steps likewise, with what was found at their vertices.
  void judge_steps(std::size_t first, std::size_t last, BalanceFindings& found);

 private:
  struct Sample {
    double fraction = 0.0;
    double margin = 0.0;                // or a lower bound of it
    std::vector<Eigen::Vector3d> arms;  // contacts from the centre of mass; gravity; base axes
  };
  struct Spot {
    int vertex = 0;
    double fraction = 0.0;  // of the step from the vertex
    bool at_rest = false;   // there, whatever the curve says
    const JudgedStance* stance = nullptr;
  };

  void begin(const BalanceFindings& found);
  double judge(const Spot& spot, BalanceFindings::List* findings,
               StanceWrenches* wrenches = nullptr);
  BalanceBounds prove(const Spot& spot, const BalanceOptions& options);
  bool enough_is_known_of_margin(const BalanceBounds& bounds) const;
  bool enough_is_known_of_torques(const BalanceBounds& bounds) const;
  bool violates(const BalanceFinding& finding) const;
  BalanceFinding programme(const Spot& spot, BalanceOptions options, bool torques);
  BalanceOptions options_for(const Spot& spot);
  void judge_step(const Spot& begin, double margin_from, double margin_to);
  std::vector<Eigen::Vector3d> arms(const Spot& spot);
  Sample sample(const Spot& spot);
  void refine(const Spot& begin, const Sample& from, const Sample& to);
  double steepest_fall() const;

  CheckContext& context_;
  MotionSampler sampler_;
  CurvePoint point_;
  std::optional<MovingShapes> shapes_;
  LinkPoses poses_;
  NearbyBalance nearby_;
  std::vector<Contact> contacts_;

  // Of the piece.
  bool prove_nearby_ = true;
  BalanceFindings::Extremes known_;
  std::vector<const BalanceFinding*> near_;  // whose wrenches are tried
  BalanceFindings::List* findings_ = nullptr;
  bool violated_ = false;  // the step
  double smallest_half_m_ = 0.1;
};

}  // namespace locograph
