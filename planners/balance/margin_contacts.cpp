#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/balance/margin_contacts.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/statics.h>

#include <algorithm>

namespace locograph {
namespace {

constexpr double kWideEnough_m = 0.02;
constexpr int kHalvings = 6;

/// The largest share for which `holds`, which does not for larger ones.
template <class F>
double largest_share(const F& holds) {
  if (holds(1.0)) return 1.0;
  double least = 0.0, most = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (least + most);
    (holds(middle) ? least : most) = middle;
  }
  return least;
}

}  // namespace

std::vector<BearingContact> with_margin(std::span<const BearingContact> contacts,
                                        const ExecutionMargin& margin, double weight_N) {
  std::vector<BearingContact> counted(contacts.begin(), contacts.end());
  for (BearingContact& bearing : counted) {
    EndEffector& effector = bearing.contact.effector;
    if (contact_kind_entry(effector.kind).pressed) {
      bearing.least_N = margin.least_force * weight_N;
      effector.friction *= margin.friction;
    } else {  // a grasp slips where its forces are too large, and turns where its moments are
      effector.max_force_N *= margin.friction;
      effector.max_moment_Nm *= margin.area;
    }
    if (margin.area == 1.0) continue;
    effector.half_x_m *= margin.area;
    effector.half_y_m *= margin.area;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : bearing.area) {
      middle += corner / static_cast<double>(bearing.area.size());
    }
    for (Eigen::Vector2d& corner : bearing.area) {
      corner = middle + margin.area * (corner - middle);
    }
  }
  return counted;
}

double share_of_margin(double mass_kg, std::span<const BearingContact> contacts,
                       const ExecutionMargin& margin,
                       std::span<const Eigen::Vector2d> centres_of_mass) {
  const double weight_N = mass_kg * standard_gravity().norm();
  return largest_share([&](double share) {
    const auto counted = with_margin(contacts, margin.scaled(share), weight_N);
    return std::ranges::all_of(centres_of_mass, [&](const Eigen::Vector2d& centre) {
      return balances(mass_kg, counted, kRegionMargin, centre);
    });
  });
}

double share_of_margin(double mass_kg, std::span<const BearingContact> contacts,
                       const ExecutionMargin& margin) {
  const double weight_N = mass_kg * standard_gravity().norm();
  const auto width_m = [&](double share) {
    const auto counted = with_margin(contacts, margin.scaled(share), weight_N);
    return balance_region(mass_kg, counted, kRegionMargin).width_m;
  };
  const double enough_m = std::min(kWideEnough_m, 0.5 * width_m(0.0));
  return largest_share([&](double share) { return width_m(share) >= enough_m; });
}

}  // namespace locograph
