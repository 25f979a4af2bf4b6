#pragma once
/// The `<camera>`s of a scenario's `<robot>`.
///
///     const XmlFile xml("hall.xml", "scenario");
///     const XmlFile::Element* robot = xml.root().FirstChildElement("robot");
///     const std::vector<ScenarioCamera> cameras = read_cameras(xml, *robot);

#include <locograph/planners/scenario/scenario_camera.h>
#include <locograph/robots/xml_file.h>

#include <vector>

namespace locograph {

/// `position` and `rpy` place a body whose x is forward and z up (body_from_optical()). Throws
/// Error with the line for what is unknown, missing or out of range, and for a name that is there
/// twice. The links are not looked for.
std::vector<ScenarioCamera> read_cameras(const XmlFile& xml, const XmlFile::Element& robot);

}  // namespace locograph
