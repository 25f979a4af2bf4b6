#pragma once
/// A way through stances that is judged, and mended where the judge refuses it.
///
///     const JudgedPath judged = judge_path(space, judge, path);
///     if (judged.refused > 0) std::cerr << "change " << judged.refused << " will not do\n";

#include <locograph/check/judge.h>
#include <locograph/planners/offline/stance/stance_path.h>

namespace locograph {

/// Judges the whole path, or from where balls have slipped since as seen from transition to
/// transition: a motion led there. Transitions that the judge refuses are solved again with wider
/// margins.
/// Without success, `refused` is the first change that cannot be mended, and is forbidden.
struct JudgedPath {
  CheckReport report;
  std::size_t refused = 0;  ///< 0: none
};
JudgedPath judge_path(StanceSpace& space, const Judge& judge, StancePath& path);

}  // namespace locograph
