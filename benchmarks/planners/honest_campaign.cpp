// Honest plans and their honest variants: does the judge accept them all, and say the same of one
// curve however finely its vertices lie.
//
//     honest_campaign [--resample MS] [--seed N] PLAN.g2o…
//
// Plans are those of `locograph plan SCENARIO`. Each is judged as it is, and as
//   reversed   the same way back
//   moved      with all its world, turned about z and moved by up to 10 m; moved_far: by 14 km
//   resaved    written and read again: the same report to the bit, and the same file once more
//   resampled  the same curve with more vertices, one each millisecond
//   thinned    half of the vertices within each stance, another curve: it may be refused
// Maps are moved by whole voxels and not turned, as far as they reach. Plans of stances have no
// curve, and ways back among things that move are others: such variants are skipped. Each worst
// value of a variant's report is held against that of the plan's, in per cent of the larger of
// limit and worst values; `largest_difference_percent` is that of resampled plans, of which the
// judge should say the same. A contact's errors at vertices and between them are one,
// `contact_error`, where an angle counts as in contact_between; time_order and step_size tell of
// vertices, and are left out. Prints one JSON object; exits with 1 if an honest variant was
// refused, or a plan judged otherwise once it was saved or resampled.
#include <locograph/check/judge.h>
#include <locograph/check/limits.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/deadline.h>
#include <locograph/common/input_file.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/types/standard_types.h>
#include <unistd.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <tuple>

#include "command_line.h"

namespace locograph {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Eigen::Vector3d;

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * 0x1.0p-53 * static_cast<double>(random() >> 11);
}

struct Case {
  std::shared_ptr<const Robot> robot;
  Motion motion;
  World world;
  CheckOptions options;
};

Case case_of(const Graph& graph) {
  const Plan plan = plan_of(graph);
  Judging judging = judging_of(graph, plan, {.data_folder = data_folder()});
  judging.options.threads = 2;
  return {judging.robot, motion_of(graph, plan), judging.world->world(), judging.options};
}

// Variants ----------------------------------------------------------------------------------------

Motion reversed(const MotionCurve& curve) {
  const Motion& motion = curve.motion();
  const std::size_t count = motion.time_s.size();
  Motion back{.time_s = {},
              .configurations = {motion.configurations.rbegin(), motion.configurations.rend()},
              .stances = motion.stances,
              .stance_from = {},
              .stances_only = motion.stances_only};
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = count - 1 - k;
    back.time_s.push_back(motion.time_s.back() - motion.time_s[i]);
    back.stance_from.push_back(motion.stance_from[i > 0 ? i - 1 : 0]);
    back.slopes.push_back(-curve.slope(static_cast<int>(i)));
  }
  return back;
}

/// Everything moved as one.
Case moved(const Case& honest, const Eigen::Isometry3d& move) {
  Case result = honest;
  const Eigen::Quaterniond turn(move.linear());
  const auto move_contact = [&](Contact& contact) {
    contact.position = move * contact.position;
    contact.normal = move.linear() * contact.normal;
    if (contact.forward) contact.forward = move.linear() * *contact.forward;
  };
  if (honest.robot->floating_base()) {
    for (Eigen::VectorXd& q : result.motion.configurations) {
      q.head<3>() = move * Vector3d(q.head<3>());
      q.segment<4>(3) =
          (turn * Eigen::Quaterniond(Eigen::Vector4d(q.segment<4>(3)))).normalized().coeffs();
    }
    for (Eigen::VectorXd& slope : result.motion.slopes) {
      if (slope.size() > 0) slope.head<3>() = move.linear() * Vector3d(slope.head<3>());
    }
  }
  for (Stance& stance : result.motion.stances) std::ranges::for_each(stance.contacts, move_contact);
  std::ranges::for_each(result.options.places, move_contact);
  for (Surface& surface : result.world.surfaces)
    surface.world_from_surface = move * surface.world_from_surface;
  for (SolidBox& solid : result.world.solids) solid.world_from_box = move * solid.world_from_box;
  for (Bar& bar : result.world.bars) {
    bar.from = move * bar.from;
    bar.to = move * bar.to;
  }
  for (Obstacle& obstacle : result.world.obstacles) {
    obstacle.world_from_obstacle = move * obstacle.world_from_obstacle;
    for (KeyFrame& frame : obstacle.motion) frame.pose = move * frame.pose;
  }
  return result;
}

/// As far as whole voxels, without a turn: a map has its own grid.
Eigen::Isometry3d whole_voxels(const Eigen::Isometry3d& move, double resolution_m) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  for (int k = 0; k < 3; ++k)
    result.translation()[k] = resolution_m * std::round(move.translation()[k] / resolution_m);
  return result;
}

