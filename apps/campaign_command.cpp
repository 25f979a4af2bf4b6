#include <locograph/apps/campaign_command.h>
#include <locograph/apps/campaign_table.h>
#include <locograph/apps/child_process.h>
#include <locograph/apps/common_options.h>
#include <locograph/apps/output.h>
#include <locograph/apps/progress.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/common/stop_signals.h>
#include <locograph/planners/offline/motion/segment_planners.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/plugins/configuration/plan_parameters.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace locograph {
namespace {

/// Stays the program that was started, also when its file is replaced during a long campaign.
constexpr char kThisProgram[] = "/proc/self/exe";

struct CampaignOptions {
  std::string scenario, planner, torques, csv;
  std::vector<std::string> segment_planners;
  int runs = 0;
  unsigned seed = 0;
  bool stances_only = false, simulate = false;
  double timeout_s = 0.0, move_contacts_m = 0.0, margin_factor = 1.0;
  int threads = 0;  ///< 0: an even share of the cores for each process
  int processes = 1;
  bool json = false;

  /// Of `plan`, those that were given; --planner is apart.
  std::vector<std::string> passed_on() const {
    std::vector<std::string> words;
    if (stances_only) words.emplace_back("--stances-only");
    for (const std::string& name : segment_planners) {
      words.insert(words.end(), {"--segment-planner", name});
    }
    if (!torques.empty()) words.insert(words.end(), {"--torque-limits", torques});
    if (timeout_s > 0.0) words.insert(words.end(), {"--timeout", Json(timeout_s).dump()});
    if (margin_factor != 1.0) {
      words.insert(words.end(), {"--execution-margin", Json(margin_factor).dump()});
    }
    if (move_contacts_m > 0.0) {
      words.insert(words.end(), {"--move-contacts", Json(move_contacts_m).dump()});
    }
    if (threads > 0) words.insert(words.end(), {"--threads", std::to_string(threads)});
    return words;
  }
  /// All that tells this campaign from others.
  std::vector<std::string> all() const {
    std::vector<std::string> words = passed_on();
    if (simulate) words.emplace_back("--simulate");
    return words;
  }
};

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// One seed that is being planned, and then carried out where that is asked for.
class PlanProcess {
 public:
  PlanProcess(const CampaignOptions& options, unsigned seed, const std::filesystem::path& folder)
      : seed_(seed),
        asked_planner_(options.planner),
        plan_(folder / ("plan_" + std::to_string(seed) + ".g2o")),
        output_(folder / ("output_" + std::to_string(seed))),
        errors_(folder / ("errors_" + std::to_string(seed))),
        simulated_(folder / ("simulated_" + std::to_string(seed))),
        simulate_(options.simulate),
        child_(std::make_unique<ChildProcess>(kThisProgram, arguments(options), output_, errors_)) {
  }
  PlanProcess(const PlanProcess&) = delete;
  PlanProcess& operator=(const PlanProcess&) = delete;
  ~PlanProcess() {
    child_->end();
    std::error_code ignored;
    for (const auto& file : {plan_, output_, errors_, simulated_}) {
      std::filesystem::remove(file, ignored);
    }
  }

  /// Nothing while it plans. Throws Error with what the process said when it did not get to an
  /// answer.
  std::optional<CampaignRun> result() {
    const std::optional<int> code = child_->exit_code();
    if (!code) return std::nullopt;
    if (*code != kDone && *code != kNo) fail(*code);
    if (!plan_code_) {
      plan_code_ = code;
      answer_ = Json::parse(read_file(output_), nullptr, false);
      if (!answer_.is_object()) fail(*code);
      if (simulate_ && *code == kDone) {
        const std::vector<std::string> words = {"simulate", plan_.string(), "--json",
                                                "--quiet",  "--seed",       std::to_string(seed_)};
        child_ = std::make_unique<ChildProcess>(kThisProgram, words, simulated_, errors_);
        return std::nullopt;
      }
    } else {
      answer_["simulation"] = Json::parse(read_file(simulated_), nullptr, false);
      if (!answer_["simulation"].is_object()) fail(*code);
    }
    CampaignRun run = campaign_run(answer_, seed_, asked_planner_);
    if (run.solved != (*plan_code_ == kDone)) fail(*plan_code_);
    return run;
  }

