#pragma once
/// Where end effectors go while nothing holds them: the arcs of one segment.
///
///     const std::vector<Swing> swings = swings_of(space);
///     std::vector<Contact> places;
///     for (const Swing& swing : swings) swing.add_places(robot, 0.5, {}, places);
///
/// Parameter t in [0, 1] along the segment.

#include <locograph/planners/offline/motion/segment_space.h>

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace locograph {

/// What of an arc is asked for.
struct ArcOptions {
  double height_m = 0.05;    ///< above the line between both places, along normals
  bool with_axes = true;     ///< soles turn evenly from one place to the other
  double away_m = 0.0;       ///< half-way, away from the higher place: round its edge
  double up_m = 0.0;         ///< half-way, straight up: over what lies between
  bool climb_first = false;  ///< up before over, over before down; else both at once
  bool ends_only = false;    ///< only the moves along normals
};

struct Swing {
  /// Contacts that hold the end effector at t; none where it is free.
  void add_places(const Robot& robot, double t, const ArcOptions& options,
                  std::vector<Contact>& places) const;

  /// The link is held on the arc all along; else it is free in the middle.
  bool follows_arc(const ArcOptions& options) const;
  /// Of the link, on the arc.
  Eigen::Isometry3d pose(double t, const ArcOptions& options) const;
  /// The one that is left, else the one that is reached.
  const Contact& contact() const { return left != nullptr ? *left : *reached; }
  /// Horizontal, see ArcOptions::away_m.
  Eigen::Vector3d away(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  /// Null: it comes from, or stays, off the ground.
  const Contact* left = nullptr;
  const Contact* reached = nullptr;
  Eigen::Isometry3d from = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d to = Eigen::Isometry3d::Identity();  ///< poses of its link at both ends
  Eigen::Vector3d base = Eigen::Vector3d::Zero();        ///< of the robot, half-way; world
};

/// Of all end effectors that leave contacts or reach them in the segment.
std::vector<Swing> swings_of(SegmentSpace& space);

}  // namespace locograph