/// What is occupied, moved by whole voxels; null: it does not reach so far.
std::shared_ptr<const octomap::OcTree> moved(const octomap::OcTree& map, const Vector3d& by) {
  const double resolution_m = map.getResolution();
  const auto result = std::make_shared<octomap::OcTree>(resolution_m);
  for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
    if (!map.isNodeOccupied(*leaf)) continue;
    const int across = static_cast<int>(std::lround(leaf.getSize() / resolution_m));
    const octomap::point3d corner = leaf.getCoordinate();
    for (int i = 0; i < across * across * across; ++i) {
      const auto centre = [&](int cell, int k) {
        return static_cast<double>(corner(static_cast<unsigned>(k))) +
               (0.5 * (1 - across) + cell) * resolution_m + by[k];
      };
      octomap::OcTreeKey key;
      if (!result->coordToKeyChecked(centre(i % across, 0), centre(i / across % across, 1),
                                     centre(i / (across * across), 2), key)) {
        return nullptr;
      }
      result->setNodeValue(key, leaf->getLogOdds(), true);
    }
  }
  result->updateInnerOccupancy();
  result->prune();
  return result;
}

Eigen::Isometry3d any_move(std::mt19937_64& random, double distance_m) {
  const double heading = uniform(random, -EIGEN_PI, EIGEN_PI);
  Eigen::Isometry3d move(
      Eigen::AngleAxisd(uniform(random, -EIGEN_PI, EIGEN_PI), Vector3d::UnitZ()));
  move.translation() = distance_m * Vector3d(std::cos(heading), std::sin(heading), 0.0);
  return move;
}

/// The vertices, and a grid in between that keeps away from them, for rounding.
std::vector<double> fine_times(const Motion& motion, double step_s) {
  const double away_s = 0.1 * step_s, begin_s = motion.time_s.front();
  std::vector<double> times = {begin_s};
  for (std::size_t i = 1; i < motion.time_s.size(); ++i) {
    const double from_s = motion.time_s[i - 1] + away_s, to_s = motion.time_s[i] - away_s;
    for (double k = std::ceil((from_s - begin_s) / step_s); begin_s + k * step_s < to_s; ++k)
      times.push_back(begin_s + k * step_s);
    times.push_back(motion.time_s[i]);
  }
  return times;
}

/// Without every second vertex of those at which the stance stays.
Motion thinned(const MotionCurve& curve) {
  const Motion& motion = curve.motion();
  Motion result{.time_s = {}, .configurations = {}, .stances = motion.stances, .stance_from = {}};
  bool dropped = false;
  for (std::size_t i = 0; i < motion.time_s.size(); ++i) {
    const bool inner =
        i > 0 && i + 1 < motion.time_s.size() && motion.stance_from[i - 1] == motion.stance_from[i];
    dropped = inner && !dropped;
    if (dropped) continue;
    result.time_s.push_back(motion.time_s[i]);
    result.configurations.push_back(motion.configurations[i]);
    result.stance_from.push_back(motion.stance_from[i]);
    result.slopes.push_back(curve.slope(static_cast<int>(i)));
  }
  return result;
}

// Reports -----------------------------------------------------------------------------------------

bool same(const Violation& a, const Violation& b) {
  const auto all = [](const Violation& v) {
    return std::tie(v.constraint, v.worst, v.unit, v.limit, v.at_vertex, v.count, v.time_s,
                    v.at_point, v.what, v.violated, v.judged, v.why_not);
  };
  return all(a) == all(b);
}

bool same(const CheckReport& a, const CheckReport& b) {
  const auto all = [](const CheckReport& r) {
    return std::tie(r.feasible, r.configurations, r.samples, r.trusted, r.min_clearance_m,
                    r.min_self_clearance_m, r.min_balance_margin, r.max_torque_ratio,
                    r.max_velocity_ratio, r.max_contact_error_m);
  };
  const auto same_violation = [](const Violation& v, const Violation& w) { return same(v, w); };
  return all(a) == all(b) && a.balance.has_value() == b.balance.has_value() &&
         (!a.balance ||
          (a.balance->margin == b.balance->margin && a.balance->wrenches == b.balance->wrenches)) &&
         std::ranges::equal(a.violations, b.violations, same_violation);
}

/// What the report says of the curve, whichever its vertices are.
std::map<std::string, Violation> of_the_curve(const CheckReport& report) {
  std::map<std::string, Violation> result;
  for (const Violation& violation : report.violations) {
    if (!violation.judged || violation.constraint == "time_order" ||
        violation.constraint == "step_size") {
      continue;
    }
    Violation v = violation;
    if (v.constraint == "contact_orientation") v.worst *= limits::kHeld_m / limits::kHeld_rad;
    if (v.constraint == "contact_position" || v.constraint == "contact_orientation" ||
        v.constraint == "contact_between") {
      v.constraint = "contact_error";
      v.limit = limits::kHeld_m;
    }
    const auto [found, added] = result.emplace(v.constraint, v);
    if (!added && v.worst > found->second.worst) found->second = v;
  }
  return result;
}

