#include <locograph/common/error.h>
#include <locograph/robots/body_inertia.h>
#include <locograph/robots/kinematic_tree.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <sstream>

namespace locograph {
namespace {

// Inertias of flat bodies, where the largest moment is the sum of the others, come in three digits.
constexpr double kRoundedInertia = 1e-3;
// Moments below zero that are rounding, as a part of the largest: of thin bodies in six digits.
constexpr double kRoundedMoment = 1e-6;
// Moments [kg m^2] that are rounding whatever the others are: a milligram within a few micrometres.
constexpr double kNoMoment = 1e-15;
// Below this part of the largest moment of inertia, the one about the axis is rounding.
constexpr double kNoInertia = 1e-12;

/// mass * (|r|^2 1 - r r^T): what moving the reference point by r adds to an inertia (Steiner).
Eigen::Matrix3d steiner(double mass, const Eigen::Vector3d& r) {
  return mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
}

/// Mass * com and mass of the bodies, as the tree has them or with a factor for each link.
std::vector<Eigen::Vector4d> moments(const Robot& robot, std::span<const double> factors) {
  const KinematicTree& tree = robot.tree();
  std::vector<Eigen::Vector4d> result(tree.bodies.size(), Eigen::Vector4d::Zero());
  for (std::size_t b = 0; factors.empty() && b < result.size(); ++b) {
    result[b] = tree.bodies[b].moment;
  }
  for (std::size_t l = 0; l < factors.size(); ++l) {
    const Link& link = robot.links()[l];
    const Eigen::Vector3d com = tree.body_from_link(static_cast<int>(l)) * link.com;
    result[static_cast<std::size_t>(tree.body_of_link[l])] +=
        factors[l] * link.mass * com.homogeneous();
  }
  return result;
}

std::vector<BodyInertia> fold(const Robot& robot, std::span<const double> factors) {
  const KinematicTree& tree = robot.tree();
  const std::vector<Eigen::Vector4d> moment = moments(robot, factors);
  std::vector<BodyInertia> bodies(tree.bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    bodies[b].mass = moment[b][3];
    if (moment[b][3] > 0.0) bodies[b].com = moment[b].head<3>() / moment[b][3];
  }
  std::vector<Eigen::Matrix4d> body_from_link(robot.links().size(), Eigen::Matrix4d::Identity());
  for (const KinematicTree::RigidLink& rigid : tree.rigid_links) {
    body_from_link[static_cast<std::size_t>(rigid.link)] = rigid.body_from_link;
  }
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    const Link& link = robot.links()[l];
    BodyInertia& body = bodies[static_cast<std::size_t>(tree.body_of_link[l])];
    const Eigen::Matrix3d rotation = body_from_link[l].topLeftCorner<3, 3>();
    const Eigen::Vector3d com =
        rotation * link.com + body_from_link[l].topRightCorner<3, 1>() - body.com;
    const double factor = factors.empty() ? 1.0 : factors[l];
    body.inertia +=
        factor * (rotation * link.inertia * rotation.transpose() + steiner(link.mass, com));
  }
  return bodies;
}

/// Ascending.
Eigen::Vector3d principal_moments(const Eigen::Matrix3d& inertia) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// The link of a body whose inertia is furthest from that of a solid.
const Link& worst_link(const Robot& robot, int body) {
  const std::vector<Link>& links = robot.links();
  std::size_t worst =
      static_cast<std::size_t>(robot.tree().link_of_body[static_cast<std::size_t>(body)]);
  double largest_excess = 0.0;
  for (std::size_t l = 0; l < links.size(); ++l) {
    if (robot.tree().body_of_link[l] != body) continue;
    const Eigen::Vector3d principal = principal_moments(links[l].inertia);
    const double excess = principal[2] - principal[1] - principal[0];
    if (excess > largest_excess) {
      largest_excess = excess;
      worst = l;
    }
  }
  return links[worst];
}

/// Not below zero, but for rounding.
bool is_not_negative(const Eigen::Vector3d& principal) {
  const double largest = principal.cwiseAbs().maxCoeff();
  return largest < kNoMoment || principal[0] >= -kRoundedMoment * largest;
}

[[noreturn]] void refuse(const Robot& robot, int body, const Eigen::Vector3d& principal,
                         const std::string& expected) {
  const Link& link = worst_link(robot, body);
  std::ostringstream what;
  what << "link '" << link.name << "' gives its body the principal moments of inertia "
       << principal[0] << ", " << principal[1] << " and " << principal[2] << " kg m^2";
  throw Error(robot.urdf_file().string(), link.inertial_line, what.str(), expected);
}

/// A joint that moves no mass, or turns only one body, and that about an axis through all its mass,
/// has no equation of motion in any configuration. Its mimic joints may give it one.
void check_moved(const Robot& robot, const std::vector<BodyInertia>& bodies) {
  const KinematicTree& tree = robot.tree();
  std::vector<bool> massive_below(bodies.size(), false), moves(bodies.size(), false);
  for (std::size_t b = bodies.size() - 1; b > 0; --b) {
    const BodyInertia& body = bodies[b];
    const Eigen::Vector3d axis = tree.bodies[b].axis.head<3>();
    const double largest = body.inertia.diagonal().maxCoeff() + body.mass * body.com.squaredNorm();
    const double turned =
        axis.dot(body.inertia * axis) + body.mass * axis.cross(body.com).squaredNorm();
    moves[b] = massive_below[b] ||
               (tree.bodies[b].revolute ? turned > kNoInertia * largest : body.mass > 0.0);
    const bool massive = body.mass > 0.0 || largest > 0.0;
    const std::size_t parent = static_cast<std::size_t>(tree.bodies[b].parent);
    massive_below[parent] = massive_below[parent] || massive_below[b] || massive;
  }
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const std::span<const int> axes = robot.axes_of(i);
    if (std::any_of(axes.begin(), axes.end(),
                    [&](int axis) { return moves[static_cast<std::size_t>(axis) + 1]; })) {
      continue;
    }
    const Joint& joint = robot.active_joint(i);
    const Link& link = robot.links()[static_cast<std::size_t>(joint.child_link)];
    const bool massive = bodies[static_cast<std::size_t>(axes.front()) + 1].mass > 0.0;
    throw Error(robot.urdf_file().string(), link.inertial_line,
                "joint '" + joint.name + "' moves no " + (massive ? "inertia" : "mass") +
                    ", only link '" + link.name + "'",
                "an <inertial> with a positive mass and inertia, or the joint not among the "
                "active ones");
  }
}

}  // namespace

