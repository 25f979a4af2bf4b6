#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/balance/linear_programme.h>
#include <locograph/robots/statics.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace locograph {
namespace {

/// Corners that are nearer to each other are one.
constexpr double kSame_m = 1e-4;
constexpr int kMostProgrammes = 40;

using Wrench = Eigen::Matrix<double, 6, 1>;

/// The linear programme: forces at the contacts in parts of the weight, then, unless it is given, x
/// and y of the centre of mass about `origin`.
class CentreOfMassProgramme {
 public:
  CentreOfMassProgramme(double weight_N, std::span<const BearingContact> contacts, double margin,
                        const std::optional<Eigen::Vector2d>& centre_of_mass = {})
      : weight_N_(weight_N), margin_(margin) {
    for (const BearingContact& bearing : contacts) origin_ += bearing.contact.position;
    origin_ /= static_cast<double>(contacts.size());
    for (const BearingContact& bearing : contacts) {
      if (bearing.contact.bears_load) add(bearing);
    }
    build(centre_of_mass);
  }

  bool is_feasible() { return programme_.solve() == LinearAnswer::kOptimal; }

  /// The furthest point along a direction; false where nothing balances.
  bool furthest(const Eigen::Vector2d& direction, Eigen::Vector2d& point) {
    const int x = static_cast<int>(columns_.size());
    programme_.cost().segment<2>(x) = -direction;
    // From the last direction's corner.
    if (programme_.solve() != LinearAnswer::kOptimal) return false;
    point = origin_.head<2>() + programme_.solution().segment<2>(x);
    return point.allFinite();
  }

 private:
  struct Column {
    Wrench wrench;  ///< on the robot, about origin_, in parts of the weight
    int limit;      ///< row of its contact's force limit; -1: none
    double lower, upper;
  };

  void add(const BearingContact& bearing) {
    int limit = -1;
    if (const double most = most_of_rays(bearing.contact, margin_, weight_N_); most >= 0.0) {
      limit = limits_++;
      most_.push_back(most);
      const double least = least_of_rays(bearing, weight_N_);
      least_.push_back(least > 0.0 ? least : -kNoBound);
    }
    for (const BearingRay& ray : bearing_rays(bearing, margin_, weight_N_)) {
      Column column{{}, limit, ray.lower, ray.upper};
      column.wrench << ray.force, (ray.at - origin_).cross(ray.force) + ray.moment;
      columns_.push_back(column);
    }
  }

  void build(const std::optional<Eigen::Vector2d>& centre_of_mass) {
    const int forces = static_cast<int>(columns_.size());
    programme_.resize(6 + limits_, forces + (centre_of_mass ? 0 : 2));
    Eigen::MatrixXd& matrix = programme_.matrix();
    for (int c = 0; c < forces; ++c) {
      const Column& column = columns_[static_cast<std::size_t>(c)];
      matrix.col(c).head<6>() = column.wrench;
      if (column.limit >= 0) matrix(6 + column.limit, c) = 1.0;
      programme_.bound_column(c, column.lower, column.upper);
    }
    for (int i = 0; i < 6; ++i) programme_.bound_row(i, 0.0, 0.0);
    programme_.bound_row(2, 1.0, 1.0);
    // The weight at (x, y): moment (x, y, .) x (0, 0, -1) = (-y, x, 0).
    if (!centre_of_mass) {
      matrix(4, forces) = 1.0;
      matrix(3, forces + 1) = -1.0;
      for (const int c : {forces, forces + 1}) programme_.bound_column(c, -kNoBound, kNoBound);
    } else {
      const Eigen::Vector2d from_origin = *centre_of_mass - origin_.head<2>();
      programme_.bound_row(3, from_origin.y(), from_origin.y());
      programme_.bound_row(4, -from_origin.x(), -from_origin.x());
    }
    for (int i = 0; i < limits_; ++i) {
      programme_.bound_row(6 + i, least_[static_cast<std::size_t>(i)],
                           most_[static_cast<std::size_t>(i)]);
    }
  }

  double weight_N_, margin_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<Column> columns_;
  std::vector<double> least_, most_;
  int limits_ = 0;
  LinearProgramme programme_;
};

/// Appends the corners between two, counter-clockwise.
void corners_between(CentreOfMassProgramme& programme, const Eigen::Vector2d& from,
                     const Eigen::Vector2d& to, double resolution_m, int& programmes,
                     std::vector<Eigen::Vector2d>& corners) {
  const Eigen::Vector2d along = to - from;
  if (along.norm() < resolution_m || ++programmes > kMostProgrammes) return;
  const Eigen::Vector2d out = Eigen::Vector2d(along.y(), -along.x()).normalized();
  Eigen::Vector2d corner;
  if (!programme.furthest(out, corner) || out.dot(corner - from) < resolution_m) return;
  corners_between(programme, from, corner, resolution_m, programmes, corners);
  corners.push_back(corner);
  corners_between(programme, corner, to, resolution_m, programmes, corners);
}

/// Counter-clockwise; fewer than three where there is no area.
std::vector<Eigen::Vector2d> corners_of(CentreOfMassProgramme& programme, double resolution_m) {
  Eigen::Vector2d left, right;
  if (!programme.furthest(-Eigen::Vector2d::UnitX(), left) ||
      !programme.furthest(Eigen::Vector2d::UnitX(), right)) {
    return {};
  }
  int programmes = 2;
  std::vector<Eigen::Vector2d> corners = {left};
  corners_between(programme, left, right, resolution_m, programmes, corners);
  corners.push_back(right);
  corners_between(programme, right, left, resolution_m, programmes, corners);
  return corners;
}

bool any_bears(std::span<const BearingContact> contacts) {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const BearingContact& bearing) { return bearing.contact.bears_load; });
}

}  // namespace

double BalanceRegion::depth_m(const Eigen::Vector2d& centre_of_mass) const {
  double depth = sides.empty() ? -std::numeric_limits<double>::infinity()
                               : std::numeric_limits<double>::infinity();
  for (const Side& side : sides) {
    depth = std::min(depth, side.offset_m - side.normal.dot(centre_of_mass));
  }
  return depth;
}

BalanceRegion balance_region(double mass_kg, std::span<const BearingContact> contacts,
                             double margin, double resolution_m) {
  BalanceRegion region;
  if (!any_bears(contacts)) return region;
  CentreOfMassProgramme programme(mass_kg * standard_gravity().norm(), contacts, margin);
  const std::vector<Eigen::Vector2d> corners = corners_of(programme, resolution_m);
  if (corners.size() < 3) return region;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d along = corners[(i + 1) % corners.size()] - corners[i];
    if (along.norm() < kSame_m) continue;
    const Eigen::Vector2d normal = Eigen::Vector2d(along.y(), -along.x()).normalized();
    region.sides.push_back({normal, normal.dot(corners[i])});
  }
  region.width_m = std::numeric_limits<double>::infinity();
  for (const BalanceRegion::Side& side : region.sides) {
    double across = 0.0;
    for (const Eigen::Vector2d& corner : corners) {
      across = std::max(across, side.offset_m - side.normal.dot(corner));
    }
    region.width_m = std::min(region.width_m, across);
  }
  if (!(region.width_m > kSame_m)) region.sides.clear();
  return region;
}

bool balances(double mass_kg, std::span<const BearingContact> contacts, double margin,
              const Eigen::Vector2d& centre_of_mass) {
  return any_bears(contacts) && CentreOfMassProgramme(mass_kg * standard_gravity().norm(), contacts,
                                                      margin, centre_of_mass)
                                    .is_feasible();
}

}  // namespace locograph
