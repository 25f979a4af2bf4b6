#pragma once
/// What the `<environment>` of a scenario says.
///
///     const XmlFile xml("hall.xml", "scenario");
///     const XmlFile::Element* element = xml.root().FirstChildElement("environment");
///     const Environment environment = read_environment(xml, *element);
///     const std::optional<double> friction = effector_friction(xml, environment);
///
/// A box becomes a solid and its six faces, with normals that point out of it: NAME top, NAME
/// bottom, NAME front (its +x), NAME back, NAME left (its +y), NAME right.

#include <locograph/planners/scenario/scanned_surface.h>
#include <locograph/robots/xml_file.h>
#include <locograph/world/world.h>

#include <optional>
#include <string>
#include <vector>

namespace locograph {

struct Environment {
  std::optional<double> friction;  ///< of all that says nothing of its own
  std::string map, obstacles;      ///< as they are written; empty: none
  /// Their friction is what they say themselves, else 0.
  std::vector<Surface> surfaces;
  std::vector<Bar> bars;
  std::vector<SolidBox> solids;
  std::vector<ScannedSurface> scanned;  ///< their files as they are written
  /// The first of all these without friction of its own; null: all have it.
  const XmlFile::Element* without_friction = nullptr;
};

/// Throws Error with the line for what is unknown, missing, out of range, or named twice. The files
/// are not looked for. Points into xml.
Environment read_environment(const XmlFile& xml, const XmlFile::Element& environment);

/// Whether there is something that may be touched, or a file that may hold it.
bool has_places(const Environment& environment);

/// What end effectors say of friction: the environment's, or, without one, the largest that
/// something in it has. None if there is nothing. Throws Error with the line of an element whose
/// friction nobody knows.
std::optional<double> effector_friction(const XmlFile& xml, const Environment& environment);

}  // namespace locograph
