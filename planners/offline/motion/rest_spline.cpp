#include <locograph/check/motion_curve.h>
#include <locograph/planners/offline/motion/rest_spline.h>

namespace locograph {
namespace {

constexpr int kCorrections = 3;

using Columns = Eigen::MatrixXd;  ///< by tangent coordinate and vertex

/// From a to b as slopes have it: the base's position in the world, its rotation along its axes.
Eigen::VectorXd way(const Robot& robot, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd result(robot.tangent_size());
  robot.difference(a.data(), b.data(), result.data());
  if (robot.floating_base()) result.head<3>() = b.head<3>() - a.head<3>();
  return result;
}

Eigen::VectorXd moved(const Robot& robot, const Eigen::VectorXd& from, const Eigen::VectorXd& way) {
  Eigen::VectorXd result(from.size());
  robot.integrate(from.data(), way.data(), result.data());
  if (robot.floating_base()) result.head<3>() = from.head<3>() + way.head<3>();
  return result;
}

/// The slopes of vertices 1 … n - 1, with the given right sides.
Columns solve(const Columns& right) {
  const Eigen::Index n = right.cols();
  Columns slopes = right;
  Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(n, 4.0);
  const auto below = [](Eigen::Index i) { return i == 1 ? 2.0 : 1.0; };       // of m_{i-1}
  const auto above = [n](Eigen::Index i) { return i == n - 2 ? 2.0 : 1.0; };  // of m_{i+1}
  for (Eigen::Index i = 1; i < n; ++i) {
    const double factor = below(i) / diagonal[i - 1];
    diagonal[i] -= factor * above(i - 1);
    slopes.col(i) -= factor * slopes.col(i - 1);
  }
  slopes.col(n - 1) /= diagonal[n - 1];
  for (Eigen::Index i = n - 2; i >= 0; --i) {
    slopes.col(i) = ((slopes.col(i) - above(i) * slopes.col(i + 1)) / diagonal[i]).eval();
  }
  return slopes;
}

}  // namespace

void rest_spline(const Robot& robot, double step_s, std::vector<Eigen::VectorXd>& configurations,
                 std::vector<Eigen::VectorXd>& slopes) {
  const auto last = static_cast<Eigen::Index>(configurations.size()) - 1;
  const auto q = [&](Eigen::Index i) -> Eigen::VectorXd& {
    return configurations[static_cast<std::size_t>(i)];
  };
  Columns ways(robot.tangent_size(), last);
  for (Eigen::Index i = 0; i < last; ++i) ways.col(i) = way(robot, q(i), q(i + 1));
  Columns right(robot.tangent_size(), last - 1);
  for (Eigen::Index i = 1; i < last; ++i) {
    right.col(i - 1) = ways.col(i - 1) + ways.col(i);
    if (i == 2) right.col(i - 1) += ways.col(0);
    if (i == last - 2) right.col(i - 1) += ways.col(last - 1);
  }
  right *= 3.0 / step_s;
  Motion motion;
  for (Eigen::Index i = 0; i <= last; ++i) motion.time_s.push_back(step_s * static_cast<double>(i));
  slopes.assign(configurations.size(), Eigen::VectorXd::Zero(robot.tangent_size()));
  for (int correction = 0;; ++correction) {
    const Columns found = solve(right);
    for (Eigen::Index i = 1; i < last; ++i) slopes[static_cast<std::size_t>(i)] = found.col(i - 1);
    q(1) = moved(robot, q(0), step_s / 3.0 * found.col(0));
    q(last - 1) = moved(robot, q(last), -step_s / 3.0 * found.col(last - 2));
    if (correction == kCorrections || !robot.floating_base()) return;
    motion.configurations = configurations;
    motion.slopes = slopes;
    const MotionCurve curve(robot, motion);
    CurvePoint before, after;
    for (Eigen::Index i = 1; i < last; ++i) {
      curve.step(static_cast<int>(i) - 1).at(1.0, before);
      curve.step(static_cast<int>(i)).at(0.0, after);
      right.col(i - 1).segment<3>(3) +=
          0.5 * step_s * (after.acceleration.segment<3>(3) - before.acceleration.segment<3>(3));
    }
  }
}

}  // namespace locograph
