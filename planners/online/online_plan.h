#pragma once
/// A plan that is changed while it is executed: its configurations as they came, and as they are
/// now.
///
///     OnlinePlan online(plan_graph);
///     online.configuration(1).head<3>() += Eigen::Vector3d(0.0, 0.1, 0.0);
///     for (int i = 0; i < online.size(); ++i) std::cout << online.behind_m(i) << " m behind\n";
///
/// Configurations are known by their index in the plan.

#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/slope_limits.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace locograph {

/// Whether a robot in this stance rolls on wheels: one of them is not locked.
bool rolls_on_wheels(const StanceParameter& stance);

class OnlinePlan {
 public:
  /// The graph must outlive it, and keep its vertices. Throws Error for a graph without a plan, for
  /// a plan of stances, and for one without a world or with a configuration without a stance.
  explicit OnlinePlan(Graph& graph);

  int size() const { return static_cast<int>(plan_.slots.size()); }
  int last() const { return size() - 1; }
  const Plan& plan() const { return plan_; }
  const Robot& robot() const { return *plan_.robot->robot; }
  Graph& graph() const { return graph_; }

  /// Whether the step from a configuration to the next one rolls on wheels.
  bool rolls(int index) const { return rolls_[static_cast<std::size_t>(index)]; }

  /// Configurations as the plan came, or as a way back to it leads.
  const std::vector<Eigen::VectorXd>& planned() const { return planned_.configurations; }
  /// The same without ways back on wheels.
  const std::vector<Eigen::VectorXd>& as_it_came() const {
    return came_.empty() ? planned() : came_;
  }
  /// One of them as the graph has it now.
  Eigen::Map<Eigen::VectorXd> configuration(int index);
  Eigen::Map<const Eigen::VectorXd> configuration(int index) const;
  /// The robot is in another configuration than the plan has, also where that is fixed. Those
  /// before it move along, from `first` on: on wheels by the same steps, on legs all by as much.
  void move_to(int index, const Eigen::VectorXd& measured, int first);
  /// Contacts that are held from a configuration on, and are elsewhere there than planned, along
  /// what they are on and by kElsewhere_m at most, are taken as they are, in all stances that have
  /// them. Balls roll on from where they are by themselves; a bar is where it is.
  void take_contacts(int index);
  static constexpr double kElsewhere_m = 0.02;
  /// Overwrites the configurations from `first` on, but for those that the graph holds fixed.
  void overwrite(int first, std::span<const Eigen::VectorXd> configurations);
  bool is_fixed(int index) const { return graph_.vertex_record(slot(index)).fixed; }
  double time_s(int index) const;

  /// Whether a configuration is where it was planned, to 1e-9 m and rad, however far wheels that
  /// roll have turned.
  bool is_as_planned(int index) const;

  /// Slopes are those of the plan as it came. Gives the configurations first … last that go with
  /// where they are now: on wheels those of the rule of the curve (motion_curve.h), on legs the
  /// plan's carried along (slope_limits.h), and wrenches with them (carried_wrenches.h). On legs
  /// what has just been held, or is held next, is moved out of what it touches, by the micrometres
  /// that edges tolerate and the judge does not.
  void follow_moved(int first, int last);

  /// The steps from one configuration to another one take duration_s together, which is longer than
  /// they do: both ends are passed as fast as planned, the middle slowest. What comes later comes
  /// later by as much.
  void slow_down(int from, int to, double duration_s);
  /// On legs: the graph's configurations in the range are the plan from now on, with slopes and
  /// wrenches that go with them; those of the plan as it was count more and more until `back`. The
  /// two configurations after them are, too, but for their wrenches.
  void go_as_led(const PlanRange& range, int back);

  /// On wheels: what is planned from `first` on, and tracked, is elsewhere from now on, by a
  /// tangent for each configuration.
  void move_planned(int first, std::span<const Eigen::VectorXd> by);
  /// Whether it has been slowed down, or moved by 5 mm or mrad in all, since this was so.
  bool forget_moved();

  /// How far a configuration is behind where it is planned, along its heading [m].
  double behind_m(int index) const;

  int slot(int index) const { return plan_.slots[static_cast<std::size_t>(index)]; }
  /// Of the configuration in a slot of the graph; -1 for vertices of other types.
  int index_of(int slot) const { return plan_.index.configuration[static_cast<std::size_t>(slot)]; }
  /// The configuration that the wrenches in a slot of the graph bear; -1 for other vertices.
  int borne_at(int slot) const { return borne_at_[static_cast<std::size_t>(slot)]; }
  /// index_of() or borne_at(); for a vertex of another type the first configuration that it shares
  /// an edge with, -1 when there is none.
  int first_index_on(int slot) const;

  /// The world as it is known now: that of the plan until another one is shown.
  const WorldSnapshot& world() const { return *world_->snapshot; }
  void show(std::shared_ptr<const WorldParameter> world);
  /// How often anything but states, slopes and the world has been changed: times, parameters.
  int revision() const { return revision_; }

  /// For evaluations of the graph: edges see that world.
  const Bindings& bindings() const { return bindings_; }

 private:
  void follow_times();
  void lift_out(int index);

  Graph& graph_;
  Plan plan_;
  std::shared_ptr<const WorldParameter> world_;
  Bindings bindings_;
  Motion planned_;
  std::vector<Eigen::VectorXd> came_;  ///< empty: planned_
  std::vector<bool> rolls_;            ///< by configuration
  std::vector<int> borne_at_;          ///< by slot
  int revision_ = 0;
  double moved_m_ = 0.0;  ///< see forget_moved()
};

}  // namespace locograph
