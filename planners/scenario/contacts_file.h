#pragma once
/// Reads where a robot is to touch the world.
///
///     Stance stance = load_contacts("standing.xml", robot);
///
/// The format is described in doc/posture.md. Every mistake is an Error with file and line.
/// A contact of a link that the file names several times gets a name of its own, "LINK_2" for the
/// second one.

#include <locograph/robots/contact.h>

#include <filesystem>

namespace locograph {

Stance load_contacts(const std::filesystem::path& file, const Robot& robot);

/// The same without a robot: whether its links exist and can touch all at once, and wheels turn,
/// stays open.
Stance load_contacts(const std::filesystem::path& file);

}  // namespace locograph
