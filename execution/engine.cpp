#include <locograph/common/error.h>
#include <locograph/execution/engine.h>
#include <locograph/robots/kinematic_tree.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace locograph {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
struct DeleteFiles {
  void operator()(mjVFS* files) const {
    mj_deleteVFS(files);
    delete files;
  }
};

using Model = std::unique_ptr<mjModel, DeleteModel>;
using Data = std::unique_ptr<mjData, DeleteData>;

void ignore_warning(const char*) {}

Model compile(const std::string& text) {
  // MuJoCo would write them to a file in the working folder; Engine::diverged() tells what matters.
  mju_user_warning = ignore_warning;
  std::unique_ptr<mjVFS, DeleteFiles> files(new mjVFS);
  mj_defaultVFS(files.get());
  const char* name = "model.xml";
  mj_makeEmptyFileVFS(files.get(), name, static_cast<int>(text.size()));
  const int file = mj_findFileVFS(files.get(), name);
  if (file < 0) throw Error("no memory for a model of MuJoCo");
  std::memcpy(files->filedata[file], text.data(), text.size());
  char message[1000] = "";
  Model model(mj_loadXML(name, files.get(), message, sizeof message));
  if (!model) throw Error("MuJoCo refuses the model: " + std::string(message));
  return model;
}

int id_of(const mjModel& model, mjtObj type, const std::string& name) {
  return mj_name2id(&model, type, name.c_str());
}

/// Between MuJoCo's coordinates and ours, the one place that knows both. MuJoCo has quaternions
/// w x y z, the linear velocity of a floating base along the axes of the world, its angular
/// velocity along those of the base, and joints in an order of its own.
class Coordinates {
 public:
  Coordinates(const Robot& robot, const mjModel& model) : robot_(&robot) {
    for (int i = 0; i < robot.base_tangent_size(); ++i) dof_.push_back(i);
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      for (const int axis : robot.axes_of(i)) {
        const int joint = id_of(model, mjOBJ_JOINT, "axis_" + std::to_string(axis));
        const Axis& of = robot.axes()[static_cast<std::size_t>(axis)];
        const int position = model.jnt_qposadr[joint], dof = model.jnt_dofadr[joint];
        if (axis == robot.axes_of(i).front()) {
          position_.push_back(position);
          dof_.push_back(dof);
        } else {
          followers_.push_back({position, dof, i, of.multiplier, of.offset});
        }
      }
    }
  }

  void set_positions(const Eigen::VectorXd& q, double* positions) const {
    if (robot_->floating_base()) {
      const double base[] = {q[0], q[1], q[2], q[6], q[3], q[4], q[5]};
      std::copy(std::begin(base), std::end(base), positions);
    }
    for (std::size_t i = 0; i < position_.size(); ++i) {
      positions[position_[i]] = q[robot_->base_configuration_size() + static_cast<int>(i)];
    }
    for (const Follower& own : followers_) {
      positions[own.position] =
          own.multiplier * q[robot_->base_configuration_size() + own.active] + own.offset;
    }
  }

  Eigen::VectorXd configuration(const double* positions) const {
    Eigen::VectorXd q(robot_->configuration_size());
    if (robot_->floating_base()) {
      q.head<3>() << positions[0], positions[1], positions[2];
      q.segment<4>(3) << positions[4], positions[5], positions[6], positions[3];
      q.segment<4>(3).normalize();
    }
    for (std::size_t i = 0; i < position_.size(); ++i) {
      q[robot_->base_configuration_size() + static_cast<int>(i)] = positions[position_[i]];
    }
    return q;
  }

  /// From a tangent of ours.
  Eigen::VectorXd dofs(const double* positions, const Eigen::VectorXd& tangent) const {
    Eigen::VectorXd result(dof_.size() + followers_.size());
    for (std::size_t i = 0; i < dof_.size(); ++i) {
      result[dof_[i]] = tangent[static_cast<Eigen::Index>(i)];
    }
    for (const Follower& own : followers_) {
      result[own.dof] = own.multiplier * tangent[robot_->base_tangent_size() + own.active];
    }
    if (robot_->floating_base()) result.head<3>() = rotation(positions) * tangent.head<3>();
    return result;
  }

  Eigen::VectorXd tangent(const double* positions, const Eigen::VectorXd& dofs) const {
    return own_rows(positions, dofs);
  }

  /// Of forces, and matrices of such columns: one row for each entry of our tangent, what acts on
  /// mimic joints acts on the ones that they follow.
  Eigen::MatrixXd force_rows(const double* positions, const Eigen::MatrixXd& dofs) const {
    Eigen::MatrixXd result = own_rows(positions, dofs);
    for (const Follower& own : followers_) {
      result.row(robot_->base_tangent_size() + own.active) += own.multiplier * dofs.row(own.dof);
    }
    return result;
  }

  /// d/dt of dofs() at a constant tangent: the linear velocity turns with the base.
  Eigen::VectorXd drift(const double* positions, const Eigen::VectorXd& tangent) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(dof_.size() + followers_.size());
    if (robot_->floating_base()) {
      const Eigen::Vector3d linear = tangent.head<3>(), angular = tangent.segment<3>(3);
      result.head<3>() = rotation(positions) * angular.cross(linear);
    }
    return result;
  }

 private:
  /// A mimic joint.
  struct Follower {
    int position, dof;  ///< MuJoCo's
    int active;         ///< that it follows
    double multiplier, offset;
  };

  Eigen::MatrixXd own_rows(const double* positions, const Eigen::MatrixXd& dofs) const {
    Eigen::MatrixXd result(dof_.size(), dofs.cols());
    for (std::size_t i = 0; i < dof_.size(); ++i) {
      result.row(static_cast<Eigen::Index>(i)) = dofs.row(dof_[i]);
    }
    if (robot_->floating_base()) {
      result.topRows(3) = rotation(positions).transpose() * dofs.topRows(3);
    }
    return result;
  }

  static Eigen::Matrix3d rotation(const double* positions) {
    return Eigen::Quaterniond(positions[3], positions[4], positions[5], positions[6])
        .normalized()
        .toRotationMatrix();
  }

  const Robot* robot_;
  std::vector<int> position_;  // of each active joint among MuJoCo's positions
  std::vector<int> dof_;       // of each entry of the tangent among MuJoCo's velocities
  std::vector<Follower> followers_;
};

