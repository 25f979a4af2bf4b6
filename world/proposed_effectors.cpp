#include <locograph/robots/covering_capsules.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/statics.h>
#include <locograph/world/proposed_effectors.h>
#include <locograph/world/rectangles.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

namespace locograph {
namespace {

using Eigen::Vector3d;

constexpr double kFlat_m = 1e-3, kLeastSide_m = 0.02;
constexpr double kDown = -0.7;        // of the vertical part of a flat's normal
constexpr double kLowShare = 0.05;    // of the robot's height
constexpr double kRoundShare = 0.03;  // of a wheel's radius
constexpr double kMostTilt_rad = 0.7, kSphere_m = 1.5e-3;
constexpr double kLeastRadius_m = 3e-3, kMostRadius_m = 0.15;
constexpr int kRing = 32, kRings = 6;

/// A point of a shape's surface, or of a ball about it: of the shapes that have no corners.
struct Ball {
  Vector3d centre;
  double radius;
  int link;
};

struct LastBody {
  int axis;                 // that moves it, index into Robot::axes()
  std::vector<Ball> balls;  // world
};

void add_points(const CollisionShape& shape, const Eigen::Isometry3d& world_from_link,
                std::vector<Ball>& balls) {
  const Eigen::Isometry3d pose = world_from_link * shape.link_from_shape;
  const auto add = [&](const Vector3d& point, double radius = 0.0) {
    balls.push_back({pose * point, radius, shape.link});
  };
  switch (shape.type) {
    case ShapeType::kSphere:
      add(Vector3d::Zero(), shape.radius);
      break;
    case ShapeType::kCapsule:
      for (const double end : {-0.5, 0.5}) add({0.0, 0.0, end * shape.length}, shape.radius);
      break;
    case ShapeType::kCylinder:
      for (int k = 0; k < kRing; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kRing;
        for (const double end : {-0.5, 0.5})
          add({shape.radius * std::cos(angle), shape.radius * std::sin(angle), end * shape.length});
      }
      break;
    case ShapeType::kBox:
      for (int k = 0; k < 8; ++k) {
        const Vector3d corner((k & 1) != 0 ? 0.5 : -0.5, (k & 2) != 0 ? 0.5 : -0.5,
                              (k & 4) != 0 ? 0.5 : -0.5);
        add(corner.cwiseProduct(shape.size));
      }
      break;
    case ShapeType::kMesh: {
      const TriangleTree mesh = collision_mesh(shape);
      for (const Vector3d& corner : mesh.corners()) add(corner);
      break;
    }
  }
}

/// How far they reach in a direction.
double furthest(const std::vector<Ball>& balls, const Vector3d& out) {
  double far = -std::numeric_limits<double>::infinity();
  for (const Ball& ball : balls) far = std::max(far, ball.centre.dot(out) + ball.radius);
  return far;
}

double lowest(const std::vector<Ball>& balls) { return -furthest(balls, -Vector3d::UnitZ()); }

struct Flat {
  Vector3d centre, out, forward;
  double half_x_m = 0.0, half_y_m = 0.0;
  int link = -1;
  double area() const { return half_x_m * half_y_m; }
};

/// The largest rectangle with sides along the axes in the convex polygon of these corners.
struct Rectangle {
  double x0 = 0.0, x1 = 0.0, y0 = 0.0, y1 = 0.0;
  double area() const { return std::max(0.0, x1 - x0) * std::max(0.0, y1 - y0); }
};

Rectangle rectangle_in(const std::vector<PlanePoint>& corners) {
  // Where the line of an x crosses the polygon.
  const auto across = [&](double x) {
    std::array<double, 2> range = {std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const PlanePoint &a = corners[i], &b = corners[(i + 1) % corners.size()];
      if ((x < a.x) == (x < b.x)) continue;
      const double y = a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y);
      range[0] = std::min(range[0], y);
      range[1] = std::max(range[1], y);
    }
    return range;
  };
  constexpr int kSteps = 60;
  constexpr double kRounding = 1e-6;
  const auto [least, most] = std::ranges::minmax_element(corners, {}, &PlanePoint::x);
  // Not at the ends themselves: of a side across, only one corner may be there, up to rounding.
  const double from = least->x + kRounding * (most->x - least->x);
  const double to = most->x - kRounding * (most->x - least->x);
  std::vector<double> xs;
  std::vector<std::array<double, 2>> ys;
  for (int k = 0; k <= kSteps; ++k) {
    xs.push_back(from + (to - from) * k / kSteps);
    ys.push_back(across(xs.back()));
  }
  Rectangle best;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    for (std::size_t j = i + 1; j < xs.size(); ++j) {
      const Rectangle one = {xs[i], xs[j], std::max(ys[i][0], ys[j][0]),
                             std::min(ys[i][1], ys[j][1])};
      if (one.area() > best.area()) best = one;
    }
  }
  return best;
}

