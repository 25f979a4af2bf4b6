#include <locograph/world/bent_legs.h>
#include <locograph/world/left_out_pairs.h>
#include <locograph/world/link_pairs.h>
#include <locograph/world/proposed_effectors.h>

namespace locograph {
namespace {

constexpr int kNearJoints = 3;
constexpr std::size_t kLegs = 2;         // of a robot that stands, at least
constexpr double kStandingGap_m = 6e-3;  // planners keep links 4 mm apart

}  // namespace

int joints_between(const Robot& robot, int first, int second) {
  const auto a = robot.support(first), b = robot.support(second);
  std::size_t common = 0;
  while (common < a.size() && common < b.size() && a[common] == b[common]) ++common;
  return static_cast<int>(a.size() + b.size() - 2 * common);
}

std::vector<std::pair<int, int>> always_overlapping_links(const Robot& robot) {
  LinkPairOptions options{.samples = 300, .stop_when_decided = true};
  options.only = overlapping_links(robot, robot.neutral_configuration());
  std::vector<std::pair<int, int>> always;
  if (options.only.empty()) return always;
  for (const LinkPair& pair : sample_link_pairs(robot, options).pairs) {
    if (pair.always_meets(options.samples)) always.emplace_back(pair.first, pair.second);
  }
  return always;
}

std::vector<std::pair<int, int>> overlapping_as_it_stands(const Robot& robot,
                                                          const Eigen::VectorXd& standing) {
  std::vector<std::pair<int, int>> pairs = overlapping_links(robot, standing, kStandingGap_m);
  std::erase_if(pairs, [&](const auto& pair) {
    return joints_between(robot, pair.first, pair.second) > kNearJoints;
  });
  return pairs;
}

void leave_out_overlapping(Robot& robot) {
  if (!robot.srdf_file().empty() || !robot.missing_meshes().empty()) return;
  robot.leave_out_pairs(always_overlapping_links(robot));
  const std::vector<EndEffector> effectors = proposed_effectors(robot);
  if (effectors.size() < kLegs) return;
  robot.leave_out_pairs(overlapping_as_it_stands(robot, bent_legs(robot, effectors)));
}

}  // namespace locograph
