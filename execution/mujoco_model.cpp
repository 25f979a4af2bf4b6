#include <locograph/common/check_option.h>
#include <locograph/execution/mujoco_model.h>
#include <locograph/robots/body_inertia.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/statics.h>
#include <locograph/world/mesh_vertices.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <locale>
#include <map>
#include <sstream>

namespace locograph {
namespace {

constexpr double kSoleHalf_m = 0.01;    // half the thickness of soles
constexpr double kPlateHalf_m = 0.001;  // of surfaces, which the judge knows no thickness of
constexpr double kBarePoint_m = 0.005;  // radius of a point without one
constexpr double kEndless_m = 1000.0;   // half the length of a surface without an end
constexpr double kOtherFriction = 0.5;  // where neither world nor end effectors state any
constexpr double kBlock_m = 0.5;        // of a map, in one body
// Of contacts and equalities: near what integrating in steps of 1 ms allows.
constexpr const char* kStiff = " solref=\"0.004 1\" solimp=\"0.95 0.99 0.001 0.5 2\"";
constexpr double kLeastInertia = 1e-14;  // kg m^2; MuJoCo wants more than 1e-15

/// Of voxels: those from low to high, high excluded.
struct VoxelBox {
  std::array<int, 3> low, high;
};

/// The same voxels in fewer boxes: two that share a whole face become one.
void merge(std::vector<VoxelBox>& boxes) {
  for (std::size_t before = 0; before != boxes.size();) {
    before = boxes.size();
    for (std::size_t along = 0; along < 3; ++along) {
      const std::size_t a = (along + 1) % 3, b = (along + 2) % 3;
      const auto section = [a, b](const VoxelBox& box) {
        return std::array{box.low[a], box.high[a], box.low[b], box.high[b]};
      };
      std::ranges::sort(
          boxes, {}, [&](const VoxelBox& box) { return std::pair(section(box), box.low[along]); });
      std::size_t last = 0;
      for (std::size_t i = 1; i < boxes.size(); ++i) {
        if (section(boxes[i]) == section(boxes[last]) &&
            boxes[i].low[along] == boxes[last].high[along]) {
          boxes[last].high[along] = boxes[i].high[along];
        } else {
          boxes[++last] = boxes[i];
        }
      }
      if (!boxes.empty()) boxes.resize(last + 1);
    }
  }
}

class ModelWriter {
 public:
  ModelWriter(const Robot& robot, std::span<const EndEffector> effectors, const World& world,
              const MujocoModelOptions& options)
      : robot_(robot),
        tree_(robot.tree()),
        effectors_(effectors),
        world_(world),
        options_(options),
        inertias_(body_inertias(robot, options.link_mass_factors)) {
    text_.imbue(std::locale::classic());
    text_.precision(17);
    require_what_it_can_write();
  }

  std::string write() {
    write_options();
    write_meshes();
    text_ << "<worldbody>\n";
    write_world();
    write_body(0);
    text_ << "</worldbody>\n<contact>\n";
    write_self_contacts();
    text_ << "</contact>\n<actuator>\n";
    write_motors();
    text_ << "</actuator>\n<equality>\n";
    write_grasps();
    write_mimic_joints();
    text_ << "</equality>\n</mujoco>\n";
    return text_.str();
  }

 private:
  void require_what_it_can_write() const {
    for (const EndEffector& effector : effectors_) require_sound_effector(robot_, effector);
    std::string without;
    for (std::size_t b = robot_.floating_base() ? 0 : 1; b < inertias_.size(); ++b) {
      if (inertias_[b].mass > 0.0 && inertias_[b].inertia.trace() > 0.0) continue;
      without += (without.empty() ? "'" : ", '") + link_of(b).name + "'";
    }
    if (!without.empty()) {
      throw Error(robot_.urdf_file().string(), 0, "links without mass or inertia: " + without,
                  "an <inertial> on each link that moves");
    }
    require_solid_bodies(robot_, inertias_);
  }

  const Link& link_of(std::size_t body) const {
    return robot_.links()[static_cast<std::size_t>(tree_.link_of_body[body])];
  }

  int body_of(int link) const { return tree_.body_of_link[static_cast<std::size_t>(link)]; }

