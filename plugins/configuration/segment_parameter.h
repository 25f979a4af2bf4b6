#pragma once
/// PARAMS_SEGMENT: a part of a plan in one stance, planned and timed by itself.
///
///     PARAMS_SEGMENT 60 2 22 3.5 1.25 interpolation
///     (number of the parameter, of the segment, its stance, from [s], duration [s], its planner)
///
/// s_j and δ_j of Rossini et al., "Loco-Manipulation Planning for Legged Robots: Offline and Online
/// Strategies". Segments are numbered from 0 and follow each other from the first configuration of
/// a plan to the last; each begins and ends at the time of a configuration. A plan may say nothing
/// of its segments. The PARAMS_STANCE stands before it in the file.

#include <locograph/core/parameters.h>

#include <string>

namespace locograph {

struct SegmentParameter final : Parameter {
  int segment = 0;        ///< its place in the plan
  int stance_number = 0;  ///< of all its configurations but the last
  double from_s = 0.0;
  double duration_s = 0.0;  ///< above 0
  std::string planner;      ///< that found it; may be empty

  std::string_view tag() const override { return "PARAMS_SEGMENT"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

}  // namespace locograph
