#pragma once
/// Reads where a robot is to touch the world.
///
///     std::vector<PlacedContact> contacts = load_contacts("standing.xml", robot);
///
/// The format is described in doc/posture.md. Every mistake is an Error with file and line.

#include <locograph/planners/plan/placed_contact.h>

#include <filesystem>
#include <vector>

namespace locograph {

std::vector<PlacedContact> load_contacts(const std::filesystem::path& file, const Robot& robot);

}  // namespace locograph
