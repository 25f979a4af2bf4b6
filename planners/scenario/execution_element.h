#pragma once
/// A scenario's execution margin: what its <execution> says, the rest by default.
///
///     scenario.margin = read_execution_margin(xml, element);

#include <locograph/plugins/configuration/execution_margin.h>
#include <locograph/robots/xml_file.h>

namespace locograph {

/// Throws Error with the line for an attribute that is unknown or out of range.
ExecutionMargin read_execution_margin(const XmlFile& xml, const XmlFile::Element& execution);

}  // namespace locograph
