#pragma once
/// PARAMS_PLACES: what a robot may touch in the world, and keeps away from wherever it does not.
///
///     PARAMS_PLACES 30 0 surface ground 0 0 0 0 0 0 1 endless endless surface step …
///     PARAMS_PLACES n robot  PLACE…
///
///     graph.parameters().set(30, std::make_shared<const PlacesParameter>(robot, 0, world));
///
/// The surfaces, bars and solids of a World (world/world.h) without their friction, in any order:
///
///   surface NAME  x y z qx qy qz qw  half_x half_y    z: its normal; `endless`: without an end [m]
///   bar NAME  x y z  x y z  radius                    the ends of its axis [m]
///   solid NAME  x y z qx qy qz qw  size_x size_y size_z                                  [m]
///
/// They stand in the plan itself, which needs no other file for them. Poses are rounded to those
/// that a file can hold, so that a plan has the same errors before it is saved and after.

#include <locograph/plugins/configuration/frame_parameter.h>
#include <locograph/plugins/surface_distance/touchable_places.h>

#include <memory>
#include <vector>

namespace locograph {

struct PlacesParameter final : Parameter {
  int robot_number = 0;
  std::shared_ptr<const TouchablePlaces> places;

  PlacesParameter() = default;
  /// Takes surfaces, bars and solids of the world. Throws Error for poses that are none.
  PlacesParameter(std::shared_ptr<const RobotParameter> robot, int robot_number,
                  const World& world);

  std::string_view tag() const override { return "PARAMS_PLACES"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;

 private:
  void make_places(std::shared_ptr<const RobotParameter> robot);

  World world_;  ///< its poses are those of a file, too
  std::vector<SavedPose> surface_poses_, solid_poses_;
};

}  // namespace locograph
