#pragma once
/// What has to be positive in a transition, at one configuration: values and gradients.
///
///     TransitionRows rows(robot, world);
///     rows.set_problem(problem, options);
///     rows.evaluate(q);
///     for (const TransitionRows::Row& row : rows.rows()) worst = std::min(worst, row.value);
///
/// Balls stay on what they roll on. Rows are given for what is near only: nearer than kBand_m of
/// its margin. Links that touch are kept from reaching deeper into what they touch than the judge
/// allows, by their exact shapes; the others are kept away by the spheres that cover them.

#include <locograph/planners/posture/transition_problem.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/surface_distance/place_relations.h>
#include <locograph/robots/contact_closure.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/distance_field.h>

#include <vector>

namespace locograph {

class TransitionRows {
 public:
  struct Row {
    TransitionFailure kind;
    int first, second;  ///< joint; bounds of links; bound and place; ball and place
    double value;       ///< at least 0 where it holds, margin included [m, rad]
  };

  TransitionRows(std::shared_ptr<const RobotParameter> robot, World world);

  /// As TransitionSolver does; a problem is to be set after it.
  void leave_as_near(const Eigen::VectorXd& q, double margin_m);
  void set_problem(const TransitionProblem& problem, const TransitionOptions& options);
  /// q: a configuration whose quaternion has norm 1.
  void evaluate(const Eigen::VectorXd& q);

  const Eigen::VectorXd& closure() const { return closure_; }
  /// rows x tangent_size, row-major.
  Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> closure_jacobian() const {
    return {closure_jacobian_.data(), closure_.size(), size_};
  }
  const std::vector<Row>& rows() const { return rows_; }
  Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>> gradients() const {
    return {gradients_.data(), static_cast<Eigen::Index>(rows_.size()), size_};
  }
  const ConfigurationState& state() const { return state_; }
  const Robot& robot() const { return state_.model(); }

  /// How far what is fixed to a link is from surfaces, bars and solids where the link is elsewhere
  /// than in a configuration; at most kBandSurface_m; negative: in one of them.
  double link_room(int link, const Eigen::Isometry3d& world_from_link);

  /// Closure alone, into `error`; leaves closure() as it is.
  void closure_at(const Eigen::VectorXd& q, Eigen::VectorXd& error);

  std::string text(const Row& row) const;
  /// Links that a row is about; -1: none.
  std::pair<int, int> links(const Row& row) const;
  int contact_link(int closure_row) const;
  const std::string& contact_name(int closure_row) const;

 private:
  /// The bits of products depend on how numbers are aligned.
  using Aligned = std::vector<double, Eigen::aligned_allocator<double>>;
  struct CoarsePair {
    int pair;
    LinkShapes first, second;
  };

  /// A ball that is held, and the place whose border it keeps to.
  struct RollingOn {
    int closure, place;
    Eigen::Vector3d point_in_link;
    double margin_m;
  };

  void find_coarse_pairs();
  ShapeDistance exact_distance(const CoarsePair& pair, double limit) const;
  double* add(TransitionFailure kind, int first, int second, double value);
  void find_borders(const Contact& contact);
  void add_joints();
  void add_borders();
  void add_balance();
  void add_torques();
  void add_self();
  double self_margin_m(int pair) const;
  void add_places();
  void add_obstacles();

  std::shared_ptr<const RobotParameter> robot_;
  PlaceRelations relations_;
  WorldDistance in_the_way_;
  bool anything_in_the_way_ = false;
  Eigen::VectorXd pair_weights_;
  Eigen::VectorXd most_apart_m_;  ///< that pairs are kept; empty: whatever is asked for
  std::vector<CoarsePair> coarse_;
  int size_;  ///< of the tangent
  ConfigurationState state_;

  TransitionOptions options_;
  const BalanceRegion* balance_ = nullptr;
  TorqueProgramme* torques_ = nullptr;
  bool exact_pairs_ = true;
  Eigen::VectorXd torque_gradient_;
  double balance_margin_m_ = 0.0;
  std::vector<ContactClosure> closures_;
  std::vector<RollingOn> rolling_;
  std::vector<std::string> contact_names_;
  std::vector<int> contact_of_row_, contact_links_;
  std::vector<bool> exempt_;  ///< bounds of links that touch: from map and obstacles

  Eigen::VectorXd closure_;
  Aligned closure_jacobian_;
  std::vector<Row> rows_;
  Aligned gradients_;
  std::vector<NearPair> near_;
  std::vector<double> near_gradients_;
};

}  // namespace locograph
