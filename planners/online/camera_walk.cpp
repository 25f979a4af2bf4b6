#include <locograph/check/motion_curve.h>
#include <locograph/common/deadline.h>
#include <locograph/common/error.h>
#include <locograph/planners/online/camera_walk.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace locograph {
namespace {

constexpr double kConfigurations_s = 0.01;

Judging known_beforehand(Judging judging, const Perception& perception) {
  judging.world = perception.newest();
  return judging;
}

}  // namespace

void CameraWalkOptions::validate() const {
  if (!(slower >= 1.0 && std::isfinite(slower))) throw Error("slower is below 1", "1 or more");
  if (!(ahead_s >= 0.0)) throw Error("ahead_s is negative", "0 or more");
}

CameraWalk::CameraWalk(const Graph& graph, const Judging& judging, Perception& perception,
                       ImageSource& images, const CameraWalkOptions& options)
    : graph_(graph),
      plan_(plan_of(graph)),
      judging_(known_beforehand(judging, perception)),
      perception_(perception),
      images_(images),
      options_(options),
      check_known_(step_check(judging_)),
      state_(perception.robot()) {
  options.validate();
  const int size = plan_.robot->robot->configuration_size();
  if (perception.robot().configuration_size() != size) {
    throw Error("cameras on a robot with " +
                    std::to_string(perception.robot().configuration_size()) + " coordinates",
                "the plan's, with " + std::to_string(size));
  }
}

const VertexConfiguration& CameraWalk::vertex(int i) const {
  return graph_.vertex(VertexId<VertexConfiguration>{plan_.slots[static_cast<std::size_t>(i)]});
}

std::shared_ptr<const WorldSnapshot> CameraWalk::world_at(int executed) {
  if (executed == shown_to_) {
    plan_ = plan_of(graph_);  // it was planned on from here
    return perception_.newest();
  }
  shown_to_ = executed;
  if (executed == 0) {
    stand();
  } else {
    step_to(executed);
  }
  return perception_.newest();
}

World CameraWalk::seen() const {
  return perception_.seen_near(perception_.field()->window().bounds());
}

std::shared_ptr<const WorldSnapshot> CameraWalk::world_from(double time_s,
                                                            const Eigen::VectorXd& q) {
  if (std::isnan(is_at_s_)) {
    stand();
    is_at_s_ = vertex(0).time_s;
    is_at_ = vertex(0).state;
  }
  if (time_s < is_at_s_ + kConfigurations_s) return perception_.newest();
  perception_.configuration(time_s, q);
  show_until(time_s, [&](double at_s, Eigen::VectorXd& where) {
    const Robot& robot = perception_.robot();
    Eigen::VectorXd moves(robot.tangent_size());
    robot.difference(is_at_.data(), q.data(), moves.data());
    moves *= (at_s - is_at_s_) / (time_s - is_at_s_);
    robot.integrate(is_at_.data(), moves.data(), where.data());
  });
  is_at_s_ = time_s;
  is_at_ = q;
  return perception_.newest();
}

void CameraWalk::stand() {
  const double start_s = vertex(0).time_s, first_s = images_.next_stamp_s();
  const Eigen::VectorXd q = vertex(0).state;
  perception_.stand(q);
  if (first_s < start_s) perception_.configuration(first_s, q);
  perception_.configuration(start_s, q);
  show_until(start_s, [&](double, Eigen::VectorXd& where) { where = q; });
}

void CameraWalk::step_to(int executed) {
  const Motion motion = motion_of(graph_, plan_, executed - 1, executed);
  const double from_s = motion.time_s[0], to_s = motion.time_s[1];
  const MotionCurve curve(perception_.robot(), motion);
  const CurveStep step = curve.step(0);
  const auto where = [&](double time_s, Eigen::VectorXd& q) {
    step.configuration(std::clamp((time_s - from_s) / (to_s - from_s), 0.0, 1.0), q);
  };
  Eigen::VectorXd q(perception_.robot().configuration_size());
  const int parts = std::max(1, static_cast<int>(std::ceil((to_s - from_s) / kConfigurations_s)));
  for (int k = 1; k <= parts && !stopped(); ++k) {
    const double time_s = k == parts ? to_s : from_s + (to_s - from_s) * k / parts;
    where(time_s, q);
    perception_.configuration(time_s, q);
    show_until(time_s, where);  // a step may take longer than configurations are kept
  }
}

void CameraWalk::show_until(double time_s,
                            const std::function<void(double, Eigen::VectorXd&)>& where) {
  Eigen::VectorXd q(perception_.robot().configuration_size());
  while (images_.next_stamp_s() <= time_s && !stopped()) {
    Stopwatch watch;
    where(images_.next_stamp_s(), q);
    state_.update(q.data());
    DepthImage image = images_.take(state_);
    images_s_ += watch.lap();
    try {
      perception_.image(std::move(image));
      perception_s_.push_back(watch.seconds());
    } catch (const Error& error) {
      ++refused_;
      last_refusal_ = error.what();
    }
  }
}

Eigen::AlignedBox3d CameraWalk::around(const Motion& motion) const {
  constexpr double kAround_m = 0.3;
  RobotState state(*plan_.robot->robot);
  Eigen::AlignedBox3d box;
  for (const Eigen::VectorXd& q : motion.configurations) {
    state.update(q.data());
    for (const RobotParameter::LinkBound& bound : plan_.robot->bounds) {
      const Eigen::Vector3d centre = state.world_from_link(bound.link) * bound.center;
      box.extend(Eigen::Vector3d(centre.array() - bound.radius - kAround_m));
      box.extend(Eigen::Vector3d(centre.array() + bound.radius + kAround_m));
    }
  }
  return box;
}

CheckReport CameraWalk::check_step(const Motion& motion) const {
  CheckReport report = check_known_(motion);
  const int last = static_cast<int>(motion.configurations.size()) - 1;
  if (!report.feasible || last < 1) return report;
  const MotionCurve curve(*judging_.robot, motion);
  const Motion step = part_of(curve, last - 1, last);
  Judging seen = judging_;
  seen.world = std::make_shared<const WorldSnapshot>(perception_.seen_near(around(step)));
  return step_check(seen)(step);
}

bool CameraWalk::touches_unknown(const RobotState& state) const {
  const WorldDistance& seen = perception_.newest()->distance();
  return std::ranges::any_of(plan_.robot->spheres, [&](const CollisionSphere& sphere) {
    const Eigen::Vector3d centre = state.world_from_link(sphere.link) * sphere.center;
    if (!seen.is_known(centre)) return true;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d out = sphere.radius * Eigen::Vector3d::Unit(axis);
      if (!seen.is_known(centre + out) || !seen.is_known(centre - out)) return true;
    }
    return false;
  });
}

double CameraWalk::pace(int executed) const {
  if (perception_.options().map.unknown != UnknownSpace::kSlow) return 1.0;
  RobotState state(*plan_.robot->robot);
  const double until_s = vertex(executed).time_s + options_.ahead_s;
  for (int i = executed + 1; i < static_cast<int>(plan_.slots.size()); ++i) {
    state.update(vertex(i).state.data());
    if (touches_unknown(state)) return options_.slower;
    if (vertex(i).time_s >= until_s) break;
  }
  return 1.0;
}

}  // namespace locograph
