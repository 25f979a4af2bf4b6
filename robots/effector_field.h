#pragma once
/// The numbers of end effectors, as files have them.
///
///     for (const EffectorField& field : contact_kind_entry(contact.effector.kind).fields) {
///       report(field.description, line, contact.effector.*field.value);
///     }

#include <locograph/common/ranges.h>
#include <locograph/robots/contact.h>

namespace locograph {

struct EffectorField {
  enum class Zero { kRefused, kAllowed, kWhenLeftOut };

  const char* attribute;       ///< in scenarios and contacts files
  const char* unit;            ///< "m", "N", "Nm"; "": none
  const char* quantity;        ///< "size"
  const char* description;     ///< "half size x"
  double EndEffector::*value;  ///< where it is
  double least = 0.0;          ///< what XML may say, but for zero
  double most = 0.0;           ///< what any file may say
  Zero zero = Zero::kRefused;
};

namespace effector_fields {

inline constexpr EffectorField kHalfX{.attribute = "half_x",
                                      .unit = "m",
                                      .quantity = "size",
                                      .description = "half size x",
                                      .value = &EndEffector::half_x_m,
                                      .least = ranges::kLeastSize_m,
                                      .most = ranges::kMostSize_m};
inline constexpr EffectorField kHalfY{.attribute = "half_y",
                                      .unit = "m",
                                      .quantity = "size",
                                      .description = "half size y",
                                      .value = &EndEffector::half_y_m,
                                      .least = ranges::kLeastSize_m,
                                      .most = ranges::kMostSize_m};
inline constexpr EffectorField kRadius{.attribute = "radius",
                                       .unit = "m",
                                       .quantity = "radius",
                                       .description = "radius",
                                       .value = &EndEffector::radius_m,
                                       .least = ranges::kLeastSize_m,
                                       .most = ranges::kMostSize_m};
/// A bare point has none.
inline constexpr EffectorField kBallRadius{.attribute = "radius",
                                           .unit = "m",
                                           .quantity = "radius",
                                           .description = "radius",
                                           .value = &EndEffector::radius_m,
                                           .least = ranges::kLeastSize_m,
                                           .most = ranges::kMostSize_m,
                                           .zero = EffectorField::Zero::kWhenLeftOut};
inline constexpr EffectorField kFriction{.attribute = "friction",
                                         .unit = "",
                                         .quantity = "friction",
                                         .description = "friction coefficient",
                                         .value = &EndEffector::friction,
                                         .most = ranges::kFriction};
inline constexpr EffectorField kMaxForce{.attribute = "max_force",
                                         .unit = "N",
                                         .quantity = "force",
                                         .description = "force limit",
                                         .value = &EndEffector::max_force_N,
                                         .most = ranges::kForce_N};
inline constexpr EffectorField kMaxMoment{.attribute = "max_moment",
                                          .unit = "Nm",
                                          .quantity = "moment",
                                          .description = "moment limit",
                                          .value = &EndEffector::max_moment_Nm,
                                          .most = ranges::kMoment_Nm,
                                          .zero = EffectorField::Zero::kAllowed};

}  // namespace effector_fields

}  // namespace locograph