void require_numbers(const std::string& what, const Eigen::VectorXd& numbers, int expected) {
  if (numbers.size() != expected) {
    throw Error(what + " of " + std::to_string(numbers.size()) + " numbers",
                std::to_string(expected));
  }
  if (!numbers.allFinite()) throw Error(what + " with a number that is not finite");
}

void require_index(const std::string& what, int index, std::size_t count) {
  if (index < 0 || static_cast<std::size_t>(index) >= count) {
    throw Error(what + " " + std::to_string(index),
                "0 to " + std::to_string(count) + ", exclusive");
  }
}

}  // namespace

class Engine::Implementation {
 public:
  Implementation(const Robot& robot, std::span<const EndEffector> effectors, const World& world,
                 const MujocoModelOptions& options)
      : robot(robot),
        model(compile(mujoco_model(robot, effectors, world, options))),
        data(mj_makeData(model.get())),
        coordinates(robot, *model),
        forces(effectors.size(), Eigen::Vector3d::Zero()),
        moments(effectors.size(), Eigen::Vector3d::Zero()) {
    if (!data) throw Error("no memory for a state of MuJoCo");
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      motor.push_back(id_of(*model, mjOBJ_ACTUATOR, "motor_" + std::to_string(i)));
    }
    effector_of_geom.assign(static_cast<std::size_t>(model->ngeom), -1);
    for (std::size_t i = 0; i < effectors.size(); ++i) {
      const int geom = id_of(*model, mjOBJ_GEOM, "effector_" + std::to_string(i));
      if (geom >= 0) effector_of_geom[static_cast<std::size_t>(geom)] = static_cast<int>(i);
    }
    for (std::size_t b = 0; b < robot.tree().bodies.size(); ++b) {
      body.push_back(id_of(*model, mjOBJ_BODY, "body_" + std::to_string(b)));
    }
    for (std::size_t i = 0; i < effectors.size(); ++i) {
      const EndEffector& effector = effectors[i];
      const int link = robot.link_index(effector.link);
      const int at = robot.tree().body_of_link[static_cast<std::size_t>(link)];
      const Eigen::Isometry3d body_from_link = robot.tree().body_from_link(link);
      points.emplace_back(body[static_cast<std::size_t>(at)], body_from_link * effector.point);
      Grasp& grasp = grasps.emplace_back();
      if (effector.kind != ContactKind::kGrasp) continue;
      grasp.bar = body_from_link.linear() * axes_in_link(effector).col(1);
      const std::string name = "grasp_" + std::to_string(i);
      grasp.first = id_of(*model, mjOBJ_EQUALITY, name + "_0");
      grasp.second = id_of(*model, mjOBJ_EQUALITY, name + "_1");
      if (grasp.second >= 0) grasp.half_m = kGraspHalf_m;
    }
    for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
      if (is_at_rest(world.obstacles[i])) continue;
      const std::string name = "obstacle_" + std::to_string(i);
      const int at = id_of(*model, mjOBJ_BODY, name);
      moving.push_back(
          {world.obstacles[i], id_of(*model, mjOBJ_GEOM, name), model->body_mocapid[at]});
    }
    set_obstacle_time(0.0);
    mj_forward(model.get(), data.get());
  }

  void set_obstacle_time(double time_s) {
    for (const Moving& own : moving) {
      model->geom_conaffinity[own.geom] = own.obstacle.is_there(time_s) ? 1 : 0;
      const int at = own.mocap;
      const Eigen::Isometry3d pose = own.obstacle.pose_at(time_s);
      const Eigen::Quaterniond q(pose.linear());
      const double wxyz[] = {q.w(), q.x(), q.y(), q.z()};
      std::copy(pose.translation().begin(), pose.translation().end(), data->mocap_pos + 3 * at);
      std::copy(std::begin(wxyz), std::end(wxyz), data->mocap_quat + 4 * at);
    }
  }

  /// Throws for an end effector that is no grasp.
  void grasp(std::size_t effector, const Eigen::Vector3d& held, const Eigen::Vector3d& axis) {
    refresh();
    const Grasp& own = grasps[effector];
    const int at = points[effector].first;
    const Eigen::Vector3d in_body = points[effector].second;
    if (own.first < 0) throw Error("end effector " + std::to_string(effector) + " is no grasp");
    Eigen::Vector3d along = axis.normalized();
    if (along.dot(rotation(at) * own.bar) < 0.0) along = -along;
    const auto hold = [&](int equality, double aside_m) {
      if (equality < 0) return;
      const Eigen::Vector3d hand = in_body + aside_m * own.bar, bar = held + aside_m * along;
      double* numbers = model->eq_data + mjNEQDATA * equality;
      std::copy(hand.begin(), hand.end(), numbers);
      std::copy(bar.begin(), bar.end(), numbers + 3);
      model->eq_active[equality] = 1;
    };
    hold(own.first, -own.half_m);
    hold(own.second, own.half_m);
  }

  void release(std::size_t effector) {
    const Grasp& own = grasps[effector];
    for (const int equality : {own.first, own.second}) {
      if (equality >= 0) model->eq_active[equality] = 0;
    }
  }

  /// A step leaves what MuJoCo derives from the state as it was before: brought up to date when it
  /// is asked for.
  void refresh() {
    if (!stale) return;
    mj_fwdPosition(model.get(), data.get());
    mj_fwdVelocity(model.get(), data.get());
    stale = false;
  }

  void measure_forces() {
    std::fill(forces.begin(), forces.end(), Eigen::Vector3d::Zero());
    std::fill(moments.begin(), moments.end(), Eigen::Vector3d::Zero());
    total.setZero();
    other = {};
    measure_grasps();
    for (int i = 0; i < data->ncon; ++i) {
      const mjContact& contact = data->contact[i];
      if (contact.efc_address < 0) continue;
      double wrench[6];
      mj_contactForce(model.get(), data.get(), i, wrench);
      // The rows of the frame are its axes; the force is that of geom1 on geom2.
      const Eigen::Map<const Eigen::Matrix3d> world_from_contact(contact.frame);
      Eigen::Vector3d force = world_from_contact * Eigen::Map<const Eigen::Vector3d>(wrench);
      Eigen::Vector3d moment = world_from_contact * Eigen::Map<const Eigen::Vector3d>(wrench + 3);
      int geom = contact.geom2;
      if (is_robots(contact.geom1) && is_robots(geom)) {
        if (wrench[0] > other.pressing_N) {
          other = {wrench[0], link_of_body(model->geom_bodyid[contact.geom1]),
                   link_of_body(model->geom_bodyid[geom])};
        }
        continue;
      }
      if (!is_robots(geom)) {
        geom = contact.geom1;
        force = -force;
        moment = -moment;
      }
      total += force;
      const int effector = effector_of_geom[static_cast<std::size_t>(geom)];
      if (effector >= 0) {
        const auto e = static_cast<std::size_t>(effector);
        forces[e] += force;
        moments[e] +=
            moment + (Eigen::Map<const Eigen::Vector3d>(contact.pos) - point(e)).cross(force);
      } else if (wrench[0] > other.pressing_N) {
        other = {wrench[0], link_of_body(model->geom_bodyid[geom]), -1};
      }
    }
  }

  bool is_robots(int geom) const {
    return std::ranges::find(body, model->geom_bodyid[geom]) != body.end();
  }

  /// The three rows of a held point are its force on the hand, along the axes of the world.
  void measure_grasps() {
    for (std::size_t e = 0; e < grasps.size(); ++e) {
      const Grasp& own = grasps[e];
      if (own.first < 0 || !model->eq_active[own.first]) continue;
      for (int row = 0; row < data->ne; ++row) {
        const bool first = data->efc_id[row] == own.first;
        if (data->efc_type[row] != mjCNSTR_EQUALITY || (!first && data->efc_id[row] != own.second))
          continue;
        const Eigen::Map<const Eigen::Vector3d> force(data->efc_force + row);
        const Eigen::Vector3d arm =
            rotation(points[e].first) * own.bar * (first ? -own.half_m : own.half_m);
        forces[e] += force;
        moments[e] += arm.cross(force);
        total += force;
        row += 2;
      }
    }
  }

  Eigen::Matrix3d rotation(int mujoco_body) const {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->xmat +
                                                                          9 * mujoco_body);
  }

  /// Of an end effector, in the world, when MuJoCo looked for contacts.
  Eigen::Vector3d point(std::size_t effector) const {
    const auto& [at, in_body] = points[effector];
    return rotation(at) * in_body + Eigen::Map<const Eigen::Vector3d>(data->xpos + 3 * at);
  }

  int link_of_body(int mujoco_body) const {
    const auto at = std::find(body.begin(), body.end(), mujoco_body);
    return robot.tree().link_of_body[static_cast<std::size_t>(at - body.begin())];
  }

  Eigen::MatrixXd force_rows(const Eigen::MatrixXd& dofs) const {
    return coordinates.force_rows(data->qpos, dofs);
  }

  Eigen::VectorXd velocity() const {
    return coordinates.tangent(data->qpos,
                               Eigen::Map<const Eigen::VectorXd>(data->qvel, model->nv));
  }

  Eigen::VectorXd inverse_dynamics(const Eigen::VectorXd& acceleration) {
    refresh();
    const Eigen::VectorXd dofs =
        coordinates.dofs(data->qpos, acceleration) + coordinates.drift(data->qpos, velocity());
    std::copy(dofs.begin(), dofs.end(), data->qacc);
    Eigen::VectorXd torques(model->nv);
    mj_rne(model.get(), data.get(), 1, torques.data());
    return force_rows(torques);
  }

  /// Of an end effector that is no grasp there are none.
  struct Grasp {
    int first = -1, second = -1;                    ///< the equalities; -1: none
    double half_m = 0.0;                            ///< of the way between them
    Eigen::Vector3d bar = Eigen::Vector3d::Zero();  ///< in the body
  };

  struct Moving {
    Obstacle obstacle;
    int geom, mocap;  ///< MuJoCo's
  };

  const Robot& robot;
  Model model;
  Data data;
  Coordinates coordinates;
  std::vector<int> motor;                               // of each active joint, -1: none
  std::vector<int> effector_of_geom;                    // -1: none
  std::vector<int> body;                                // MuJoCo's, of each body of the tree
  std::vector<std::pair<int, Eigen::Vector3d>> points;  // of end effectors: MuJoCo's body, in it
  std::vector<Grasp> grasps;                            // of end effectors
  std::vector<Moving> moving;                           // obstacles that are not at rest
  std::vector<Eigen::Vector3d> forces, moments;
  Eigen::Vector3d total = Eigen::Vector3d::Zero();
  OtherTouch other;
  bool stale = false;
};

