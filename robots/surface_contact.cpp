#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/frame_closure.h>
#include <locograph/robots/pressed_cone.h>

#include <cmath>
#include <numbers>

namespace locograph {
namespace {

/// Of the circle that bears whatever the yaw.
constexpr int kCircleCorners = 8;
constexpr int kPressureRows = 4, kYawRows = 8;

/// With the centre of pressure in the rectangle, and the yaw limits of Caron, Pham & Nakamura 2015.
class SurfaceCone final : public PressedCone {
 public:
  SurfaceCone(const Contact& contact, const FrictionModel& friction)
      : PressedCone(contact, friction, {0, 1, 2, 3, 4, 5}, kPressureRows + kYawRows),
        half_x_m_(contact.effector.half_x_m),
        half_y_m_(contact.effector.half_y_m),
        yaw_mu_(friction.cone == FrictionCone::kOuter
                    ? contact.effector.friction
                    : contact.effector.friction / std::sqrt(2.0)) {}

  WrenchRow row(int i, const double* w) const override {
    if (i < force_rows()) return PressedCone::row(i, w);
    i -= force_rows();
    const double x = half_x_m_, y = half_y_m_, mu = yaw_mu_;
    const auto sign = [](int bit) { return bit == 0 ? 1.0 : -1.0; };
    WrenchRow limit;
    if (i < kPressureRows) {
      const int axis = i < 2 ? 4 : 3;
      limit.gradient[axis] = sign(i % 2);
      limit.gradient[2] = axis == 4 ? -x : -y;
      return limit;
    }
    i -= kPressureRows;
    const double side = -sign(i / 4), a = sign(i / 2 % 2), b = sign(i % 2);
    limit.gradient << a * y, b * x, -mu * (x + y), side * a * mu, side * b * mu, side;
    return limit;
  }

  ContactRowLabel label(int i) const override {
    if (i < force_rows()) return PressedCone::label(i);
    if (i < force_rows() + kPressureRows) return {"centre of pressure", "N m"};
    return {"yaw moment", "N m"};
  }

 private:
  double half_x_m_, half_y_m_;
  /// Friction coefficient in the yaw rows of the contact wrench cone, which hold for corner forces
  /// in a pyramid of four sides: mu / √2 makes it an inner one.
  double yaw_mu_;
};

/// Corners of what bears, along the contact's axes.
std::vector<Eigen::Vector2d> bearing_corners(const BearingContact& bearing) {
  const EndEffector& sole = bearing.contact.effector;
  if (!bearing.area.empty()) return bearing.area;
  std::vector<Eigen::Vector2d> corners;
  if (bearing.contact.forward) {
    for (const double x : {sole.half_x_m, -sole.half_x_m}) {
      for (const double y : {sole.half_y_m, -sole.half_y_m}) corners.emplace_back(x, y);
    }
    return corners;
  }
  const double radius = std::min(sole.half_x_m, sole.half_y_m);
  for (int k = 0; k < kCircleCorners; ++k) {
    const double angle = k * 2.0 * std::numbers::pi / kCircleCorners;
    corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return corners;
}

/// A rectangle about the point: a sole.
struct SurfaceContact final : ContactKindEntry {
  SurfaceContact()
      : ContactKindEntry("surface", {effector_fields::kHalfX, effector_fields::kHalfY,
                                     effector_fields::kFriction, effector_fields::kMaxForce}) {
    axes_on_link = true;
    holds_normal = true;
    stood_on = true;
    bar_touch = BarTouch::kArea;
  }

  std::unique_ptr<const ClosureRows> closure(const Robot& robot,
                                             const Contact& contact) const override {
    return std::make_unique<FrameClosure>(
        robot, contact, contact.position,
        contact.forward ? FrameClosure::Held::kOrientation : FrameClosure::Held::kTiltOfZ);
  }

  std::unique_ptr<const WrenchCone> wrench_cone(const Contact& contact,
                                                const FrictionModel& friction) const override {
    return std::make_unique<SurfaceCone>(contact, friction);
  }

  std::vector<BearingRay> rays(const BearingContact& bearing, double part, double) const override {
    return pressed_rays(bearing.contact, bearing_corners(bearing), part);
  }

  Eigen::Vector2d inset_m(const EndEffector& effector) const override {
    return {effector.half_x_m, effector.half_y_m};
  }
};

}  // namespace

const ContactKindEntry& surface_contact() {
  static const SurfaceContact entry;
  return entry;
}

}  // namespace locograph
