#pragma once
/// Random postures on random contacts, and whether a graph finds wrenches that balance them: what
/// the benchmark balance_agreement and a test compare with the certificate.
///
///     const BalanceRobot robot = balance_robot("coman_plus");
///     std::mt19937_64 random(1);
///     const BalanceCase one = draw_balance_case(robot, random);
///     const double residual = graph_residual(robot, one, SurfaceModel::kCorners);

#include <locograph/plugins/configuration/contact_parameter.h>
#include <locograph/plugins/configuration/robot_parameters.h>

#include <Eigen/Core>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace locograph {

struct BalanceRobot {
  std::string name;
  std::shared_ptr<const RobotParameter> parameter;

  const Robot& model() const { return *parameter->robot; }
};

/// coman_plus or centauro, with all joints and a floating base.
BalanceRobot balance_robot(const std::string& name);

struct BalanceCase {
  Eigen::VectorXd configuration;
  std::vector<Contact> contacts;  ///< closed there
  int facets = 16;                ///< of the pyramids that the graph has inside the cones
};

/// One to six contacts: surfaces, points and rungs, on slopes, in any order.
BalanceCase draw_balance_case(const BalanceRobot& robot, std::mt19937_64& random);

/// The same with surfaces that may be pressed with a hundred times the weight: points in the
/// corners of a surface have no limit on their sum.
BalanceCase without_surface_limits(const BalanceRobot& robot, BalanceCase posture);

/// How a graph has a surface: with the rows of its contact wrench cone, or as a point in each
/// corner.
enum class SurfaceModel { kRows, kCorners };

/// The configuration held, EDGE_BALANCE, EDGE_CONTACT_WRENCH (with the pyramids given) and
/// EDGE_TORQUE_LIMITS are minimised over the wrenches by Levenberg-Marquardt. Norm of what is left,
/// dimensionless: forces by the weight, moments by weight times 1 m or times half size, limits by
/// themselves.
double graph_residual(const BalanceRobot& robot, const BalanceCase& posture, SurfaceModel surfaces);

/// Largest residual that counts as balanced.
inline constexpr double kGraphBalanced = 1e-4;

}  // namespace locograph
