#pragma once
/// Where the robot was: its configurations of the last seconds with their stamps, and between them.
///
///     ConfigurationBuffer buffer(robot);
///     buffer.add(0.00, q);
///     buffer.add(0.02, next_q);
///     RobotState state(robot);
///     state.update(buffer.at(0.011).data());   // when an image was taken
///
/// Between two stamps the robot moves straight, in the tangent of the first (Robot::difference and
/// integrate): the base turns about a fixed axis at a constant rate. At a stamp it is exactly as it
/// was added, with a quaternion of length 1.
///
/// A call that throws leaves everything as it was. Once the buffer spans kept_s, add() does not
/// allocate, as long as configurations do not come more densely than before; at() into a vector of
/// the right size never does. Keeps a pointer to the robot. Not for several threads at once, const
/// functions neither.

#include <locograph/robots/robot.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

class ConfigurationBuffer {
 public:
  /// kept_s: at() answers for as long before the newest stamp, or since the first one. Throws Error
  /// unless it is positive.
  explicit ConfigurationBuffer(const Robot& robot, double kept_s = 5.0);

  /// Throws Error for a stamp that is not finite or not after the newest one, for another number of
  /// coordinates than the robot's configuration has, for one that is not finite, and for a
  /// quaternion whose length is not 1 within 1e-3.
  void add(double time_s, const Eigen::VectorXd& q);

  /// Throws Error for a stamp that is not finite, before the oldest that is kept, or after the
  /// newest: nobody knows where the robot was or will be.
  Eigen::VectorXd at(double time_s) const;
  void at(double time_s, Eigen::VectorXd& q) const;

  bool empty() const { return size_ == 0; }
  /// Of what is kept. Not to be asked of an empty buffer.
  double oldest_s() const { return entry(0).time_s; }
  double newest_s() const { return entry(size_ - 1).time_s; }

 private:
  struct Entry {
    double time_s = 0.0;
    Eigen::VectorXd q;
  };

  const Entry& entry(std::size_t i) const { return ring_[(first_ + i) % ring_.size()]; }
  void require(double time_s, const Eigen::VectorXd& q) const;
  void grow();

  const Robot* robot_;
  double kept_s_;
  std::vector<Entry> ring_;  ///< size_ of them in use, the oldest at first_
  std::size_t first_ = 0, size_ = 0;
  mutable Eigen::VectorXd tangent_;
};

}  // namespace locograph
