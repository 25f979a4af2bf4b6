#include <locograph/common/check_option.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/configuration_buffer.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace locograph {
namespace {

/// Of the base's quaternion in a configuration.
constexpr int kQuaternion = 3;

}  // namespace

ConfigurationBuffer::ConfigurationBuffer(const Robot& robot, double kept_s)
    : robot_(&robot), kept_s_(kept_s), tangent_(robot.tangent_size()) {
  check_option(kept_s > 0.0 && std::isfinite(kept_s), "kept_s", "a positive number of seconds");
}

void ConfigurationBuffer::require(double time_s, const Eigen::VectorXd& q) const {
  if (!std::isfinite(time_s)) throw Error("the stamp of a configuration is not finite", "seconds");
  if (!empty() && time_s <= newest_s()) {
    throw Error("a configuration at " + std::to_string(time_s) + " s after one at " +
                    std::to_string(newest_s()) + " s",
                "ascending stamps");
  }
  if (q.size() != robot_->configuration_size()) {
    throw Error("a configuration of " + std::to_string(q.size()) + " numbers",
                std::to_string(robot_->configuration_size()) + " of " + robot_->name());
  }
  if (!q.allFinite()) throw Error("a configuration is not finite", "finite numbers");
  if (robot_->floating_base() && !(std::abs(q.segment<4>(kQuaternion).norm() - 1.0) <= 1e-3)) {
    throw Error("a configuration's quaternion is not of length 1", "1 within 1e-3");
  }
}

void ConfigurationBuffer::grow() {
  std::vector<Entry> ring(std::max<std::size_t>(16, 2 * ring_.size()));
  for (std::size_t i = 0; i < size_; ++i) ring[i] = std::move(ring_[(first_ + i) % ring_.size()]);
  for (Entry& entry : ring) entry.q.resize(robot_->configuration_size());
  ring_ = std::move(ring);
  first_ = 0;
}

void ConfigurationBuffer::add(double time_s, const Eigen::VectorXd& q) {
  require(time_s, q);
  // The last one before the span stays: what follows it is between two stamps.
  while (size_ > 1 && entry(1).time_s <= time_s - kept_s_) {
    first_ = (first_ + 1) % ring_.size();
    --size_;
  }
  if (size_ == ring_.size()) grow();
  Entry& added = ring_[(first_ + size_) % ring_.size()];
  added.time_s = time_s;
  added.q = q;
  if (robot_->floating_base()) added.q.segment<4>(kQuaternion).normalize();
  ++size_;
}

Eigen::VectorXd ConfigurationBuffer::at(double time_s) const {
  Eigen::VectorXd q;
  at(time_s, q);
  return q;
}

void ConfigurationBuffer::at(double time_s, Eigen::VectorXd& q) const {
  if (empty()) throw Error("no configuration is known yet", "some before images");
  if (!(time_s >= oldest_s() && time_s <= newest_s())) {
    throw Error(
        "where the robot was at " + std::to_string(time_s) + " s is not known",
        "a stamp from " + std::to_string(oldest_s()) + " to " + std::to_string(newest_s()) + " s");
  }
  std::size_t before = 0, after = size_ - 1;  // entry(before) <= time_s <= entry(after)
  while (after - before > 1) {
    const std::size_t middle = before + (after - before) / 2;
    (entry(middle).time_s <= time_s ? before : after) = middle;
  }
  const Entry &from = entry(before), &to = entry(after);
  if (time_s == from.time_s || time_s == to.time_s) {
    q = time_s == from.time_s ? from.q : to.q;
    return;
  }
  robot_->difference(from.q.data(), to.q.data(), tangent_.data());
  tangent_ *= (time_s - from.time_s) / (to.time_s - from.time_s);
  q.resize(robot_->configuration_size());
  robot_->integrate(from.q.data(), tangent_.data(), q.data());
}

}  // namespace locograph
