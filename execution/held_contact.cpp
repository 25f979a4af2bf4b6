#include <locograph/common/check_option.h>
#include <locograph/execution/held_contact.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/rolling_ball.h>
#include <locograph/world/convex_hull.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace locograph {
namespace {

constexpr int kFacets = 8;
constexpr int kGrid = 48;              // places at which a rectangle may begin and end
constexpr double kSomeWidth_m = 1e-4;  // by which rectangles without any are told apart

struct Range {
  double low, high;
};

/// Of a convex polygon, along y at x.
Range across(const std::vector<PlanePoint>& hull, double x) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Range range{kNone, -kNone};
  const auto take = [&](double y) {
    range.low = std::min(range.low, y);
    range.high = std::max(range.high, y);
  };
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const PlanePoint &a = hull[i], &b = hull[(i + 1) % hull.size()];
    if (x < std::min(a.x, b.x) || x > std::max(a.x, b.x)) continue;
    if (a.x == b.x) {
      take(a.y);
      take(b.y);
    } else {
      take(a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y));
    }
  }
  return range;
}

}  // namespace

const std::string& name_of(const EndEffector& effector) {
  return effector.name.empty() ? effector.link : effector.name;
}

std::size_t effector_of(std::span<const EndEffector> effectors, const Contact& contact) {
  const auto named = std::find_if(
      effectors.begin(), effectors.end(),
      [&](const EndEffector& effector) { return name_of(effector) == contact.name(); });
  return static_cast<std::size_t>(named - effectors.begin());
}

double rolling_radius_m(const EndEffector& effector) {
  return is_ball(effector) || effector.kind == ContactKind::kWheel ? effector.radius_m : 0.0;
}

Eigen::Vector3d normal_at(const Contact& contact, const Eigen::Vector3d& point) {
  return is_ball(contact.effector) ? BallTrack(contact).normal(point)
                                   : Eigen::Vector3d(contact.normal.normalized());
}

void HoldingShares::validate() const {
  check_option(friction > 0.0 && friction <= 1.0, "friction", "above 0, at most 1");
  check_option(most_friction >= friction && most_friction <= 1.0, "most_friction",
               "no less than friction, at most 1");
  check_option(area > 0.0 && area <= 1.0, "area", "above 0, at most 1");
}

InnerRectangle inner_rectangle(std::span<const Eigen::Vector2d> points) {
  std::vector<PlanePoint> corners;
  for (const Eigen::Vector2d& point : points) corners.push_back({point.x(), point.y()});
  const std::vector<PlanePoint> hull = convex_hull(corners);
  Eigen::Vector2d lower = points.front(), upper = points.front();
  for (const Eigen::Vector2d& point : points) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  InnerRectangle best{0.5 * (lower + upper), 0.5 * (lower + upper)};
  const Eigen::Vector2d size = upper - lower;
  if (hull.size() < 3 || size.minCoeff() < kSomeWidth_m) {
    const int axis = size.x() >= size.y() ? 0 : 1;
    best.lower[axis] = lower[axis];
    best.upper[axis] = upper[axis];
    return best;
  }
  std::array<Range, kGrid + 1> ranges;
  const auto place = [&](int i) { return lower.x() + size.x() * i / kGrid; };
  for (int i = 0; i <= kGrid; ++i) {
    ranges[static_cast<std::size_t>(i)] = across(hull, std::min(place(i), upper.x()));
  }
  double largest = -1.0;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = i + 1; j <= kGrid; ++j) {
      const Range &left = ranges[static_cast<std::size_t>(i)],
                  &right = ranges[static_cast<std::size_t>(j)];
      const double low = std::max(left.low, right.low), high = std::min(left.high, right.high);
      const double area = (place(j) - place(i)) * (high - low);
      if (!(high >= low) || area <= largest) continue;
      largest = area;
      best = {{place(i), low}, {place(j), high}};
    }
  }
  return best;
}

HeldContact::HeldContact(const Contact& contact, std::span<const Eigen::Vector2d> area,
                         const HoldingShares& shares)
    : contact_(contact) {
  shares.validate();
  Contact used = contact;
  EndEffector& effector = used.effector;
  if (!area.empty() && effector.kind == ContactKind::kSurface) {
    const InnerRectangle inner = inner_rectangle(area);
    middle_ = 0.5 * (inner.lower + inner.upper);
    effector.half_x_m = 0.5 * (inner.upper.x() - inner.lower.x());
    effector.half_y_m = 0.5 * (inner.upper.y() - inner.lower.y());
  }
  effector.half_x_m *= shares.area;
  effector.half_y_m *= shares.area;
  if (effector.kind == ContactKind::kSurface) half_m_ = {effector.half_x_m, effector.half_y_m};
  const double friction = effector.friction;
  const ContactKindEntry& kind = contact_kind_entry(effector.kind);
  pressed_ = kind.pressed;
  FrictionModel model;
  if (pressed_) model = {.cone = FrictionCone::kInner, .facets = kFacets};
  const EndEffector all = effector;
  const auto cone_with = [&](double share) {
    effector.friction = share * friction;
    if (!pressed_) {
      effector.max_force_N = share * all.max_force_N;
      effector.max_moment_Nm = share * all.max_moment_Nm;
    }
    return kind.wrench_cone(used, model);
  };
  cone_ = cone_with(shares.friction);
  widest_ = cone_with(shares.most_friction);
}

/// About the middle c the moment is m - c x f.
WrenchRow HeldContact::row(int i, double reserve) const {
  static constexpr double kZero[6] = {};
  WrenchRow limit = cone_->row(i, kZero);
  const WrenchRow widest = widest_->row(i, kZero);
  limit.gradient += reserve * (widest.gradient - limit.gradient);
  limit.offset += reserve * (widest.offset - limit.offset);
  if (middle_.isZero()) return limit;
  const Eigen::Vector3d moment = limit.gradient.tail<3>();
  const Eigen::Vector3d middle(middle_.x(), middle_.y(), 0.0);
  limit.gradient.head<3>() -= moment.cross(middle);
  return limit;
}

}  // namespace locograph
