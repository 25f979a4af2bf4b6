#pragma once
/// A URDF as urdfdom reads it, with nothing lost: by itself urdfdom drops the rest of a link,
/// shapes and all, after the first thing in it that it does not take, and says so nowhere but in
/// its log.
///
///     const XmlFile xml("robot.urdf", "robot");
///     const std::shared_ptr<const urdf::ModelInterface> model = urdfdom_model(xml, "robot.urdf");
///
/// The collision_array of each link has as many elements as the link has <collision>s.

#include <locograph/robots/xml_file.h>

#include <filesystem>
#include <memory>

namespace urdf {
class ModelInterface;
}

namespace locograph {

/// Without what is to be seen: visuals and materials, which may have no name. Numbers may stand in
/// any blanks. Throws Error with what urdfdom says where it does not take all of the rest.
std::shared_ptr<const urdf::ModelInterface> urdfdom_model(const XmlFile& xml,
                                                          const std::filesystem::path& file);

}  // namespace locograph