  void write_options() {
    text_ << "<mujoco>\n<compiler angle=\"radian\" inertiafromgeom=\"false\" "
          << "balanceinertia=\"false\" boundmass=\"0\" boundinertia=\"0\" fusestatic=\"false\"/>\n"
          << "<option timestep=\"" << options_.timestep_s << "\" gravity=\""
          << row(standard_gravity()) << "\" integrator=\""
          << (options_.integrator == Integrator::kEuler ? "Euler" : "RK4")
          << "\" solver=\"Newton\" iterations=\"50\" tolerance=\"1e-10\" cone=\"elliptic\" "
          << "impratio=\"10\">\n";
    if (!options_.constraints) text_ << "<flag constraint=\"disable\"/>\n";
    text_ << "</option>\n<size nconmax=\"200\" njmax=\"600\"/>\n"
          << "<default><geom condim=\"3\"" << kStiff << "/><equality" << kStiff << "/></default>\n";
  }

  void write_pose(const Eigen::Isometry3d& pose) {
    const Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
    text_ << " pos=\"" << row(pose.translation()) << "\" quat=\"" << q.w() << ' ' << q.x() << ' '
          << q.y() << ' ' << q.z() << '"';
  }

  struct Row {
    const Eigen::Vector3d v;
    friend std::ostream& operator<<(std::ostream& out, const Row& row) {
      return out << row.v.x() << ' ' << row.v.y() << ' ' << row.v.z();
    }
  };
  static Row row(const Eigen::Vector3d& v) { return {v}; }

  // What is stated, or the least of the end effectors.
  double friction_or_least(double stated) const {
    if (stated > 0.0) return stated;
    double least = std::numeric_limits<double>::infinity();
    for (const EndEffector& effector : effectors_) {
      if (effector.friction > 0.0) least = std::min(least, effector.friction);
    }
    return std::isfinite(least) ? least : kOtherFriction;
  }

  void end_world_geom(double friction) {
    text_ << " contype=\"0\" conaffinity=\"1\" friction=\""
          << options_.friction_factor * friction_or_least(friction) << " 0.005 0.0001\"/>\n";
  }

  void end_robot_geom() {
    text_ << " contype=\"1\" conaffinity=\"0\" friction=\"0 0.005 0.0001\"/>\n";
  }

  // Each thing is there once: the faces of a solid are part of it.
  void write_world() {
    for (std::size_t i = 0; i < world_.surfaces.size(); ++i) {
      const Surface& surface = world_.surfaces[i];
      if (std::any_of(world_.solids.begin(), world_.solids.end(),
                      [&](const SolidBox& box) { return is_part_of(box, surface); })) {
        continue;
      }
      text_ << "<geom name=\"surface_" << i << '"';
      if (!std::isfinite(surface.half_x_m) && !std::isfinite(surface.half_y_m)) {
        text_ << " type=\"plane\" size=\"0 0 1\"";
        write_pose(surface.world_from_surface);
      } else {
        text_ << " type=\"box\" size=\"" << std::min(surface.half_x_m, kEndless_m) << ' '
              << std::min(surface.half_y_m, kEndless_m) << ' ' << kPlateHalf_m << '"';
        write_pose(surface.world_from_surface * Eigen::Translation3d(0.0, 0.0, -kPlateHalf_m));
      }
      end_world_geom(surface.friction);
    }
    for (std::size_t i = 0; i < world_.bars.size(); ++i) {
      const Bar& bar = world_.bars[i];
      text_ << "<geom name=\"bar_" << i << "\" type=\"capsule\" size=\"" << bar.radius_m
            << "\" fromto=\"" << row(bar.from) << ' ' << row(bar.to) << '"';
      end_world_geom(bar.friction);
    }
    for (std::size_t i = 0; i < world_.solids.size(); ++i) {
      const SolidBox& box = world_.solids[i];
      double friction = std::numeric_limits<double>::infinity();
      for (const Surface& surface : world_.surfaces) {
        if (is_part_of(box, surface)) {
          friction = std::min(friction, friction_or_least(surface.friction));
        }
      }
      text_ << "<geom name=\"solid_" << i << "\" type=\"box\" size=\"" << row(0.5 * box.size_m)
            << '"';
      write_pose(box.world_from_box);
      end_world_geom(std::isfinite(friction) ? friction : 0.0);
    }
    for (std::size_t i = 0; i < world_.obstacles.size(); ++i) {
      const Obstacle& obstacle = world_.obstacles[i];
      const Eigen::Vector3d& size = obstacle.size;
      const bool rests = is_at_rest(obstacle);
      if (!rests) text_ << "<body name=\"obstacle_" << i << "\" mocap=\"true\">\n";
      text_ << "<geom name=\"obstacle_" << i << '"';
      switch (obstacle.shape) {
        case Obstacle::Shape::kBox:
          text_ << " type=\"box\" size=\"" << row(0.5 * size) << '"';
          break;
        case Obstacle::Shape::kSphere:
          text_ << " type=\"sphere\" size=\"" << size.x() << '"';
          break;
        case Obstacle::Shape::kCylinder:
          text_ << " type=\"cylinder\" size=\"" << size.x() << ' ' << 0.5 * size.y() << '"';
          break;
      }
      if (rests) write_pose(obstacle.world_from_obstacle);
      end_world_geom(0.0);
      if (!rests) text_ << "</body>\n";
    }
    write_map();
  }

