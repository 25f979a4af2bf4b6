#pragma once
/// A robot read from URDF and SRDF: links, joints, collision shapes, configuration space.
/// Immutable.
///
///     locograph::Robot robot = locograph::Robot::load("centauro.urdf", "centauro.srdf");
///     Eigen::VectorXd q = robot.named_configuration("home");
///     Eigen::VectorXd step = Eigen::VectorXd::Zero(robot.tangent_size());
///     step[0] = 0.1;                                    // 0.1 m forward, in the base frame
///     robot.integrate(q.data(), step.data(), q.data());
///
/// Configuration, configuration_size(): base position x y z [m] and quaternion qx qy qz qw of
/// world_from_base (absent for a fixed base), then the active joints [rad or m].
/// Tangent, tangent_size(): linear and angular velocity of the base in the base frame, then the
/// active joint velocities. The base is links()[0]; without a floating base it is the world frame.
///
/// Links are numbered root first, depth first, children in the order of the URDF; joints()[i] is
/// the joint above links()[i + 1]. Active joints keep that order, whatever the order in
/// RobotOptions::active_joints. A `floating` joint directly below the URDF's root link stands for
/// the floating base: the link below it becomes the root and the link above it is dropped.
///
/// A mimic joint moves with the joint that it follows, multiplier * position + offset, and adds
/// nothing to the configuration. Where it follows another mimic joint, both follow the one that
/// leads them all. Its limits of position and velocity narrow those of the leader; its effort limit
/// means nothing, as the leader's drive moves it: torques of the leader include what its mimic
/// joints take. The axes of a robot are the joints that move with a configuration: the active ones
/// and the mimic joints of active ones, in the order of joints().
///
/// Every <collision> of the URDF is among the shapes of its link, or the file is refused with the
/// line of the one that cannot be read. Meshes are read by who needs them: missing_meshes().
///
/// Errors: locograph::Error with file and line for every unusable URDF or SRDF.
/// Thread-safety: const, freely shared.

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

struct KinematicTree;

enum class JointType { kFixed, kRevolute, kContinuous, kPrismatic };

struct Joint {
  std::string name;
  JointType type = JointType::kFixed;
  int parent_link = -1;
  int child_link = -1;
  Eigen::Isometry3d parent_from_joint = Eigen::Isometry3d::Identity();  ///< at position 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit, in the joint (= child link) frame
  double lower = 0.0;                               ///< rad or m; -infinity for continuous joints
  double upper = 0.0;                               ///< rad or m; +infinity for continuous joints
  double max_velocity = 0.0;     ///< rad/s or m/s; infinity if the URDF gives none
  double max_effort = 0.0;       ///< Nm or N; infinity if the URDF gives none
  int index = -1;                ///< position among the active joints, -1: fixed, frozen or mimic
  double frozen_position = 0.0;  ///< where a movable joint stands that no active one moves
  int mimics = -1;               ///< the joint that leads this mimic joint, -1: not a mimic joint
  double multiplier = 1.0;       ///< of the leader's position
  double offset = 0.0;           ///< rad or m
};

/// A joint that moves with the configuration: position = multiplier * that of an active joint
/// + offset.
struct Axis {
  int joint = -1;   ///< index into Robot::joints()
  int active = -1;  ///< the active joint that it is or follows
  double multiplier = 1.0;
  double offset = 0.0;
};

enum class ShapeType { kSphere, kCapsule, kCylinder, kBox, kMesh };

/// One collision shape. The axis of capsules and cylinders is the local z, the origin its middle.
struct CollisionShape {
  ShapeType type = ShapeType::kSphere;
  int link = -1;
  Eigen::Isometry3d link_from_shape = Eigen::Isometry3d::Identity();
  double radius = 0.0;  ///< m
  double length = 0.0;  ///< m; for a capsule: between the centres of its two end spheres
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< box: full extents [m]; mesh: scale
  std::filesystem::path mesh_file;  ///< resolved path, or as written in the URDF if not found
  bool mesh_found = false;
  int line = 0;  ///< of the <collision> element in the URDF
};

struct Link {
  std::string name;
  int parent_joint = -1;                              ///< -1 for the root
  double mass = 0.0;                                  ///< kg; 0 without <inertial>
  Eigen::Vector3d com = Eigen::Vector3d::Zero();      ///< m, link frame
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg m^2, about com, along the link axes
  int inertial_line = 0;  ///< of <inertial> in the URDF, of <link> if there is none
  std::vector<CollisionShape> collision;
  int collision_elements = 0;  ///< <collision> elements of the URDF; a capsule may be three
  bool visible = false;        ///< has a <visual>
};

/// An SRDF group, as the movable joints it stands for (indices into Robot::joints(), ascending).
struct JointGroup {
  std::string name;
  std::vector<int> joints;
};

/// An SRDF group_state: joints (indices into Robot::joints()) and their positions [rad or m].
struct GroupState {
  std::string name;
  std::vector<std::pair<int, double>> positions;
};