/// What is flat on the side that a direction looks to.
std::optional<Flat> flat_towards(const std::vector<Ball>& balls, const Vector3d& out) {
  const double plane = furthest(balls, out);
  const Vector3d ahead = std::abs(out.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitZ();
  const Vector3d x = (ahead - ahead.dot(out) * out).normalized(), y = x.cross(out);
  std::vector<PlanePoint> points;
  int link = -1;
  for (const Ball& ball : balls) {
    if (ball.centre.dot(out) + ball.radius < plane - kFlat_m) continue;
    points.push_back({ball.centre.dot(x), ball.centre.dot(y)});
    link = ball.link;
  }
  if (convex_hull(points).size() < 3) return {};
  const PlaneFrame frame = smallest_frame(points);
  // Forward is the axis of the frame that is nearer to x.
  const double quarters = std::round(frame.angle_rad / (0.5 * std::numbers::pi));
  const double angle = frame.angle_rad - 0.5 * std::numbers::pi * quarters;
  const Vector3d forward = std::cos(angle) * x + std::sin(angle) * y;
  const Vector3d left = -std::sin(angle) * x + std::cos(angle) * y;
  for (PlanePoint& point : points) {
    const Vector3d at = point.x * x + point.y * y;
    point = {at.dot(forward), at.dot(left)};
  }
  const Rectangle inside = rectangle_in(convex_hull(points));
  Flat flat;
  flat.half_x_m = 0.5 * (inside.x1 - inside.x0);
  flat.half_y_m = 0.5 * (inside.y1 - inside.y0);
  if (!(2.0 * std::min(flat.half_x_m, flat.half_y_m) >= kLeastSide_m)) return {};
  flat.centre =
      0.5 * (inside.x0 + inside.x1) * forward + 0.5 * (inside.y0 + inside.y1) * left + plane * out;
  flat.out = out;
  flat.forward = forward;
  flat.link = link;
  return flat;
}

class Proposals {
 public:
  explicit Proposals(const Robot& robot) : robot_(robot), state_(robot) {
    for (const Link& link : robot.links()) {
      for (const CollisionShape& shape : link.collision)
        add_points(shape, state_.world_from_link(shape.link), all_);
    }
  }

  std::vector<EndEffector> find() const {
    std::vector<EndEffector> found;
    if (all_.empty()) return found;
    const double low = lowest(all_), height = furthest(all_, Vector3d::UnitZ()) - low;
    for (const LastBody& body : last_bodies()) {
      if (lowest(body.balls) > low + kLowShare * height) continue;
      EndEffector effector = of_body(body);
      effector.name = effector.link;
      const double weight_N = robot_.total_mass() * standard_gravity().norm();
      effector.max_force_N = std::max(10.0, 10.0 * std::round(0.2 * weight_N));
      found.push_back(effector);
    }
    return found;
  }

 private:
  /// That move nothing with shapes.
  std::vector<LastBody> last_bodies() const {
    const KinematicTree& tree = robot_.tree();
    std::vector<std::vector<Ball>> balls(tree.bodies.size());
    for (const Ball& ball : all_)
      balls[static_cast<std::size_t>(tree.body_of_link[static_cast<std::size_t>(ball.link)])]
          .push_back(ball);
    std::vector<bool> carries(tree.bodies.size(), false);
    for (std::size_t b = tree.bodies.size() - 1; b > 0; --b) {
      if (!carries[b] && balls[b].empty()) continue;
      carries[static_cast<std::size_t>(tree.bodies[b].parent)] = true;
    }
    std::vector<LastBody> last;
    for (std::size_t b = 1; b < tree.bodies.size(); ++b) {
      if (carries[b] || balls[b].empty()) continue;
      last.push_back({static_cast<int>(b) - 1, balls[b]});
    }
    return last;
  }

  EndEffector of_body(const LastBody& body) const {
    if (auto wheel = wheel_of(body)) return *wheel;
    if (auto surface = surface_of(body)) return *surface;
    return point_of(body);
  }

  std::optional<EndEffector> wheel_of(const LastBody& body) const {
    const Joint& joint = robot_.joints()[static_cast<std::size_t>(
        robot_.axes()[static_cast<std::size_t>(body.axis)].joint)];
    if (joint.type != JointType::kContinuous) return {};
    const Vector3d axis = state_.joint_axis(body.axis), origin = state_.joint_origin(body.axis);
    if (std::abs(axis.z()) > 0.3) return {};
    constexpr std::size_t kSectors = 16;
    std::array<double, kSectors> radii{};
    double from = std::numeric_limits<double>::infinity(), to = -from;
    const Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
    for (const Ball& ball : body.balls) {
      const Vector3d at = ball.centre - origin;
      const double along = at.dot(axis), radius = (at - along * axis).norm() + ball.radius;
      const double turn = std::atan2(at.dot(y), at.dot(x)) / (2.0 * std::numbers::pi) + 1.0;
      double& of_sector = radii[static_cast<std::size_t>(turn * kSectors) % kSectors];
      of_sector = std::max(of_sector, radius);
      from = std::min(from, along - ball.radius);
      to = std::max(to, along + ball.radius);
    }
    const auto [least, most] = std::ranges::minmax(radii);
    if (!(least >= (1.0 - kRoundShare) * most)) return {};
    EndEffector wheel;
    wheel.kind = ContactKind::kWheel;
    wheel.radius_m = most;
    place(wheel, joint.child_link, origin + 0.5 * (from + to) * axis);
    return wheel;
  }

  /// Where flats may look: straight down, along axes of shapes, and as most of a mesh's triangles.
  std::vector<Vector3d> directions_of(const LastBody& body) const {
    std::vector<Vector3d> directions = {-Vector3d::UnitZ()};
    const auto add = [&](const Vector3d& out) {
      if (out.z() < kDown) directions.push_back(out);
    };
    const int number = body.axis + 1;
    for (std::size_t l = 0; l < robot_.links().size(); ++l) {
      if (robot_.tree().body_of_link[l] != number) continue;
      for (const CollisionShape& shape : robot_.links()[l].collision) {
        const Eigen::Matrix3d axes =
            (state_.world_from_link(shape.link) * shape.link_from_shape).linear();
        for (int k = 0; k < 3; ++k) {
          for (const double sign : {-1.0, 1.0}) add(sign * axes.col(k));
        }
        if (shape.type == ShapeType::kMesh) {
          for (const Vector3d& out : flats_of(shape, axes)) add(out);
        }
      }
    }
    return directions;
  }

  /// Normals of a mesh's triangles that look down, the largest areas first.
  static std::vector<Vector3d> flats_of(const CollisionShape& shape, const Eigen::Matrix3d& axes) {
    constexpr double kAlike = 0.999;
    constexpr std::size_t kMost = 4, kSums = 200;
    const TriangleTree mesh = collision_mesh(shape);
    std::vector<Vector3d> areas;  // each along its normal
    for (std::size_t i = 0; i + 2 < mesh.corners().size(); i += 3) {
      const Vector3d* corner = &mesh.corners()[i];
      Vector3d area = axes * (corner[1] - corner[0]).cross(corner[2] - corner[0]);
      if (area.z() > 0.0) area = -area;  // mirrored meshes are inside out
      if (!(area.z() < kDown * area.norm())) continue;
      const auto alike = std::ranges::find_if(areas, [&](const Vector3d& sum) {
        return sum.dot(area) > kAlike * sum.norm() * area.norm();
      });
      if (alike != areas.end()) {
        *alike += area;
      } else if (areas.size() < kSums) {
        areas.push_back(area);
      }
    }
    std::ranges::sort(areas, std::greater(), [](const Vector3d& sum) { return sum.norm(); });
    if (areas.size() > kMost) areas.resize(kMost);
    for (Vector3d& area : areas) area.normalize();
    return areas;
  }

  std::optional<EndEffector> surface_of(const LastBody& body) const {
    std::optional<Flat> best;
    for (const Vector3d& out : directions_of(body)) {
      const std::optional<Flat> flat = flat_towards(body.balls, out);
      if (flat && (!best || flat->area() > 1.01 * best->area())) best = flat;
    }
    if (!best) return {};
    EndEffector surface;
    surface.kind = ContactKind::kSurface;
    surface.half_x_m = best->half_x_m;
    surface.half_y_m = best->half_y_m;
    const Eigen::Matrix3d link_from_world = place(surface, best->link, best->centre);
    surface.normal = link_from_world * -best->out;
    surface.forward = link_from_world * best->forward;
    return surface;
  }

  EndEffector point_of(const LastBody& body) const {
    const Ball* low = &body.balls.front();
    for (const Ball& ball : body.balls) {
      if (ball.centre.z() - ball.radius < low->centre.z() - low->radius) low = &ball;
    }
    EndEffector point;
    point.kind = ContactKind::kPoint;
    const Ball touching = low->radius > 0.0 ? *low : sphere_below(body.balls).value_or(*low);
    point.radius_m = touching.radius;
    place(point, low->link, touching.centre);
    return point;
  }

  /// How far a sphere reaches in a direction d is c d + r: by least squares over directions down to
  /// a slope.
  static std::optional<Ball> sphere_below(const std::vector<Ball>& balls) {
    const auto rows = static_cast<Eigen::Index>(1 + kRings * kRing);
    Eigen::Matrix<double, Eigen::Dynamic, 4> matrix(rows, 4);
    Eigen::VectorXd reach(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto ring = static_cast<double>((i + kRing - 1) / kRing);
      const double tilt = kMostTilt_rad * ring / kRings;
      const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / kRing;
      const Vector3d out(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                         -std::cos(tilt));
      reach[i] = furthest(balls, out);
      matrix.row(i) << out.transpose(), 1.0;
    }
    const Eigen::Vector4d fit = matrix.colPivHouseholderQr().solve(reach);
    const Eigen::VectorXd beyond = reach - matrix * fit;
    const double radius = fit[3] + std::max(0.0, beyond.maxCoeff());  // nothing reaches beyond it
    if (beyond.lpNorm<Eigen::Infinity>() > kSphere_m) return {};
    if (!(radius >= kLeastRadius_m && radius <= kMostRadius_m)) return {};
    return Ball{fit.head<3>(), radius, balls.front().link};
  }

  /// Returns the rotation of the link from the world.
  Eigen::Matrix3d place(EndEffector& effector, int link, const Vector3d& at) const {
    const Eigen::Isometry3d link_from_world = state_.world_from_link(link).inverse();
    effector.link = robot_.links()[static_cast<std::size_t>(link)].name;
    effector.point = link_from_world * at;
    return link_from_world.linear();
  }

  const Robot& robot_;
  RobotState state_;  // neutral
  std::vector<Ball> all_;
};

}  // namespace

std::vector<EndEffector> proposed_effectors(const Robot& robot) { return Proposals(robot).find(); }

}  // namespace locograph