struct Difference {
  double percent = -1.0;
  std::string plan;
  Violation was, is;
};
using Differences = std::map<std::string, Difference>;

void compare(const std::string& plan, const CheckReport& was, const CheckReport& is,
             Differences& largest) {
  const std::map<std::string, Violation> before = of_the_curve(was), after = of_the_curve(is);
  for (const auto& [name, a] : before) {
    const auto b = after.find(name);
    if (b == after.end() || a.worst == b->second.worst) {
      largest.try_emplace(name, Difference{0.0, plan, a, a});
      continue;
    }
    const double size = std::max({std::abs(a.limit), std::abs(a.worst), std::abs(b->second.worst)});
    const double percent = 100.0 * std::abs(a.worst - b->second.worst) / size;
    Difference& most = largest[name];
    if (!(percent <= most.percent)) most = {percent, plan, a, b->second};
  }
}

/// Where nothing differs at all, that is all there is to say.
Json json_of(const Differences& differences) {
  Json json = Json::object();
  for (const auto& [name, d] : differences) {
    json[name] = {{"percent", d.percent}};
    if (d.percent == 0.0) continue;
    json[name].update({{"plan", d.plan},
                       {"was", d.was.worst},
                       {"is", d.is.worst},
                       {"limit", d.was.limit},
                       {"unit", d.was.unit},
                       {"was_at_s", d.was.time_s},
                       {"is_at_s", d.is.time_s},
                       {"was_what", d.was.what},
                       {"is_what", d.is.what}});
  }
  return json;
}

// The campaign ------------------------------------------------------------------------------------