  // Cells that are near each other are one body: MuJoCo sorts bodies by where they are. Those side
  // by side are one box.
  void write_map() {
    if (!world_.map) return;
    const octomap::OcTree& map = *world_.map;
    const double voxel_m = map.getResolution();
    std::map<std::array<int, 3>, std::vector<VoxelBox>> blocks;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
      if (!map.isNodeOccupied(*leaf)) continue;
      const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
      const Eigen::Vector3d halves = Eigen::Vector3d::Constant(0.5 * leaf.getSize());
      if (!options_.reach.intersects({centre - halves, centre + halves})) continue;
      std::array<int, 3> block{};
      VoxelBox box{};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        block[i] = static_cast<int>(std::floor(centre[axis] / kBlock_m));
        box.low[i] = static_cast<int>(std::lround((centre - halves)[axis] / voxel_m));
        box.high[i] = static_cast<int>(std::lround((centre + halves)[axis] / voxel_m));
      }
      blocks[block].push_back(box);
    }
    int count = 0;
    for (auto& [at, boxes] : blocks) {
      merge(boxes);
      text_ << "<body name=\"map_" << count++ << "\">\n";
      for (const VoxelBox& box : boxes) {
        const Eigen::Vector3i low(box.low.data()), high(box.high.data());
        text_ << "<geom type=\"box\" size=\"" << row(0.5 * voxel_m * (high - low).cast<double>())
              << "\" pos=\"" << row(0.5 * voxel_m * (low + high).cast<double>()) << '"';
        end_world_geom(0.0);
      }
      text_ << "</body>\n";
    }
  }

  void write_body(std::size_t body) {
    text_ << "<body name=\"body_" << body << '"';
    if (body > 0) {
      const Joint& joint = joint_of(body);
      write_pose(tree_.body_from_link(joint.parent_link) * joint.parent_from_joint);
      text_ << ">\n";
      write_joint(body - 1, joint);
    } else {
      text_ << ">\n";
      if (robot_.floating_base()) text_ << "<freejoint name=\"base\"/>\n";
    }
    if (body > 0 || robot_.floating_base()) write_inertia(inertias_[body]);
    write_shapes(static_cast<int>(body));
    for (std::size_t child = body + 1; child < tree_.bodies.size(); ++child) {
      if (tree_.bodies[child].parent == static_cast<int>(body)) write_body(child);
    }
    text_ << "</body>\n";
  }

  const Joint& joint_of(std::size_t body) const {
    return robot_.joints()[static_cast<std::size_t>(robot_.axes()[body - 1].joint)];
  }

  void write_joint(std::size_t axis, const Joint& joint) {
    text_ << "<joint name=\"axis_" << axis << "\" type=\""
          << (joint.type == JointType::kPrismatic ? "slide" : "hinge") << "\" axis=\""
          << row(joint.axis) << '"';
    if (std::isfinite(joint.lower) && joint.lower < joint.upper) {
      text_ << " limited=\"true\" range=\"" << joint.lower << ' ' << joint.upper << '"';
    }
    text_ << "/>\n";
  }

