// Edges of a plan of CENTAURO's lower body (24 joints, floating base): ns for one edge, error and
// linearisation, and the kinematics that all edges on a configuration share.
#include <benchmark/benchmark.h>
#include <locograph/core/workspace.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits_timed.h>
#include <locograph/plugins/com/edge_com.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/frame_pose/edge_frame_pose.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/rolling/edge_steering_slip.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/plugins/static_balance/edge_wrench_norm.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>
#include <locograph/plugins/time_step/edge_duration.h>
#include <locograph/plugins/time_step/edge_time_step_limits.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits_timed.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>
#include <locograph/world/octree.h>

#include <filesystem>

namespace {

using namespace locograph;  // NOLINT: a program, not a header

constexpr int kRobot = 0, kWorld = 2, kFrame = 3, kFeet = 10, kWheels = 20, kHeld = 30,
              kStance = 40, kConfigurations = 21;

/// A straight drive along x, 0.08 m for each configuration, past boxes on both sides.
class Drive {
 public:
  explicit Drive(bool with_map) {
    const std::filesystem::path folder =
        std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models/centauro";
    robot_ =
        std::make_shared<const RobotParameter>(folder / "centauro.urdf", folder / "centauro.srdf",
                                               RobotOptions{.active_joints = {"lower_body"}});
    World world;
    std::vector<Box> boxes(2);
    for (int side : {0, 1}) {
      boxes[side].world_from_box.translation() << 0.8, side == 0 ? 0.8 : -0.8, 0.4;
      boxes[side].size << 2.0, 0.3, 0.8;
    }
    if (with_map) {
      world.map = octree_from_boxes(boxes, 0.05);
    } else {
      world.obstacles.resize(4);
      for (std::size_t i = 0; i < 4; ++i) {
        Obstacle& obstacle = world.obstacles[i];
        obstacle.shape = i == 0   ? Obstacle::Shape::kBox
                         : i == 1 ? Obstacle::Shape::kSphere
                                  : Obstacle::Shape::kCylinder;
        obstacle.size << 0.4, 0.8, 0.4;
        obstacle.world_from_obstacle.translation() << 0.5 * static_cast<double>(i),
            i % 2 ? 0.9 : -0.9, 0.4;
      }
    }
    graph_.parameters().set(kRobot, robot_);
    graph_.parameters().set(kWorld, std::make_shared<const WorldParameter>(
                                        std::make_shared<const WorldSnapshot>(world)));
    graph_.parameters().set(
        kFrame, std::make_shared<const FrameParameter>(*robot_->robot, kRobot, "wheel_1"));
    add_wheels();
    const Robot& model = *robot_->robot;
    Eigen::VectorXd q = model.named_configuration("home");
    q[2] = 0.7188;
    for (int i = 0; i < kConfigurations; ++i) {
      ids_.push_back(graph_.add_vertex(i, VertexConfiguration(kRobot, robot_, 0.2 * i, q)));
      q[0] += 0.08;
      q[7 + i % 24] += 0.01;
    }
  }