 private:
  std::vector<std::string> arguments(const CampaignOptions& options) const {
    std::vector<std::string> words = {"plan",   options.scenario, "--seed", std::to_string(seed_),
                                      "--json", "--quiet",        "-o",     plan_.string()};
    if (!options.planner.empty()) words.insert(words.end(), {"--planner", options.planner});
    const std::vector<std::string> others = options.passed_on();
    words.insert(words.end(), others.begin(), others.end());
    // Runs at the same time share the cores.
    if (options.threads == 0 && options.processes > 1) {
      const int cores = static_cast<int>(std::thread::hardware_concurrency());
      words.insert(words.end(),
                   {"--threads", std::to_string(std::max(1, cores / options.processes))});
    }
    return words;
  }

  [[noreturn]] void fail(int code) const {
    constexpr std::string_view kOurName = "locograph: ";
    std::string said = ProcessResult{.exit_code = code, .output = read_file(errors_)}.last_line();
    if (said.starts_with(kOurName)) said.erase(0, kOurName.size());
    if (code == kBadInput && !said.empty()) throw Error(said);
    std::string what =
        "the run with seed " + std::to_string(seed_) + " ended with " +
        (code > 128 ? "signal " + std::to_string(code - 128) : "exit code " + std::to_string(code));
    if (!said.empty()) what += " (" + said + ')';
    throw Error(what, "a plan, or that there is none");
  }