Engine::Engine(const Robot& robot, std::span<const EndEffector> effectors, const World& world,
               const MujocoModelOptions& options)
    : implementation_(std::make_unique<Implementation>(robot, effectors, world, options)) {}
Engine::~Engine() = default;
Engine::Engine(Engine&&) noexcept = default;
Engine& Engine::operator=(Engine&&) noexcept = default;

void Engine::set_state(const Eigen::VectorXd& configuration, const Eigen::VectorXd& velocity) {
  Implementation& own = *implementation_;
  require_numbers("a configuration", configuration, own.robot.configuration_size());
  require_numbers("a velocity", velocity, own.robot.tangent_size());
  if (own.robot.floating_base() && !(configuration.segment<4>(3).norm() > 1e-3)) {
    throw Error("a base whose quaternion is zero", "one of norm 1");
  }
  own.coordinates.set_positions(configuration, own.data->qpos);
  const Eigen::VectorXd dofs = own.coordinates.dofs(own.data->qpos, velocity);
  std::copy(dofs.begin(), dofs.end(), own.data->qvel);
  mj_forward(own.model.get(), own.data.get());
  own.measure_forces();
  own.stale = false;
}

void Engine::set_torques(const Eigen::VectorXd& torques) {
  Implementation& own = *implementation_;
  require_numbers("torques", torques, own.robot.active_joint_count());
  for (std::size_t i = 0; i < own.motor.size(); ++i) {
    if (own.motor[i] >= 0) own.data->ctrl[own.motor[i]] = torques[static_cast<Eigen::Index>(i)];
  }
}

