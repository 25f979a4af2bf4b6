#include <locograph/common/ranges.h>
#include <locograph/plugins/surface_distance/places_parameter.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace locograph {
namespace {

constexpr std::string_view kEndless = "endless";

double read_within(FieldReader& in, double least, double most, const char* what) {
  const std::string token(in.peek());
  const double value = in.number();
  if (least <= value && value <= most) return value;
  char range[80];
  std::snprintf(range, sizeof range, "%.6g to %.6g m", least, most);
  in.fail(std::string(what) + " of " + token + " m", range);
}

double read_length(FieldReader& in, const char* what) {
  return read_within(in, ranges::kLeastSize_m, ranges::kMostSize_m, what);
}

double read_half(FieldReader& in) {
  if (in.peek() != kEndless) return read_length(in, "half a surface");
  in.word();
  return std::numeric_limits<double>::infinity();
}

void write_half(FieldWriter& out, double half_m) {
  if (std::isinf(half_m)) {
    out.word(kEndless);
  } else {
    out.number(half_m);
  }
}

Eigen::Vector3d read_end(FieldReader& in) {
  Eigen::Vector3d point;
  for (double& x : point) {
    x = read_within(in, -ranges::kCoordinate_m, ranges::kCoordinate_m, "a coordinate");
  }
  return point;
}

SavedPose read_pose(FieldReader& in) {
  SavedPose pose;
  pose.read(in);
  if (pose.position.cwiseAbs().maxCoeff() > ranges::kCoordinate_m) {
    in.fail("a place further away than anything", "coordinates of 1e6 m at most");
  }
  return pose;
}

Bar read_bar(FieldReader& in) {
  Bar bar;
  bar.name = in.word();
  bar.from = read_end(in);
  bar.to = read_end(in);
  bar.radius_m = read_length(in, "the radius");
  if ((bar.to - bar.from).norm() < ranges::kLeastSize_m) {
    in.fail("a bar without length", "two ends apart");
  }
  return bar;
}

}  // namespace

PlacesParameter::PlacesParameter(std::shared_ptr<const RobotParameter> robot, int number,
                                 const World& world)
    : robot_number(number) {
  world_.surfaces = world.surfaces;
  world_.bars = world.bars;
  world_.solids = world.solids;
  for (const Surface& one : world_.surfaces) surface_poses_.emplace_back(one.world_from_surface);
  for (const SolidBox& one : world_.solids) solid_poses_.emplace_back(one.world_from_box);
  make_places(std::move(robot));
}

void PlacesParameter::make_places(std::shared_ptr<const RobotParameter> robot) {
  for (std::size_t i = 0; i < surface_poses_.size(); ++i) {
    world_.surfaces[i].world_from_surface = surface_poses_[i].isometry();
  }
  for (std::size_t i = 0; i < solid_poses_.size(); ++i) {
    world_.solids[i].world_from_box = solid_poses_[i].isometry();
  }
  places = std::make_shared<const TouchablePlaces>(std::move(robot), world_);
}

void PlacesParameter::read(FieldReader& in) {
  robot_number = in.integer();
  const auto robot = in.parameters()->get<RobotParameter>(robot_number);
  while (!in.at_end()) {
    const std::string kind = in.word();
    if (kind == "surface") {
      Surface& surface = world_.surfaces.emplace_back();
      surface.name = in.word();
      surface_poses_.push_back(read_pose(in));
      surface.half_x_m = read_half(in);
      surface.half_y_m = read_half(in);
    } else if (kind == "bar") {
      world_.bars.push_back(read_bar(in));
    } else if (kind == "solid") {
      SolidBox& solid = world_.solids.emplace_back();
      solid.name = in.word();
      solid_poses_.push_back(read_pose(in));
      for (double& size : solid.size_m) size = read_length(in, "the size");
    } else {
      in.fail("place '" + kind + "'", "'surface', 'bar', 'solid' or the end of the line");
    }
  }
  make_places(robot);
}

void PlacesParameter::write(FieldWriter& out) const {
  out.integer(robot_number);
  for (std::size_t i = 0; i < world_.surfaces.size(); ++i) {
    const Surface& surface = world_.surfaces[i];
    out.word("surface");
    out.word(surface.name);
    surface_poses_[i].write(out);
    write_half(out, surface.half_x_m);
    write_half(out, surface.half_y_m);
  }
  for (const Bar& bar : world_.bars) {
    out.word("bar");
    out.word(bar.name);
    for (const Eigen::Vector3d* end : {&bar.from, &bar.to}) {
      for (const double x : *end) out.number(x);
    }
    out.number(bar.radius_m);
  }
  for (std::size_t i = 0; i < world_.solids.size(); ++i) {
    out.word("solid");
    out.word(world_.solids[i].name);
    solid_poses_[i].write(out);
    for (const double size : world_.solids[i].size_m) out.number(size);
  }
}

}  // namespace locograph