bool is_inertia_of_a_body(const Eigen::Matrix3d& inertia) {
  const Eigen::Vector3d principal = principal_moments(inertia);
  if (principal.cwiseAbs().maxCoeff() < kNoMoment) return true;
  return is_not_negative(principal) &&
         principal[0] + principal[1] >= (1.0 - kRoundedInertia) * principal[2];
}

void require_solid_bodies(const Robot& robot, std::span<const BodyInertia> bodies) {
  for (std::size_t b = robot.floating_base() ? 0 : 1; b < bodies.size(); ++b) {
    if (is_inertia_of_a_body(bodies[b].inertia)) continue;
    refuse(robot, static_cast<int>(b), principal_moments(bodies[b].inertia),
           "none of them above the sum of the other two");
  }
}

std::vector<BodyInertia> body_inertias(const Robot& robot) { return body_inertias(robot, {}); }

std::vector<BodyInertia> body_inertias(const Robot& robot, std::span<const double> link_factors) {
  if (!link_factors.empty() && link_factors.size() != robot.links().size()) {
    throw Error(std::to_string(link_factors.size()) + " factors of masses",
                "one for each of " + std::to_string(robot.links().size()) + " links");
  }
  for (const double factor : link_factors) {
    if (factor > 0.0 && std::isfinite(factor)) continue;
    throw Error("a factor of a mass of " + std::to_string(factor), "above 0");
  }
  const std::vector<BodyInertia> bodies = fold(robot, link_factors);
  check_moved(robot, bodies);
  for (std::size_t b = robot.floating_base() ? 0 : 1; b < bodies.size(); ++b) {
    const Eigen::Vector3d principal = principal_moments(bodies[b].inertia);
    if (!is_not_negative(principal)) {
      refuse(robot, static_cast<int>(b), principal, "none of them below zero");
    }
  }
  if (robot.floating_base() && !(robot.total_mass() > 0.0)) {
    throw Error(robot.urdf_file().string(), robot.links()[0].inertial_line,
                "robot '" + robot.name() + "' has a floating base and no mass",
                "an <inertial> with a positive mass in at least one link");
  }
  return bodies;
}

}  // namespace locograph