  unsigned seed_;
  std::string asked_planner_;
  std::filesystem::path plan_, output_, errors_, simulated_;
  bool simulate_;
  std::optional<int> plan_code_;
  Json answer_;  ///< of `plan`
  std::unique_ptr<ChildProcess> child_;
};

/// Runs the seeds that the table does not have, and saves it after each. Ends early when it is
/// asked to stop.
void run_seeds(const CampaignOptions& options, const std::vector<unsigned>& seeds,
               CampaignTable& table) {
  std::vector<unsigned> waiting;
  std::copy_if(seeds.rbegin(), seeds.rend(), std::back_inserter(waiting),
               [&table](unsigned seed) { return !table.has(seed); });
  const std::size_t all = waiting.size();
  std::size_t done = 0, solved = 0;
  const ScratchFolder folder;
  std::vector<std::unique_ptr<PlanProcess>> running;
  Progress progress("planning " + options.scenario);
  while (done < all && !stop_requested()) {
    while (!waiting.empty() && running.size() < static_cast<std::size_t>(options.processes)) {
      running.push_back(std::make_unique<PlanProcess>(options, waiting.back(), folder.path()));
      waiting.pop_back();
    }
    std::erase_if(running, [&](const std::unique_ptr<PlanProcess>& process) {
      std::optional<CampaignRun> run = process->result();
      if (!run) return false;
      ++done;
      solved += run->solved ? 1 : 0;
      table.add(std::move(*run));
      if (!options.csv.empty()) write_file_atomically(options.csv, table.csv());
      return true;
    });
    progress.show(static_cast<double>(done) / static_cast<double>(all), [&] {
      return std::to_string(done) + " of " + counted(static_cast<long>(all), "run", "runs") +
             " done, " + std::to_string(solved) + " solved";
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

/// Why there was no plan, the most frequent reason first.
std::vector<std::pair<std::string, int>> reasons_of(const std::vector<CampaignRun>& runs) {
  std::map<std::string, int> counts;
  for (const CampaignRun& run : runs) {
    if (!run.solved) ++counts[run.reason];
  }
  std::vector<std::pair<std::string, int>> reasons(counts.begin(), counts.end());
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return reasons;
}

Json report_json(const CampaignOptions& options, const std::string& scenario,
                 const std::string& planner, const std::vector<CampaignRun>& runs) {
  const auto solved = std::ranges::count_if(runs, &CampaignRun::solved);
  Json json = {
      {"scenario", scenario},
      {"planner", planner},
      {"seed", options.seed},
      {"runs", runs.size()},
      {"solved", solved},
      {"success_rate", runs.empty()
                           ? Json(nullptr)
                           : Json(static_cast<double>(solved) / static_cast<double>(runs.size()))},
      {"interrupted", runs.size() < static_cast<std::size_t>(options.runs)},
  };
  for (std::size_t q = 0; q < kCampaignQuantities.size(); ++q) {
    const CampaignQuantity& quantity = kCampaignQuantities[q];
    if (options.stances_only && quantity.whole_plans_only) continue;
    json[quantity.name] = campaign_statistics(runs, q);
  }
  if (!options.stances_only) json["total_time"] = json["planning_time"];
  Json unsolved = Json::array();
  for (const auto& [reason, count] : reasons_of(runs)) {
    unsolved.push_back({{"reason", reason}, {"count", count}});
  }
  json["unsolved"] = std::move(unsolved);
  return json;
}

std::string in_columns(const std::string& first, const std::vector<std::string>& others) {
  constexpr std::size_t kFirst = 24, kOther = 13;
  std::string line = first + std::string(kFirst - std::min(kFirst, first.size()), ' ');
  for (const std::string& text : others) {
    line += std::string(kOther - std::min(kOther, text.size()), ' ') + text;
  }
  return line + '\n';
}

/// "planning_time [s]"
std::string label(const std::string& name) {
  if (name.ends_with("_time")) return name + " [s]";
  return name.ends_with("_s") ? name.substr(0, name.size() - 2) + " [s]" : name;
}

std::string report_text(const CampaignOptions& options, const std::string& scenario,
                        const Json& json) {
  constexpr std::size_t kMostReasons = 5;
  const long runs = json["runs"].get<long>(), solved = json["solved"].get<long>();
  std::string text =
      scenario + ": solved " + std::to_string(solved) + " of " + counted(runs, "run", "runs");
  if (runs > 0) {
    text +=
        " (" + short_number(std::round(1000.0 * json["success_rate"].get<double>()) / 10.0) + " %)";
  }
  if (json["interrupted"].get<bool>()) {
    text += ", interrupted before " + std::to_string(options.runs);
  }
  text += '\n';
  if (solved > 0) {
    const std::vector<std::string> names = {"mean", "std", "p50", "p95", "max"};
    text += in_columns("", names);
    for (const CampaignQuantity& quantity : kCampaignQuantities) {
      if (!json.contains(quantity.name) || json[quantity.name]["mean"].is_null()) continue;
      std::vector<std::string> figures;
      for (const std::string& name : names) {
        const Json& figure = json[quantity.name][name];
        figures.push_back(figure.is_null() ? "-" : short_number(figure.get<double>()));
      }
      text += in_columns(label(quantity.name), figures);
    }
  }
  const Json& unsolved = json["unsolved"];
  for (std::size_t i = 0; i < std::min(unsolved.size(), kMostReasons); ++i) {
    text += "not solved: " + counted(unsolved[i]["count"].get<long>(), "run", "runs") + ": " +
            unsolved[i]["reason"].get<std::string>() + '\n';
  }
  if (unsolved.size() > kMostReasons) {
    text += "not solved: " + std::to_string(unsolved.size() - kMostReasons) +
            " more reasons (see --json)\n";
  }
  if (!options.csv.empty() && runs > 0) text += "written: " + options.csv + '\n';
  return text;
}

std::vector<unsigned> seeds_of(const CampaignOptions& options) {
  constexpr unsigned kLargest = std::numeric_limits<unsigned>::max();
  if (static_cast<unsigned>(options.runs) - 1 > kLargest - options.seed) {
    throw Error(
        counted(options.runs, "run", "runs") + " from seed " + std::to_string(options.seed) + " on",
        "seeds up to " + std::to_string(kLargest));
  }
  std::vector<unsigned> seeds;
  for (int i = 0; i < options.runs; ++i) seeds.push_back(options.seed + static_cast<unsigned>(i));
  return seeds;
}

CampaignTable table_of(const CampaignOptions& options, const Scenario& scenario) {
  CampaignTable table({scenario.source, options.planner, joined(options.all())});
  if (options.csv.empty()) return table;
  if (is_standard_output(options.csv)) {
    throw Error(options.csv, 0, "standard output as a table that grows", "a file");
  }
  check_output(options.csv, files_of(scenario));
  if (std::filesystem::exists(options.csv)) table.read(options.csv);
  return table;
}

ExitCode run_campaign(const CampaignOptions& options) {
  if (options.scenario == "-") {
    throw Error("standard input", 0, "can be read by one run only",
                "a scenario file, or a name that `locograph list scenarios` gives");
  }
  if (options.simulate && options.stances_only) {
    throw Error("--simulate with --stances-only", "whole plans, which have a motion");
  }
  const std::vector<unsigned> seeds = seeds_of(options);
  // Where it is wrong that is said before anything runs.
  const Scenario loaded = load_scenario(options.scenario, data_folder());
  const std::string& scenario = loaded.source;
  CampaignTable table = table_of(options, loaded);
  const FinishOnSignal finish;
  run_seeds(options, seeds, table);
  std::vector<CampaignRun> runs;
  for (const unsigned seed : seeds) {
    if (table.has(seed)) runs.push_back(table.runs().at(seed));
  }
  const Json json = report_json(options, scenario, table.planner(), runs);
  if (options.json) {
    print_result(json, true);
  } else {
    print_text(report_text(options, scenario, json));
  }
  return runs.size() == seeds.size() ? kDone : kNo;
}

}  // namespace

Command add_campaign(OptionParser& app) {
  const auto options = std::make_shared<CampaignOptions>();
  CampaignOptions& o = *options;
  OptionParser parser = app.add_subcommand(
      "campaign", "Plan a scenario with many seeds; how often and how fast there is a plan");
  add_scenario_argument(parser, o.scenario);
  parser.add_option("--runs", o.runs, "How many seeds").required().positive();
  parser.add_option("--seed", o.seed, "The first seed; the others follow one by one")
      .show_default();
  parser.add_option("--planner", o.planner, "As for plan");
  parser.add_flag("--stances-only", o.stances_only, "As for plan: no motion between stances");
  parser.add_flag("--simulate", o.simulate,
                  "Carry each plan out, as simulate does; the seed is that of the plan");
  parser.add_option("--segment-planner", o.segment_planners, "As for plan")
      .one_of(segment_planner_names())
      .value_name("NAME")
      .one_at_a_time();
  add_torque_limits_option(parser, o.torques, "As for plan");
  add_execution_margin_option(parser, o.margin_factor, "As for plan");
  parser.add_option("--timeout", o.timeout_s, "Seconds that each run may take; 0: no limit")
      .not_negative();
  parser
      .add_option("--move-contacts", o.move_contacts_m,
                  "As for plan: each run moves the contacts of start and goals by its seed [m]")
      .between(0.0, ContactMoves::kFurthest_m)
      .show_default();
  parser
      .add_option("--threads", o.threads,
                  "Most threads of each run (without it, an even share of the cores)")
      .positive();
  parser
      .add_option("--processes", o.processes,
                  "How many runs at a time; more than one, and they take time from each other")
      .positive()
      .show_default();
  parser.add_option("--csv", o.csv,
                    "Table to write after each run (.csv); seeds that it has are not run again");
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [options] { return run_campaign(*options); }};
}

}  // namespace locograph
