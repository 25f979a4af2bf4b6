#pragma once
/// What `<start>` and `<goal>` of a scenario say.
///
///     const XmlFile xml("stones.xml", "scenario");
///     const std::optional<ContactTask> task = read_contact_task(xml, effectors);
///
/// A contact is a scenario's end effector at its place: what it can bear is the end effector's. Its
/// place is not looked for in the environment. Wheels stand still.

#include <locograph/planners/scenario/contact_task.h>
#include <locograph/robots/xml_file.h>

#include <optional>
#include <vector>

namespace locograph {

/// Of the children of the root. None if there is neither a start nor a goal. Throws Error with the
/// line for one without the other, and for what is unknown, missing, out of range or given twice.
std::optional<ContactTask> read_contact_task(const XmlFile& xml,
                                             const std::vector<EndEffector>& end_effectors);

}  // namespace locograph
