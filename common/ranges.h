#pragma once
/// What numbers in files may be. Beyond them are a slip of the finger, another unit, or places
/// where distances lose their digits: each is refused with a message that names the range.
///
///     if (!(std::abs(x) <= ranges::kCoordinate_m)) throw Error(file, line, "is far off", "less");

namespace locograph::ranges {

/// Of a coordinate in the world or on a link, either sign. Distances are good to 1e-9 m out there.
inline constexpr double kCoordinate_m = 1e6;
/// Of the size of a shape or of a contact.
inline constexpr double kLeastSize_m = 1e-6, kMostSize_m = 1e6;
/// Of a joint's position, either sign.
inline constexpr double kJoint_rad = 1e6;
/// Of a time, either sign: eleven days.
inline constexpr double kTime_s = 1e6;
/// Of how fast something changes: m/s and rad/s.
inline constexpr double kSlope = 1e6;
/// Of what contacts bear, and of friction.
inline constexpr double kForce_N = 1e9, kMoment_Nm = 1e9, kFriction = 1e3;
/// Of a component of a wrench, N or N m, either sign.
inline constexpr double kWrench = 1e9;
/// Of the weight of a row of an error: what it multiplies stays finite.
inline constexpr double kWeight = 1e30;
/// Of an obstacle, as fast as its fastest point: what the judge looks at grows with its way.
inline constexpr double kObstacleSpeed_m_s = 100.0;
/// Of a drive.
inline constexpr double kDrive_m = 1e3, kLeastSpeed_m_s = 1e-3, kMostSpeed_m_s = 100.0;
inline constexpr double kCurvature_1_m = 1e3;
inline constexpr int kConfigurations = 1'000'000;
/// Of the edge of a voxel.
inline constexpr double kLeastVoxel_m = 1e-4, kMostVoxel_m = 1e2;
/// Contacts of one stance, end effectors of one scenario, robots of one graph.
inline constexpr int kContacts = 100, kEndEffectors = 1000, kRobots = 16;

}  // namespace locograph::ranges