class Campaign {
 public:
  Campaign(double resample_s, std::uint64_t seed)
      : resample_s_(resample_s), random_(seed), types_(standard_types()) {
    add_robot_types(types_);
    std::string folder = (fs::temp_directory_path() / "honest-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw Error("no folder for copies of plans", "one");
    folder_ = folder;
  }
  ~Campaign() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  void run(const std::string& file) {
    plan_ = fs::path(file).stem();
    const Graph graph = read_graph(file, types_);
    const Case honest = case_of(graph);
    ++counts_["plans"];
    const CheckReport report = judged("as_it_is", honest);
    if (accepted("as_it_is", report)) ++counts_["accepted"];
    const MotionCurve curve(*honest.robot, honest.motion);
    run_reversed(honest, curve, report);
    run_moved(honest, report);
    run_resaved(graph, report);
    if (honest.motion.stances_only || honest.motion.time_s.size() < 2) {
      skip("resampled, thinned", "nothing moves");
      return;
    }
    run_resampled(honest, curve, report);
    run_thinned(honest, curve);
  }

  bool all_well() const { return all_well_; }

  Json json() const {
    Json json = Json::object();
    for (const auto& [name, count] : counts_) json[name] = count;
    json["refused"] = refused_;
    json["thinned_refused"] = thinned_refused_;
    json["skipped"] = skipped_;
    for (const char* variant : {"resampled", "reversed", "moved", "moved_far"}) {
      const auto found = differences_.find(variant);
      const bool asked = std::string(variant) == "resampled";
      json[asked ? "largest_difference_percent"
                 : "largest_difference_percent_" + std::string(variant)] =
          found == differences_.end() ? Json::object() : json_of(found->second);
    }
    json["judge_s"] = seconds_;
    return json;
  }

 private:
  void run_reversed(const Case& honest, const MotionCurve& curve, const CheckReport& report) {
    const auto moves = [](const Obstacle& obstacle) { return !obstacle.motion.empty(); };
    if (std::ranges::any_of(honest.world.obstacles, moves)) {
      skip("reversed", "something moves in its world");
      return;
    }
    Case back = honest;
    back.motion = reversed(curve);
    run_variant("reversed", back, report);
  }

  void run_moved(const Case& honest, const CheckReport& report) {
    const double distance_m = uniform(random_, 0.0, 10.0);
    run_moved("moved", honest, any_move(random_, distance_m), report);
    run_moved("moved_far", honest, any_move(random_, 14e3), report);
  }

  void run_moved(const std::string& name, const Case& honest, const Eigen::Isometry3d& move,
                 const CheckReport& report) {
    if (!honest.world.map) {
      run_variant(name, moved(honest, move), report);
      return;
    }
    const Eigen::Isometry3d by = whole_voxels(move, honest.world.map->getResolution());
    Case elsewhere = moved(honest, by);
    elsewhere.world.map = moved(*honest.world.map, by.translation());
    if (elsewhere.world.map) {
      run_variant(name, elsewhere, report);
    } else {
      skip(name, "its map does not reach so far");
    }
  }

  void run_resaved(const Graph& graph, const CheckReport& report) {
    const fs::path once = folder_ / "once.g2o", twice = folder_ / "twice.g2o";
    write_graph(graph, once);
    const Graph again = read_graph(once, types_);
    write_graph(again, twice);
    const bool same_file = read_file(once) == read_file(twice);
    const bool same_report = same(report, judged("resaved", case_of(again)));
    counts_["resaved_same"] += same_file && same_report ? 1 : 0;
    if (!same_file) refuse("resaved", "another file when it is saved again");
    if (!same_report) refuse("resaved", "another report");
  }

  void run_resampled(const Case& honest, const MotionCurve& curve, const CheckReport& report) {
    Case fine = honest;
    fine.motion = resampled(curve, fine_times(honest.motion, resample_s_));
    const CheckReport is = judged("resampled", fine);
    compare(plan_, report, is, differences_["resampled"]);
    counts_["resampled_same_verdict"] += is.feasible == report.feasible ? 1 : 0;
    if (report.feasible) accepted("resampled", is);
    if (!report.feasible && is.feasible) refuse("resampled", "accepted, its plan is not");
  }

  void run_thinned(const Case& honest, const MotionCurve& curve) {
    Case few = honest;
    few.motion = thinned(curve);
    const CheckReport report = judged("thinned", few);
    ++counts_["thinned"];
    counts_["thinned_feasible"] += report.feasible ? 1 : 0;
    for (const Violation* violation : report.violated())
      thinned_refused_.push_back(plan_ + ": " + violation_text(*violation));
  }

  void run_variant(const std::string& name, const Case& variant, const CheckReport& was) {
    const CheckReport report = judged(name, variant);
    counts_[name + "_accepted"] += accepted(name, report) ? 1 : 0;
    compare(plan_, was, report, differences_[name]);
  }

  CheckReport judged(const std::string& variant, const Case& what) {
    const Judge judge(what.robot, what.world);
    const Stopwatch watch;
    CheckReport report = judge.check(what.motion, what.options);
    seconds_[plan_][variant] = watch.seconds();
    std::cerr << plan_ << ", " << variant << ": " << report.configurations << " vertices, "
              << (report.feasible ? "feasible" : "refused") << ", " << watch.seconds() << " s\n";
    return report;
  }

  bool accepted(const std::string& variant, const CheckReport& report) {
    if (report.feasible) return true;
    const std::vector<const Violation*> violated = report.violated();
    for (const Violation* violation : violated) refuse(variant, violation_text(*violation));
    if (violated.empty()) {
      refuse(variant, violation_text(report.constraint("static_balance")));
    }
    return false;
  }

  void refuse(const std::string& variant, const std::string& why) {
    all_well_ = false;
    refused_.push_back(plan_ + ", " + variant + ": " + why);
  }
  void skip(const std::string& variant, const std::string& why) {
    skipped_.push_back(plan_ + ", " + variant + ": " + why);
  }

  double resample_s_;
  std::mt19937_64 random_;
  TypeRegistry types_;
  fs::path folder_;
  std::string plan_;  // the one that is judged now
  bool all_well_ = true;
  nlohmann::ordered_map<std::string, int> counts_ = {{"plans", 0},
                                                     {"accepted", 0},
                                                     {"reversed_accepted", 0},
                                                     {"moved_accepted", 0},
                                                     {"moved_far_accepted", 0},
                                                     {"resaved_same", 0},
                                                     {"resampled_same_verdict", 0},
                                                     {"thinned", 0},
                                                     {"thinned_feasible", 0}};
  Json refused_ = Json::array(), thinned_refused_ = Json::array(), skipped_ = Json::array();
  Json seconds_ = Json::object();
  std::map<std::string, Differences> differences_;
};

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("Honest plans and variants that the judge is shown",
                              "honest_campaign");
  double resample_ms = 1.0;
  std::uint64_t seed = 1;
  std::vector<std::string> files;
  app.add_option("--resample", resample_ms, "Between vertices of resampled plans [ms]").positive();
  app.add_option("--seed", seed, "Of the ways in which plans are moved");
  app.add_option("PLAN", files, "Plan files (.g2o)").required();
  bool all_well = true;
  const int code = locograph::run_benchmark(app, argc, argv, [&] {
    locograph::Campaign campaign(1e-3 * resample_ms, seed);
    for (const std::string& file : files) campaign.run(file);
    std::cout << campaign.json().dump(2) << '\n';
    all_well = campaign.all_well();
  });
  return code != 0 ? code : all_well ? 0 : 1;
}
