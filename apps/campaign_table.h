#pragma once
/// The runs of a campaign: one for each seed, kept in a CSV file (RFC 4180), and what they say
/// together.
///
///     CampaignTable table({.scenario = "centauro_drive", .options = "--timeout 60"});
///     if (std::filesystem::exists("runs.csv")) table.read("runs.csv");
///     if (!table.has(7)) table.add(campaign_run(plan_json, 7));
///     write_file_atomically("runs.csv", table.csv());
///
/// Columns: scenario, planner, options, seed, solved (true or false), reason, and the quantities;
/// a field is empty where a run does not tell the quantity. Numbers are read back to the same bits.

#include <locograph/apps/output.h>

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

/// A number that `plan --json` tells, or `simulate --json`, whose answer is its `simulation`.
struct CampaignQuantity {
  const char* name;
  const char* place;      ///< JSON pointer into what `plan` prints; true counts as 1
  bool whole_plans_only;  ///< says nothing of plans that are stances only
};

inline constexpr std::array<CampaignQuantity, 33> kCampaignQuantities = {{
    {"planning_time", "/time/total", false},
    {"transition_time", "/time/transitions", false},
    {"iterations", "/iterations", false},
    {"vertices_in_tree", "/vertices_in_tree", false},
    {"stances", "/stances", false},
    {"whole_body_time", "/time/whole_body", true},
    {"timing_time", "/time/timing", true},
    {"duration_s", "/duration_s", true},
    {"stance_planner_time", "/time/stance_planner", false},
    {"judge_time", "/time/judge", false},
    {"segments", "/segments", true},
    {"refused_segments", "/refused_segments", true},
    {"path_ratio_median", "/path_ratio/median", true},
    {"path_ratio_worst", "/path_ratio/worst", true},
    {"swing_clearance_median_m", "/swing_clearance/median_m", true},
    {"swing_clearance_worst_m", "/swing_clearance/worst_m", true},
    {"interpolation_segments", "/segments_by_planner/interpolation/count", true},
    {"interpolation_time", "/segments_by_planner/interpolation/seconds", true},
    {"optimisation_segments", "/segments_by_planner/optimisation/count", true},
    {"optimisation_time", "/segments_by_planner/optimisation/seconds", true},
    {"rrt_connect_segments", "/segments_by_planner/rrt_connect/count", true},
    {"rrt_connect_time", "/segments_by_planner/rrt_connect/seconds", true},
    {"atlas_rrt_star_segments", "/segments_by_planner/atlas_rrt_star/count", true},
    {"atlas_rrt_star_time", "/segments_by_planner/atlas_rrt_star/seconds", true},
    {"carried_out", "/simulation/carried_out", true},
    {"reached_goal", "/simulation/reached_goal", true},
    {"upright", "/simulation/upright", true},
    {"max_base_error_m", "/simulation/max_base_error_m", true},
    {"max_contact_slip_m", "/simulation/max_contact_slip_m", true},
    {"max_torque_ratio", "/simulation/max_torque_ratio", true},
    {"controller_time", "/simulation/controller_time/mean", true},
    {"controller_p99_time", "/simulation/controller_time/p99", true},
    {"real_time_factor", "/simulation/real_time_factor", true},
}};

struct CampaignRun {
  unsigned seed = 0;
  bool solved = false;
  std::string reason;
  std::string planner;
  /// As kCampaignQuantities.
  std::array<std::optional<double>, kCampaignQuantities.size()> values = {};
};

/// plan: what `locograph plan --json` printed. planner: where that does not say it. Throws Error
/// when it lacks `success` or `reason`, or one of the quantities is no number.
CampaignRun campaign_run(const Json& plan, unsigned seed, const std::string& planner = "");

/// What all runs of a table have in common.
struct CampaignSetting {
  std::string scenario;
  std::string planner = {};  ///< as asked for; empty: whichever the runs tell
  std::string options = {};  ///< of `plan`, as on a command line
};

class CampaignTable {
 public:
  explicit CampaignTable(CampaignSetting setting) : setting_(std::move(setting)) {}

  /// Adds the runs in the file; one without a byte holds none. Throws Error with file and line when
  /// it is no such table, one of an older version, or one of another setting.
  void read(const std::filesystem::path& file);
  /// Throws Error when the planner is another than that of the runs before, or there is a run of
  /// this seed.
  void add(CampaignRun run);

  bool has(unsigned seed) const { return runs_.contains(seed); }
  /// By seed.
  const std::map<unsigned, CampaignRun>& runs() const { return runs_; }
  /// The runs' planner, or the one that was asked for where there are none.
  const std::string& planner() const;
  /// Ordered by seed.
  std::string csv() const;

 private:
  CampaignSetting setting_;
  std::map<unsigned, CampaignRun> runs_;
};

/// {mean, std, p50, p95, max} of a quantity over the solved ones of these runs that tell it; null
/// where there are too few. std: of a sample (n − 1). quantity: an index of kCampaignQuantities.
Json campaign_statistics(const std::vector<CampaignRun>& runs, std::size_t quantity);

}  // namespace locograph
