#pragma once
/// How a LocalMap sees, forgets, and takes what it has not seen.
///
///     LocalMapOptions options;
///     options.floor_z_m = 0.0;                  // wheels stand there
///     options.unknown = UnknownSpace::kSlow;
///     options.validate();

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace locograph {

/// How space that was never seen is taken.
enum class UnknownSpace {
  kFree,      ///< the field reads it as free
  kOccupied,  ///< the field reads it as an obstacle, and so all that is outside of the window
  kSlow,  ///< the field reads it as free; LocalField::is_known() tells a planner where not to hurry
};

/// What images say of a voxel, added up.
struct LogOdds {
  int hit = 10, miss = 10;     ///< of one image
  int least = -40, most = 40;  ///< the sum stays between these
  int occupied_from = 20;      ///< an obstacle from here on
};

struct LocalMapOptions {
  /// Rounded up to whole voxels, along x to 32 of them.
  Eigen::Vector3d size_m = {8.0, 8.0, 3.0};
  double resolution_m = 0.05;
  /// The field is exact up to here.
  double max_distance_m = 1.0;
  /// Along the optical axis; pixels beyond are no hits, and only clear the space before.
  double range_m = 4.0;

  LogOdds log_odds;
  /// A voxel is hit by an image if at least so many pixels end in it, and at least this share of
  /// those that it would fill if it were a wall across the view.
  int least_pixels = 3;
  double least_share = 0.05;
  /// A voxel is seen through if all pixels around its centre see beyond it by the margin: those
  /// within this share of its size.
  double footprint = 0.5;
  double free_margin_m = 0.035;

  /// Voxels that no image has told of for so long (an eighth more, at most) were never seen.
  /// Infinite: nothing is forgotten but what the window leaves.
  double forget_after_s = std::numeric_limits<double>::infinity();

  UnknownSpace unknown = UnknownSpace::kFree;

  /// Hits below floor_z_m + floor_band_m show the floor, which is no obstacle: the robot stands
  /// there. Minus infinity: there is no floor.
  double floor_z_m = -std::numeric_limits<double>::infinity();
  double floor_band_m = 0.05;

  /// Throws Error for what is out of range, and for windows of more than 2^25 voxels (about half a
  /// gigabyte with everything that belongs to them).
  void validate() const;

  double floor_top_m() const { return floor_z_m + floor_band_m; }
  /// Distances above this, in voxels, are not told apart: so many that the field's values, which
  /// are on the safe side, still reach max_distance_m.
  int cap() const;
};

}  // namespace locograph