struct RobotOptions {
  bool floating_base = true;
  /// Names of joints, or of SRDF groups standing for all their movable joints. Empty: all movable
  /// joints. The others are frozen. Mimic joints are as their leaders are.
  std::vector<std::string> active_joints = {};
  /// SRDF group_state that says where frozen joints stand. A joint it does not name, and every
  /// joint when the SRDF has no "home", stands at its neutral position.
  std::string frozen_state = "home";
  /// Names in the SRDF that the URDF does not know become warnings() instead of an error.
  bool lenient_srdf = false;
};

class Robot {
 public:
  /// Without an SRDF there are no groups and no named configurations, and every pair of links that
  /// can move against each other is a self-collision pair.
  static Robot load(const std::filesystem::path& urdf, const std::filesystem::path& srdf = {},
                    const RobotOptions& options = {});

  const std::string& name() const { return name_; }
  const std::filesystem::path& urdf_file() const { return urdf_file_; }
  const std::filesystem::path& srdf_file() const { return srdf_file_; }  ///< empty if none
  const RobotOptions& options() const { return options_; }

  const std::vector<Link>& links() const { return links_; }
  const std::vector<Joint>& joints() const { return joints_; }
  int root_link() const { return 0; }
  /// Throws Error naming the most similar names if there is no such link or joint.
  int link_index(const std::string& name) const;
  int joint_index(const std::string& name) const;  ///< into joints(), fixed ones included
  /// -1 if there is no such link or joint.
  int find_link(const std::string& name) const;
  int find_joint(const std::string& name) const;

  int active_joint_count() const { return static_cast<int>(active_.size()); }
  const Joint& active_joint(int i) const { return joints_[static_cast<std::size_t>(active_[i])]; }
  const std::vector<Axis>& axes() const { return axes_; }
  /// Axes of an active joint (indices into axes()), its own first.
  std::span<const int> axes_of(int active) const;
  bool floating_base() const { return options_.floating_base; }
  int base_configuration_size() const { return floating_base() ? 7 : 0; }
  int base_tangent_size() const { return floating_base() ? 6 : 0; }
  int configuration_size() const { return base_configuration_size() + active_joint_count(); }
  int tangent_size() const { return base_tangent_size() + active_joint_count(); }

  /// Base at the identity, joints at 0 or at the limit nearest to 0.
  Eigen::VectorXd neutral_configuration() const;
  /// A group_state of the SRDF. Base at the identity; joints the state does not name are neutral.
  Eigen::VectorXd named_configuration(const std::string& group_state) const;
  /// How far the active joint that is nearest to a limit is from it [rad, m]; 0: at it, or beyond.
  double joint_room(const Eigen::VectorXd& configuration) const;
  std::vector<std::string> configuration_names() const;  ///< of the group states, sorted

  std::vector<std::string> group_names() const;  ///< sorted
  /// Movable joints of an SRDF group as indices into joints(), ascending.
  const std::vector<int>& group_joints(const std::string& group) const;

  /// out = q (+) tangent: p += R v, quaternion *= exp(omega), joints += . No allocation;
  /// out may be q. The quaternion is normalised.
  void integrate(const double* q, const double* tangent, double* out) const;
  /// Inverse of integrate: the tangent at `from` that leads to `to`, rotation angle <= pi.
  /// Joints are subtracted plainly, continuous ones too.
  void difference(const double* from, const double* to, double* tangent) const;

  /// Link pairs, first < second, that both have collision shapes, are not disabled in the SRDF and
  /// are not connected through fixed joints only.
  const std::vector<std::pair<int, int>>& self_collision_pairs() const { return pairs_; }
  /// Takes pairs out of them that nobody has disabled, as of links that always meet in a robot
  /// without an SRDF; those that are none of them change nothing.
  void leave_out_pairs(const std::vector<std::pair<int, int>>& pairs);
  const std::vector<std::pair<int, int>>& left_out_pairs() const { return left_out_; }

  /// Axes (indices into axes()) between root and link, root first.
  std::span<const int> support(int link) const;

  double total_mass() const { return total_mass_; }  ///< kg
  /// Without any there is nothing to tell distances by.
  bool has_collision_shapes() const;
  /// Throws Error naming the URDF where there are none.
  void require_collision_shapes() const;
  /// Links with something to see and nothing to collide, as they move by without touching.
  std::vector<std::string> links_without_collision() const;
  /// Collision meshes that could not be found, as written in the URDF, each once.
  std::vector<std::string> missing_meshes() const;
  /// What RobotOptions::lenient_srdf let pass, as FILE:LINE: text.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// What of the URDF is valid and can hardly be meant: limits without room, impossible inertias.
  const std::vector<std::string>& urdf_warnings() const { return urdf_warnings_; }

  /// Flat arrays for the kinematics; see kinematic_tree.h.
  const KinematicTree& tree() const { return *tree_; }

 private:
  Robot() = default;

  std::string name_;
  std::filesystem::path urdf_file_, srdf_file_;
  RobotOptions options_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::vector<int> active_;
  std::vector<Axis> axes_;
  std::vector<std::vector<int>> axes_of_active_;
  std::vector<JointGroup> groups_;
  std::vector<GroupState> states_;
  std::vector<std::pair<int, int>> pairs_, left_out_;
  std::vector<std::string> warnings_, urdf_warnings_;
  double total_mass_ = 0.0;
  std::shared_ptr<const KinematicTree> tree_;
};

}  // namespace locograph
