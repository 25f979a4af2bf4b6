#pragma once
/// Ways of configurations along the contacts that a segment holds: dense ones, and shorter ones.
///
///     std::vector<Eigen::VectorXd> way = {space.from()};
///     if (join(space, way, space.to())) shorten(space, way, 60, 7);
///
/// A way is dense: neighbours are at most 0.15 rad apart (SegmentSpace::distance), closed, and
/// valid in between.

#include <locograph/planners/offline/motion/segment_space.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace locograph {

/// Appends the straight way from way.back() to `to`, brought back to the contacts, `to` included.
/// False where it is not valid: the way is as before, and SegmentSpace::why_not() tells why. Both
/// ends are closed and valid. swinging: as of SegmentSpace::valid.
bool join(SegmentSpace& space, std::vector<Eigen::VectorXd>& way, const Eigen::VectorXd& to,
          bool swinging = false);

/// Sum of the distances between neighbours.
double way_length(const SegmentSpace& space, const std::vector<Eigen::VectorXd>& way);

/// Puts straight ways in the place of parts of a dense way, where they are valid and shorter: of
/// all of it first, then of parts drawn at random.
void shorten(SegmentSpace& space, std::vector<Eigen::VectorXd>& way, int attempts,
             std::uint64_t seed);

}  // namespace locograph