void Engine::set_push(const Eigen::Vector3d& force) {
  require_numbers("a push", force, 3);
  double* applied = implementation_->data->xfrc_applied + 6 * implementation_->body.front();
  std::copy(force.begin(), force.end(), applied);
}

void Engine::set_obstacle_time(double time_s) { implementation_->set_obstacle_time(time_s); }

void Engine::grasp(int effector, const Eigen::Vector3d& point, const Eigen::Vector3d& axis) {
  require_index("end effector", effector, implementation_->grasps.size());
  require_numbers("a point of a bar", point, 3);
  require_numbers("the axis of a bar", axis, 3);
  implementation_->grasp(static_cast<std::size_t>(effector), point, axis);
}

void Engine::release(int effector) {
  require_index("end effector", effector, implementation_->grasps.size());
  implementation_->release(static_cast<std::size_t>(effector));
}

bool Engine::grasps(int effector) const {
  require_index("end effector", effector, implementation_->grasps.size());
  const auto& own = implementation_->grasps[static_cast<std::size_t>(effector)];
  return own.first >= 0 && implementation_->model->eq_active[own.first];
}

void Engine::step() {
  mj_step(implementation_->model.get(), implementation_->data.get());
  implementation_->measure_forces();
  implementation_->stale = true;
}

double Engine::time_s() const { return implementation_->data->time; }