  // Along principal axes by Eigen: those that MuJoCo finds for `fullinertia` are off by up to 1e-7.
  void write_inertia(const BodyInertia& body) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(body.inertia);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = body.com;
    pose.linear() = principal.eigenvectors();
    if (pose.linear().determinant() < 0.0) pose.linear().col(0) *= -1.0;
    Eigen::Vector3d moments = principal.eigenvalues().cwiseMax(kLeastInertia);
    // Printed in a few digits, a flat body may miss what MuJoCo asks for.
    if (moments[0] + moments[1] < moments[2]) {
      moments[0] = moments[2] - moments[1] + 1e-15 * moments[2];
    }
    text_ << "<inertial mass=\"" << body.mass << "\" diaginertia=\"" << row(moments) << '"';
    write_pose(pose);
    text_ << "/>\n";
  }

  void write_shapes(int body) {
    for (std::size_t i = 0; i < effectors_.size(); ++i) {
      const EndEffector& effector = effectors_[i];
      const int link = robot_.link_index(effector.link);
      if (body_of(link) == body) write_effector(i, effector, tree_.body_from_link(link));
    }
    for (std::size_t link = 0; link < robot_.links().size(); ++link) {
      if (tree_.body_of_link[link] != body) continue;
      for (const CollisionShape& shape : robot_.links()[link].collision) write_shape(shape);
    }
  }

  void write_effector(std::size_t index, const EndEffector& effector,
                      const Eigen::Isometry3d& body_from_link) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = effector.point;
    if (effector.kind != ContactKind::kWheel) pose.linear() = axes_in_link(effector);
    if (effector.kind == ContactKind::kGrasp) return;
    text_ << "<geom name=\"effector_" << index << '"';
    switch (effector.kind) {
      case ContactKind::kSurface:
        text_ << " type=\"box\" size=\"" << effector.half_x_m << ' ' << effector.half_y_m << ' '
              << kSoleHalf_m << '"';
        pose.translation() += kSoleHalf_m * pose.linear().col(2);
        break;
      case ContactKind::kPoint:
        if (effector.radius_m > 0.0) {
          text_ << " type=\"sphere\" size=\"" << effector.radius_m << '"';
        } else {
          text_ << " type=\"sphere\" size=\"" << kBarePoint_m << '"';
          pose.translation() += kBarePoint_m * pose.linear().col(2);
        }
        break;
      case ContactKind::kWheel:
        text_ << " type=\"sphere\" size=\"" << effector.radius_m << '"';
        break;
      default:
        throw Error("end effector '" + effector.name + "' of a kind without a shape",
                    contact_kind_names("'"));
    }
    write_pose(body_from_link * pose);
    end_robot_geom();
  }

  bool has_effector(int body) const {
    return std::any_of(effectors_.begin(), effectors_.end(), [&](const EndEffector& effector) {
      return body_of(robot_.link_index(effector.link)) == body;
    });
  }

  // MuJoCo makes their convex hulls, as the judge does.
  void write_meshes() {
    text_ << "<asset>\n";
    for (std::size_t link = 0; link < robot_.links().size(); ++link) {
      for (const CollisionShape& shape : robot_.links()[link].collision) {
        if (shape.type != ShapeType::kMesh || !shape.mesh_found) continue;
        text_ << "<mesh name=\"" << mesh_name(shape) << "\" vertex=\"";
        for (const Eigen::Vector3d& corner : solid_corners(shape)) text_ << row(corner) << ' ';
        text_ << "\"/>\n";
      }
    }
    text_ << "</asset>\n";
  }

  // MuJoCo refuses what has no volume: meshes that are flat get the thickness of a plate.
  static std::vector<Eigen::Vector3d> solid_corners(const CollisionShape& shape) {
    std::vector<Eigen::Vector3d> corners = mesh_vertices(shape.mesh_file);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (Eigen::Vector3d& corner : corners) {
      corner = corner.cwiseProduct(shape.size).eval();
      mean += corner / static_cast<double>(corners.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& corner : corners) {
      spread += (corner - mean) * (corner - mean).transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(spread);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d axis = principal.eigenvectors().col(k);
      double extent_m = 0.0;
      for (const Eigen::Vector3d& corner : corners) {
        extent_m = std::max(extent_m, std::abs(axis.dot(corner - mean)));
      }
      if (extent_m > kPlateHalf_m) continue;
      const std::size_t count = corners.size();
      for (std::size_t i = 0; i < count; ++i) {
        corners.push_back(corners[i] + kPlateHalf_m * axis);
        corners[i] -= kPlateHalf_m * axis;
      }
    }
    return corners;
  }

  /// Of its link and its number there.
  std::string numbers_of(const CollisionShape& shape) const {
    const std::vector<CollisionShape>& all =
        robot_.links()[static_cast<std::size_t>(shape.link)].collision;
    return std::to_string(shape.link) + '_' + std::to_string(&shape - all.data());
  }
  std::string mesh_name(const CollisionShape& shape) const { return "mesh_" + numbers_of(shape); }

  static bool is_there(const CollisionShape& shape) {
    return shape.type != ShapeType::kMesh || shape.mesh_found;
  }

  void write_shape(const CollisionShape& shape) {
    if (!is_there(shape)) return;
    text_ << "<geom name=\"shape_" << numbers_of(shape) << '"';
    switch (shape.type) {
      case ShapeType::kSphere:
        text_ << " type=\"sphere\" size=\"" << shape.radius << '"';
        break;
      case ShapeType::kCapsule:
      case ShapeType::kCylinder:
        text_ << " type=\"" << (shape.type == ShapeType::kCapsule ? "capsule" : "cylinder")
              << "\" size=\"" << shape.radius << ' ' << 0.5 * shape.length << '"';
        break;
      case ShapeType::kBox:
        text_ << " type=\"box\" size=\"" << row(0.5 * shape.size) << '"';
        break;
      case ShapeType::kMesh:
        text_ << " type=\"mesh\" mesh=\"" << mesh_name(shape) << '"';
        break;
    }
    write_pose(tree_.body_from_link(shape.link) * shape.link_from_shape);
    if (has_effector(body_of(shape.link))) {
      text_ << " contype=\"0\" conaffinity=\"0\"/>\n";
    } else {
      end_robot_geom();
    }
  }

  void write_self_contacts() {
    const auto shapes_of = [this](int link) -> const std::vector<CollisionShape>& {
      return robot_.links()[static_cast<std::size_t>(link)].collision;
    };
    const auto parent = [this](int body) {
      return tree_.bodies[static_cast<std::size_t>(body)].parent;
    };
    for (const auto& [first, second] : robot_.self_collision_pairs()) {
      const int one = body_of(first), other = body_of(second);
      if (parent(one) == other || parent(other) == one) continue;
      for (const CollisionShape& a : shapes_of(first)) {
        for (const CollisionShape& b : shapes_of(second)) {
          if (!is_there(a) || !is_there(b)) continue;
          text_ << "<pair geom1=\"shape_" << numbers_of(a) << "\" geom2=\"shape_" << numbers_of(b)
                << "\" condim=\"3\" friction=\"" << kOtherFriction << ' ' << kOtherFriction
                << " 0.005 0.0001 0.0001\"" << kStiff << "/>\n";
        }
      }
    }
  }

  void write_motors() {
    for (std::size_t axis = 0; axis < robot_.axes().size(); ++axis) {
      const Joint& joint = joint_of(axis + 1);
      if (joint.max_effort <= 0.0 || joint.mimics >= 0) continue;
      text_ << "<motor name=\"motor_" << joint.index << "\" joint=\"axis_" << axis << '"';
      if (std::isfinite(joint.max_effort)) {
        text_ << " ctrllimited=\"true\" ctrlrange=\"" << -joint.max_effort << ' '
              << joint.max_effort << '"';
      }
      text_ << "/>\n";
    }
  }

  void write_grasps() {
    for (std::size_t i = 0; i < effectors_.size(); ++i) {
      if (effectors_[i].kind != ContactKind::kGrasp) continue;
      for (int k = 0; k < (effectors_[i].max_moment_Nm > 0.0 ? 2 : 1); ++k) {
        text_ << "<connect name=\"grasp_" << i << '_' << k << "\" body1=\"body_"
              << body_of(robot_.link_index(effectors_[i].link))
              << "\" anchor=\"0 0 0\" active=\"false\"/>\n";
      }
    }
  }

  void write_mimic_joints() {
    for (std::size_t axis = 0; axis < robot_.axes().size(); ++axis) {
      const Axis& follows = robot_.axes()[axis];
      if (joint_of(axis + 1).mimics < 0) continue;
      text_ << "<joint joint1=\"axis_" << axis << "\" joint2=\"axis_"
            << robot_.axes_of(follows.active).front() << "\" polycoef=\"" << follows.offset << ' '
            << follows.multiplier << " 0 0 0\"/>\n";
    }
  }

  const Robot& robot_;
  const KinematicTree& tree_;
  std::span<const EndEffector> effectors_;
  const World& world_;
  const MujocoModelOptions& options_;
  const std::vector<BodyInertia> inertias_;
  std::ostringstream text_;
};

}  // namespace

bool is_at_rest(const Obstacle& obstacle) {
  return obstacle.motion.empty() && !std::isfinite(obstacle.appears_s) &&
         !std::isfinite(obstacle.vanishes_s);
}

void MujocoModelOptions::validate() const {
  check_option(timestep_s > 0.0 && timestep_s <= 0.1, "timestep_s", "above 0, up to 0.1 s");
  check_option(friction_factor >= 0.0 && std::isfinite(friction_factor), "friction_factor",
               "0 or more");
}

std::string mujoco_model(const Robot& robot, std::span<const EndEffector> effectors,
                         const World& world, const MujocoModelOptions& options) {
  options.validate();
  return ModelWriter(robot, effectors, world, options).write();
}

}  // namespace locograph