  template <class E>
  void add_unary(const E& edge) {
    for (const auto& id : ids_) graph_.add_edge(edge, id);
  }
  template <class E>
  void add_binary(const E& edge) {
    for (std::size_t i = 1; i < ids_.size(); ++i) graph_.add_edge(edge, ids_[i - 1], ids_[i]);
  }
  template <class E>
  void add_ternary(const E& edge) {
    for (std::size_t i = 2; i < ids_.size(); ++i) {
      graph_.add_edge(edge, ids_[i - 2], ids_[i - 1], ids_[i]);
    }
  }
  /// The time from each configuration to the next as a vertex.
  void add_steps() {
    for (int i = 1; i < kConfigurations; ++i) {
      steps_.push_back(graph_.add_vertex(2000 + i, VertexTimeStep(0.2)));
    }
  }
  template <class E>
  void add_to_steps(const E& edge) {
    for (const auto& step : steps_) graph_.add_edge(edge, step);
  }
  template <class E>
  void add_over_one_step(const E& edge) {
    for (std::size_t i = 1; i < ids_.size(); ++i) {
      graph_.add_edge(edge, ids_[i - 1], ids_[i], steps_[i - 1]);
    }
  }
  template <class E>
  void add_over_two_steps(const E& edge) {
    for (std::size_t i = 2; i < ids_.size(); ++i) {
      graph_.add_edge(edge, ids_[i - 2], ids_[i - 1], ids_[i], steps_[i - 2], steps_[i - 1]);
    }
  }
  /// Somewhere in the world: closed or not costs the same.
  void set_contact(int number, const std::string& link, ContactKind kind, bool forward) {
    locograph::Contact contact;
    EndEffector& end = contact.effector;
    end.link = link;
    end.kind = kind;
    if (kind == ContactKind::kWheel) end.radius_m = 0.078;
    end.half_x_m = end.half_y_m = 0.02;
    end.friction = 0.5;
    end.max_force_N = 1000.0;
    if (forward) contact.forward = Eigen::Vector3d::UnitX();
    graph_.parameters().set(
        number, std::make_shared<const ContactParameter>(robot_, kRobot, std::move(contact)));
  }
  void add_wheels() {
    std::vector<int> numbers;
    for (int i = 0; i < 4; ++i) {
      numbers.push_back(kWheels + i);
      set_contact(numbers.back(), "wheel_" + std::to_string(i + 1), ContactKind::kWheel, false);
    }
    graph_.parameters().set(kStance,
                            std::make_shared<const StanceParameter>(graph_.parameters(), numbers));
  }
  /// Each configuration stands on its four feet: surfaces, the wheels braked.
  void add_wrenches() {
    std::vector<int> numbers;
    for (int i = 0; i < 4; ++i) {
      numbers.push_back(kFeet + i);
      set_contact(numbers.back(), "wheel_" + std::to_string(i + 1), ContactKind::kSurface, true);
    }
    for (int i = 0; i < kConfigurations; ++i) {
      VertexWrenches wrenches(graph_.parameters(), numbers);
      for (int c = 0; c < 4; ++c) wrenches.state.segment<3>(6 * c) << 20.0, 5.0, 270.0;
      wrenches_.push_back(graph_.add_vertex(1000 + i, std::move(wrenches)));
    }
  }
  const VertexWrenches& wrenches() const { return graph_.vertex(wrenches_[0]); }
  template <class E>
  void add_to_wrenches(const E& edge) {
    for (const auto& id : wrenches_) graph_.add_edge(edge, id);
  }
  template <class E>
  void add_with_wrenches(const E& edge) {
    for (std::size_t i = 0; i < ids_.size(); ++i) graph_.add_edge(edge, ids_[i], wrenches_[i]);
  }
  void compile() {
    problem_.compile(graph_);
    workspace_.allocate(problem_);
    workspace_.load_state();
    workspace_.evaluate(workspace_.state());
  }
  const RobotParameter& robot() const { return *robot_; }
  const ContactParameter& contact(int number) const {
    return *graph_.parameters().get<ContactParameter>(number);
  }
  const StanceParameter& stance() const {
    return *graph_.parameters().get<StanceParameter>(kStance);
  }
  const Robot& model() const { return *robot_->robot; }
  Workspace& workspace() { return workspace_; }
  const Problem& problem() const { return problem_; }

