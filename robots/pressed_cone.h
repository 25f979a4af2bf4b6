#pragma once
/// The wrench cone of a contact that is pressed on something: it does not pull, bears so much, and
/// slips at the friction cone.
///
///     const PressedCone cone(contact, {FrictionCone::kOuter, 4});
///     const bool holds = cone.rows() == 2 + 4;
///
/// Rows: −fz, fz − f_max, √(fx² + fy²) − μ fz or, with K sides, nₖ·(fx, fy) − μ_K fz, μ_K being
/// μ cos(π/K) of an inner pyramid, μ of an outer one.

#include <locograph/robots/bearing_rays.h>
#include <locograph/robots/wrench_cone.h>

namespace locograph {

class PressedCone : public WrenchCone {
 public:
  /// For fx fy fz and, from a class that adds rows for them, moments. Throws Error for a pyramid of
  /// fewer than 3 or more than 64 sides.
  PressedCone(const Contact& contact, const FrictionModel& friction,
              std::vector<int> components = {0, 1, 2}, int moment_rows = 0);

  WrenchRow row(int i, const double* w) const override;
  ContactRowLabel label(int i) const override;

 protected:
  /// Those above, which come first.
  int force_rows() const { return force_rows_; }

 private:
  int force_rows_;
  double max_force_N_, friction_;
  std::vector<Eigen::Vector2d> facets_;  ///< outward unit normals of the pyramid's sides
  double facet_mu_;                      ///< facet · (fx, fy) <= facet_mu fz
};

/// Forces on the edges of a friction pyramid at each corner, along the contact's axes [m].
std::vector<BearingRay> pressed_rays(const Contact& contact,
                                     const std::vector<Eigen::Vector2d>& corners, double part);

}  // namespace locograph