bool Engine::diverged() const {
  const mjWarningStat* warning = implementation_->data->warning;
  for (const int kind :
       {mjWARN_CONTACTFULL, mjWARN_CNSTRFULL, mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
    if (warning[kind].number > 0) return true;
  }
  return false;
}

Eigen::VectorXd Engine::configuration() const {
  return implementation_->coordinates.configuration(implementation_->data->qpos);
}

Eigen::VectorXd Engine::velocity() const { return implementation_->velocity(); }

Eigen::Vector3d Engine::contact_force(int effector) const {
  require_index("end effector", effector, implementation_->forces.size());
  return implementation_->forces[static_cast<std::size_t>(effector)];
}

Eigen::Vector3d Engine::contact_moment(int effector) const {
  require_index("end effector", effector, implementation_->moments.size());
  return implementation_->moments[static_cast<std::size_t>(effector)];
}

Eigen::Vector3d Engine::total_contact_force() const { return implementation_->total; }

Engine::OtherTouch Engine::other_touch() const { return implementation_->other; }

double Engine::penetration_m() const {
  double deepest = 0.0;
  for (int i = 0; i < implementation_->data->ncon; ++i) {
    deepest = std::max(deepest, -implementation_->data->contact[i].dist);
  }
  return deepest;
}

Eigen::MatrixXd Engine::mass_matrix() const {
  Implementation& own = *implementation_;
  own.refresh();
  RowMajor full(own.model->nv, own.model->nv);
  mj_fullM(own.model.get(), full.data(), own.data->qM);
  return own.force_rows(own.force_rows(full).transpose());
}

Eigen::VectorXd Engine::bias_forces() const {
  return implementation_->inverse_dynamics(
      Eigen::VectorXd::Zero(implementation_->robot.tangent_size()));
}

Eigen::VectorXd Engine::inverse_dynamics(const Eigen::VectorXd& acceleration) const {
  require_numbers("an acceleration", acceleration, implementation_->robot.tangent_size());
  return implementation_->inverse_dynamics(acceleration);
}

Eigen::MatrixXd Engine::frame_jacobian(int link, const Eigen::Vector3d& point) const {
  Implementation& own = *implementation_;
  const KinematicTree& tree = own.robot.tree();
  require_index("link", link, tree.body_of_link.size());
  own.refresh();
  const int body_of_link = tree.body_of_link[static_cast<std::size_t>(link)];
  const int body = own.body[static_cast<std::size_t>(body_of_link)];
  const Eigen::Vector3d in_world = own.rotation(body) * (tree.body_from_link(link) * point) +
                                   Eigen::Map<const Eigen::Vector3d>(own.data->xpos + 3 * body);
  RowMajor jacobian(6, own.model->nv);
  mj_jac(own.model.get(), own.data.get(), jacobian.data(), jacobian.data() + 3 * own.model->nv,
         in_world.data(), body);
  return own.force_rows(jacobian.transpose()).transpose();
}

}  // namespace locograph
