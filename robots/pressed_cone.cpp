#include <locograph/common/error.h>
#include <locograph/robots/pressed_cone.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace locograph {
namespace {

constexpr int kMostFacets = 64;
/// Of the pyramids of rays.
constexpr int kRayFacets = 8;

int count_force_rows(const FrictionModel& friction) {
  return 2 + (friction.cone == FrictionCone::kCircle ? 1 : friction.facets);
}

}  // namespace

PressedCone::PressedCone(const Contact& contact, const FrictionModel& friction,
                         std::vector<int> components, int moment_rows)
    : WrenchCone(std::move(components), count_force_rows(friction) + moment_rows),
      force_rows_(count_force_rows(friction)),
      max_force_N_(contact.effector.max_force_N),
      friction_(contact.effector.friction),
      facet_mu_(friction_) {
  if (friction.cone == FrictionCone::kCircle) return;
  if (friction.facets < 3 || friction.facets > kMostFacets) {
    throw Error("contact of " + contact.name() + " has a friction pyramid of " +
                    std::to_string(friction.facets) + " sides",
                "3 to " + std::to_string(kMostFacets));
  }
  if (friction.cone == FrictionCone::kInner) facet_mu_ *= std::cos(EIGEN_PI / friction.facets);
  const auto exact = [](double value) { return std::abs(value) < 1e-15 ? 0.0 : value; };
  for (int i = 0; i < friction.facets; ++i) {
    const double angle = 2.0 * EIGEN_PI * i / friction.facets;
    facets_.emplace_back(exact(std::cos(angle)), exact(std::sin(angle)));
  }
}

WrenchRow PressedCone::row(int i, const double* w) const {
  WrenchRow limit;
  if (i == 0) {
    limit.gradient[2] = -1.0;
  } else if (i == 1) {
    limit.gradient[2] = 1.0;
    limit.offset = -max_force_N_;
  } else if (facets_.empty()) {
    const double tangential = std::hypot(w[0], w[1]);
    if (tangential > 0.0) limit.gradient.head<2>() << w[0] / tangential, w[1] / tangential;
    limit.gradient[2] = -friction_;
  } else {
    const Eigen::Vector2d& facet = facets_[static_cast<std::size_t>(i - 2)];
    limit.gradient.head<3>() << facet.x(), facet.y(), -facet_mu_;
  }
  return limit;
}

ContactRowLabel PressedCone::label(int i) const {
  if (i < 2) return {i == 0 ? "pull" : "normal force", "N"};
  return {"friction", "N"};
}

std::vector<BearingRay> pressed_rays(const Contact& contact,
                                     const std::vector<Eigen::Vector2d>& corners, double part) {
  const Eigen::Matrix3d axes = axes_in_world(contact);
  const double friction = part * contact.effector.friction;
  std::vector<BearingRay> rays;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : corners) {
    middle += corner / static_cast<double>(corners.size());
  }
  for (const Eigen::Vector2d& corner : corners) {
    const Eigen::Vector3d at =
        contact.position + axes.leftCols<2>() * (middle + part * (corner - middle));
    for (int k = 0; k < kRayFacets; ++k) {
      // The edges of the pyramid lie on the cone.
      const double angle = (k + 0.5) * 2.0 * std::numbers::pi / kRayFacets;
      const Eigen::Vector3d along(friction * std::cos(angle), friction * std::sin(angle), 1.0);
      rays.push_back({at, axes * along, Eigen::Vector3d::Zero(), 0.0,
                      std::numeric_limits<double>::infinity()});
    }
  }
  return rays;
}

}  // namespace locograph
