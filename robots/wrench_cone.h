#pragma once
/// What a contact can bear: the rows g(w) <= 0 of the limits on its wrench w.
///
///     const ContactKindEntry& kind = contact_kind_entry(contact.effector.kind);
///     const auto cone = kind.wrench_cone(contact, {FrictionCone::kInner, 8});
///     const Eigen::Vector3d wrench(10.0, 0.0, 100.0);              // of a wheel: fx fy fz
///     for (int i = 0; i < cone->rows(); ++i) {
///       const WrenchRow row = cone->row(i, wrench.data());
///       worst = std::max(worst, row.gradient.head<3>().dot(wrench) + row.offset);
///     }
///
/// A wrench acts on the robot, about the touching point, along the contact's axes [N, N m]; of its
/// six components a contact has those that its kind leaves it. row() does not allocate. Const
/// functions may be shared between threads.

#include <locograph/robots/contact.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace locograph {

enum class FrictionCone { kCircle, kInner, kOuter };

/// How Coulomb's cone is seen: as it is, or as the pyramid of so many sides inside or around it.
struct FrictionModel {
  FrictionCone cone = FrictionCone::kCircle;
  int facets = 0;  ///< of a cone that is no circle
};

/// gradient · components + offset <= 0; of a curved limit where it stands.
struct WrenchRow {
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  double offset = 0.0;
};

class WrenchCone {
 public:
  virtual ~WrenchCone() = default;

  /// Indices into fx fy fz mx my mz.
  std::span<const int> components() const { return components_; }
  int rows() const { return rows_; }
  /// w: the components of the wrench.
  virtual WrenchRow row(int i, const double* w) const = 0;
  virtual ContactRowLabel label(int i) const = 0;

 protected:
  WrenchCone(std::vector<int> components, int rows)
      : components_(std::move(components)), rows_(rows) {}

 private:
  std::vector<int> components_;
  int rows_;
};

}  // namespace locograph