 private:
  std::shared_ptr<const RobotParameter> robot_;
  Graph graph_;
  std::vector<VertexId<VertexConfiguration>> ids_;
  std::vector<VertexId<VertexWrenches>> wrenches_;
  std::vector<VertexId<VertexTimeStep>> steps_;
  Problem problem_;
  Workspace workspace_;
};

/// Times for one edge: `error` without kinematics, `linearise` with error, Jacobian and JᵀΩJ but
/// without clearing H.
void measure(benchmark::State& run, Drive& drive, bool linearise) {
  drive.compile();
  const Problem& problem = drive.problem();
  const EdgePool& pool = *problem.graph().edge_pools()[0];
  std::vector<std::unique_ptr<DerivedStore>> derived;
  for (std::size_t p = 0; p < problem.active().size(); ++p) {
    const VertexPool& vertices = *problem.graph().vertex_pools()[p];
    derived.push_back(vertices.make_derived(problem.active()[p]));
    vertices.derive(problem.active()[p], drive.workspace().state().data(), *derived.back());
  }
  Scratch scratch;
  scratch.reserve(problem.scratch_bytes());
  const Evaluation x{drive.workspace().state().data(), derived, &scratch};
  const CompiledEdges& compiled = problem.edges()[0];
  const int all = problem.edge_count();
  for (auto _ : run) {
    const Cost cost = linearise
                          ? pool.linearise(compiled, 0, all, x, drive.workspace().hessian().data(),
                                           drive.workspace().gradient().data())
                          : pool.cost(compiled, 0, all, x);
    benchmark::DoNotOptimize(cost.chi2);
    benchmark::ClobberMemory();
  }
  const double edges = problem.edge_count();
  run.counters["edges"] = edges;
  run.counters["rows"] = problem.residual_count() / edges;
  run.counters["ns_per_edge"] = benchmark::Counter(
      1e-9 * edges, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void JointLimits(benchmark::State& run, bool linearise, double margin) {
  Drive drive(true);
  drive.add_unary(EdgeJointLimits(drive.model(), margin, 1e4));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(JointLimits, error, false, 0.01);
BENCHMARK_CAPTURE(JointLimits, linearise, true, 0.01);
BENCHMARK_CAPTURE(JointLimits, linearise_all_violated, true, 10.0);

void VelocityLimits(benchmark::State& run, bool linearise, double fraction) {
  Drive drive(true);
  drive.add_binary(EdgeVelocityLimits(drive.model(), fraction, 0.5, 0.5, 1e4));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(VelocityLimits, error, false, 0.95);
BENCHMARK_CAPTURE(VelocityLimits, linearise, true, 0.95);
BENCHMARK_CAPTURE(VelocityLimits, linearise_all_violated, true, -1.0);

void AccelerationLimits(benchmark::State& run, bool linearise, double limit) {
  Drive drive(true);
  drive.add_ternary(EdgeAccelerationLimits(drive.model(), limit, limit, limit, 1.0));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(AccelerationLimits, error, false, 20.0);
BENCHMARK_CAPTURE(AccelerationLimits, linearise, true, 20.0);
BENCHMARK_CAPTURE(AccelerationLimits, linearise_violated_where_it_moves, true, 1e-9);

void VelocityLimitsOverSteps(benchmark::State& run, bool linearise, LimitKind kind) {
  Drive drive(true);
  drive.add_steps();
  const Robot& robot = drive.model();
  if (kind == LimitKind::kHinged) {
    drive.add_over_one_step(EdgeVelocityLimitsTimed(robot, 0.95, 0.5, 0.5, 1e4));
  } else {
    drive.add_over_one_step(EdgeVelocityLimitsTimedSigned(robot, 0.95, 0.5, 0.5, 1e4));
  }
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(VelocityLimitsOverSteps, error, false, LimitKind::kHinged);
BENCHMARK_CAPTURE(VelocityLimitsOverSteps, linearise, true, LimitKind::kHinged);
BENCHMARK_CAPTURE(VelocityLimitsOverSteps, linearise_signed, true, LimitKind::kSigned);

void AccelerationLimitsOverSteps(benchmark::State& run, bool linearise, LimitKind kind) {
  Drive drive(true);
  drive.add_steps();
  const Eigen::VectorXd limits =
      Eigen::VectorXd::Constant(drive.model().active_joint_count() + 2, 20.0);
  if (kind == LimitKind::kHinged) {
    drive.add_over_two_steps(EdgeAccelerationLimitsTimed(limits, 1.0));
  } else {
    drive.add_over_two_steps(EdgeAccelerationLimitsTimedSigned(limits, 1.0));
  }
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(AccelerationLimitsOverSteps, error, false, LimitKind::kHinged);
BENCHMARK_CAPTURE(AccelerationLimitsOverSteps, linearise, true, LimitKind::kHinged);
BENCHMARK_CAPTURE(AccelerationLimitsOverSteps, linearise_signed, true, LimitKind::kSigned);

template <class E>
void OnTimeStep(benchmark::State& run, bool linearise, const E& edge) {
  Drive drive(true);
  drive.add_steps();
  drive.add_to_steps(edge);
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(OnTimeStep, duration_linearise, true, EdgeDuration(1.0));
BENCHMARK_CAPTURE(OnTimeStep, limits_linearise, true, EdgeTimeStepLimits(0.01, 0.1, 1e4));

void ObstacleDistance(benchmark::State& run, bool linearise, bool with_map, double margin_m) {
  Drive drive(with_map);
  drive.add_unary(EdgeObstacleDistance(drive.robot(), kWorld, margin_m, 1e4));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(ObstacleDistance, map_error, false, true, 0.05);
BENCHMARK_CAPTURE(ObstacleDistance, map_linearise, true, true, 0.05);
BENCHMARK_CAPTURE(ObstacleDistance, map_linearise_margin_0_5_m, true, true, 0.5);
BENCHMARK_CAPTURE(ObstacleDistance, four_obstacles_error, false, false, 0.05);
BENCHMARK_CAPTURE(ObstacleDistance, four_obstacles_linearise, true, false, 0.05);

void SelfCollision(benchmark::State& run, bool linearise, double margin_m) {
  Drive drive(true);
  drive.add_unary(EdgeSelfCollision(drive.robot(), margin_m, 1e4));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(SelfCollision, error, false, 0.01);
BENCHMARK_CAPTURE(SelfCollision, linearise, true, 0.01);
BENCHMARK_CAPTURE(SelfCollision, linearise_margin_0_1_m, true, 0.1);

void SweptObstacleDistance(benchmark::State& run, bool linearise, bool with_map, double margin_m,
                           int samples) {
  Drive drive(with_map);
  drive.add_binary(EdgeSweptObstacleDistance(drive.robot(), kWorld, margin_m, samples, 1e4));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(SweptObstacleDistance, map_error, false, true, 0.05, 2);
BENCHMARK_CAPTURE(SweptObstacleDistance, map_linearise, true, true, 0.05, 2);
BENCHMARK_CAPTURE(SweptObstacleDistance, map_linearise_margin_0_5_m, true, true, 0.5, 2);
BENCHMARK_CAPTURE(SweptObstacleDistance, map_linearise_8_samples, true, true, 0.05, 8);
BENCHMARK_CAPTURE(SweptObstacleDistance, four_obstacles_linearise, true, false, 0.05, 2);

void WheelContact(benchmark::State& run, bool linearise) {
  Drive drive(true);
  for (int i = kWheels; i < kWheels + 4; ++i) {
    drive.add_unary(EdgeContact(drive.contact(i), i, 1e5));
  }
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(WheelContact, error, false);
BENCHMARK_CAPTURE(WheelContact, linearise, true);

void Contact(benchmark::State& run, bool linearise, ContactKind kind, bool forward) {
  Drive drive(true);
  drive.set_contact(kHeld, "wheel_1", kind, forward);
  drive.add_unary(EdgeContact(drive.contact(kHeld), kHeld, 1e5));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(Contact, surface_error, false, ContactKind::kSurface, true);
BENCHMARK_CAPTURE(Contact, surface_linearise, true, ContactKind::kSurface, true);
BENCHMARK_CAPTURE(Contact, surface_free_yaw_linearise, true, ContactKind::kSurface, false);
BENCHMARK_CAPTURE(Contact, point_error, false, ContactKind::kPoint, true);
BENCHMARK_CAPTURE(Contact, point_linearise, true, ContactKind::kPoint, true);
BENCHMARK_CAPTURE(Contact, rung_linearise, true, ContactKind::kGrasp, true);

void FramePose(benchmark::State& run, bool linearise) {
  Drive drive(true);
  drive.add_unary(
      EdgeFramePose(kFrame, Eigen::Isometry3d::Identity(), Eigen::Matrix<double, 6, 1>::Ones()));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(FramePose, error, false);
BENCHMARK_CAPTURE(FramePose, linearise, true);

void Com(benchmark::State& run, bool linearise) {
  Drive drive(true);
  drive.add_unary(EdgeCom(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(Com, error, false);
BENCHMARK_CAPTURE(Com, linearise, true);

void Rolling(benchmark::State& run, bool linearise) {
  Drive drive(true);
  drive.add_binary(EdgeRolling(drive.stance(), kStance, 1e5));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(Rolling, error, false);
BENCHMARK_CAPTURE(Rolling, linearise, true);

void SteeringSlip(benchmark::State& run, bool linearise) {
  Drive drive(true);
  drive.add_binary(EdgeSteeringSlip(drive.stance(), kStance, 0.0, 1e4));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(SteeringSlip, error, false);
BENCHMARK_CAPTURE(SteeringSlip, linearise, true);

void PlanTracking(benchmark::State& run, bool linearise) {
  Drive drive(true);
  Eigen::VectorXd reference = drive.model().named_configuration("home");
  reference.segment<4>(3) << 0.01, -0.02, 0.03, 1.0;
  reference.segment<4>(3).normalize();
  drive.add_unary(EdgePlanTracking(reference, Eigen::VectorXd::Ones(drive.model().tangent_size())));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(PlanTracking, error, false);
BENCHMARK_CAPTURE(PlanTracking, linearise, true);

void VelocityTracking(benchmark::State& run, bool linearise) {
  Drive drive(true);
  const int n = drive.model().tangent_size();
  drive.add_binary(EdgeVelocityTracking(Eigen::VectorXd::Zero(n), Eigen::VectorXd::Ones(n)));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(VelocityTracking, error, false);
BENCHMARK_CAPTURE(VelocityTracking, linearise, true);

void Balance(benchmark::State& run, bool linearise) {
  Drive drive(true);
  drive.add_wrenches();
  drive.add_with_wrenches(EdgeBalance(1.0, 100.0));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(Balance, error, false);
BENCHMARK_CAPTURE(Balance, linearise, true);

void TorqueLimits(benchmark::State& run, bool linearise, double fraction) {
  Drive drive(true);
  drive.add_wrenches();
  drive.add_with_wrenches(EdgeTorqueLimits(drive.model(), fraction, 1.0));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(TorqueLimits, error, false, 1.0);
BENCHMARK_CAPTURE(TorqueLimits, linearise, true, 1.0);
BENCHMARK_CAPTURE(TorqueLimits, linearise_all_violated, true, 1e-6);

void ContactWrench(benchmark::State& run, bool linearise) {
  Drive drive(true);
  drive.add_wrenches();
  drive.add_to_wrenches(EdgeContactWrench(*drive.wrenches().contacts, 1.0));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(ContactWrench, error, false);
BENCHMARK_CAPTURE(ContactWrench, linearise, true);

void WrenchNorm(benchmark::State& run, bool linearise) {
  Drive drive(true);
  drive.add_wrenches();
  drive.add_to_wrenches(EdgeWrenchNorm(drive.wrenches(), 1e-6));
  measure(run, drive, linearise);
}
BENCHMARK_CAPTURE(WrenchNorm, error, false);
BENCHMARK_CAPTURE(WrenchNorm, linearise, true);

/// Kinematics and sphere centres of one configuration.
void Derive(benchmark::State& run) {
  Drive drive(true);
  ConfigurationState state(std::make_shared<const RobotParameter>(drive.robot()));
  const Eigen::VectorXd q = drive.model().named_configuration("home");
  for (auto _ : run) {
    state.update(q.data());
    benchmark::DoNotOptimize(state.sphere_centres.data());
    benchmark::ClobberMemory();
  }
  run.counters["spheres"] = static_cast<double>(state.sphere_centres.rows());
}
BENCHMARK(Derive);

}  // namespace

BENCHMARK_MAIN();
