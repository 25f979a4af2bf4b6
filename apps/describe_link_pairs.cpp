#include <locograph/apps/describe.h>
#include <locograph/apps/robot_files.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace locograph {
namespace {

/// One object for each pair that `chosen` picks, those that meet most often first.
template <class Predicate>
Json pair_list(const Robot& robot, const LinkPairs& found, Predicate&& chosen) {
  std::vector<LinkPair> picked;
  std::copy_if(found.pairs.begin(), found.pairs.end(), std::back_inserter(picked), chosen);
  std::stable_sort(picked.begin(), picked.end(),
                   [](const LinkPair& a, const LinkPair& b) { return a.meets > b.meets; });
  Json list = Json::array();
  for (const LinkPair& pair : picked) {
    list.push_back({{"link1", robot.links()[static_cast<std::size_t>(pair.first)].name},
                    {"link2", robot.links()[static_cast<std::size_t>(pair.second)].name},
                    {"adjacent", pair.adjacent},
                    {"meets_percent", std::round(1e4 * pair.meets / found.samples) / 100.0}});
  }
  return list;
}

}  // namespace

Json describe_link_pairs(const std::string& name_or_file, const LinkPairOptions& options) {
  const RobotFiles files = robot_files(name_or_file, "");
  const Robot robot = Robot::load(files.urdf, files.srdf, {.lenient_srdf = true});
  const LinkPairs found = sample_link_pairs(robot, options);
  const auto list = [&](auto&& chosen) { return pair_list(robot, found, chosen); };
  const auto count = [&](auto&& chosen) {
    return std::count_if(found.pairs.begin(), found.pairs.end(), chosen);
  };
  const int samples = found.samples;
  return {{"file", files.urdf.string()},
          {"srdf", files.srdf.empty() ? Json(nullptr) : Json(files.srdf.string())},
          {"samples", samples},
          {"seed", options.seed},
          {"pairs", found.pairs.size()},
          {"off", count([](const LinkPair& p) { return !p.on; })},
          {"off_and_never_meet", count([](const LinkPair& p) { return !p.on && p.meets == 0; })},
          {"off_and_always_meet",
           list([&](const LinkPair& p) { return !p.on && p.always_meets(samples); })},
          {"off_and_adjacent", count([](const LinkPair& p) { return !p.on && p.adjacent; })},
          {"wrongly_off", list([&](const LinkPair& p) { return !p.on && !p.may_be_off(samples); })},
          {"on_but_always_meet",
           list([&](const LinkPair& p) { return p.on && p.always_meets(samples); })}};
}

}  // namespace locograph
