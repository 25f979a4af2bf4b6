#pragma once
/// What a robot that comes as a URDF alone needs to be planned for: an SRDF, end effectors, a
/// posture that stands and a scenario to begin with.
///
///     Json told = write_skeleton("h1.urdf", "h1.srdf", {.samples = 500, .threads = 2});
///     // h1.srdf and h1.scenario.xml
///
/// The SRDF switches off the pairs of links that never come nearer than 0.1 m in random postures
/// ("Never": what samples miss comes near far more often than it meets), that always meet
/// ("Always"), and, of links at most three joints apart, that are nearer than 6 mm as the robot
/// stands ("Default": shapes that are larger than what they stand for). Its group_state `standing`
/// is the posture that was found. The scenario stands on a floor; its goal is 0.15 m ahead. Where
/// the URDF's efforts hold no posture, its torques are told only: "torque_limits" is "report" then,
/// and "torque_ratio_standing" says how many times the efforts would be needed.

#include <locograph/apps/output.h>
#include <locograph/world/link_pairs.h>

#include <filesystem>
#include <string>

namespace locograph {

/// Writes the SRDF and a scenario of the same name, with .scenario.xml for its extension.
/// robot: a URDF, or the name of a robot that comes along; its SRDF, if it has one, is neither read
/// nor written over, and a scenario that is there already is not written over either.
/// The answer has "scenario" null and a "reason" where nothing stands; the SRDF is written then,
/// too, without a state. Throws Error for a URDF that cannot be used, and for files that cannot be
/// written, before it begins.
Json write_skeleton(const std::string& robot, const std::filesystem::path& srdf,
                    const LinkPairOptions& sampling);

}  // namespace locograph
