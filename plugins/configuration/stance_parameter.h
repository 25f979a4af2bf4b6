#pragma once
/// PARAMS_STANCE: contacts that hold together; a configuration names the stance it is left in.
///
///     PARAMS_STANCE 20 4 10 11 12 13           (number of the stance, of contacts, the contacts)
///
///     graph.parameters().set(20, std::make_shared<const StanceParameter>(graph.parameters(),
///                                                                        std::vector{10, 11}));
///
/// The contacts are PARAMS_CONTACTs of one robot that stand before it in the file. A stance is held
/// from every VERTEX_CONFIGURATION that names it to the next one in time.

#include <locograph/plugins/configuration/contact_parameter.h>
#include <locograph/robots/wheel.h>

#include <memory>
#include <vector>

namespace locograph {

struct StanceParameter final : Parameter {
  /// A wheel of the stance, and the plane it stands on.
  struct StandingWheel {
    Wheel wheel;
    Eigen::Vector3d normal;  ///< unit
    bool locked = false;
  };

  std::vector<int> contact_numbers;
  ContactList contacts;
  std::shared_ptr<const RobotParameter> robot;
  Stance stance;
  std::vector<StandingWheel> wheels;  ///< in the order of the contacts

  StanceParameter() = default;
  /// Throws Error for unknown contacts, contacts of several robots, and a stance that is not sound
  /// (robots/contact.h).
  StanceParameter(const Parameters& parameters, std::vector<int> contact_numbers);

  std::string_view tag() const override { return "PARAMS_STANCE"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

/// The wheels that stand in a stance.
std::vector<StanceParameter::StandingWheel> standing_wheels(const Robot& robot,
                                                            const Stance& stance);

}  // namespace locograph
