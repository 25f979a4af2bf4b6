// A person walks across the way of the CENTAURO drive at 0.5 m/s, again and again: how often does
// the robot arrive, waiting where it has to, and how long does it take; of the windows that the
// local planner calls feasible, how many does the judge refuse; of those that the judge accepts,
// how many does the planner call feasible.
//
//     crossing_campaign [CASES] [--every N] [--rate HZ] [--iterations N]
//
// The window of every N-th cycle is judged. Prints one JSON object: a row for each crossing, then
// the totals.
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "crossing_cases.h"

namespace locograph {
namespace {

void run(int cases, const CrossingOptions& options) {
  const Scenario scenario = load_scenario(
      LOCOGRAPH_SOURCE_DIR "/planners/scenarios/centauro_drive.xml", LOCOGRAPH_SOURCE_DIR);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  int windows = 0, called = 0, judged = 0, agreed = 0, wrong = 0, arrived = 0, stopped = 0;
  std::vector<double> times;
  for (const Crossing& crossing : crossings(cases)) {
    const CrossingResult result = run_crossing(scenario, crossing, options);
    rows.push_back({{"x_m", crossing.x_m},
                    {"delay_s", crossing.delay_s},
                    {"from_left", crossing.from_left},
                    {"windows", result.windows},
                    {"called_feasible", result.called_feasible},
                    {"judged_feasible", result.judged_feasible},
                    {"agreed_feasible", result.agreed_feasible},
                    {"wrongly_feasible", result.wrongly_feasible},
                    {"refused", result.refused},
                    {"arrived", result.arrived},
                    {"stopped_safely", result.stopped_safely},
                    {"waits", result.waits},
                    {"times_planned", result.times_planned},
                    {"reason", result.reason},
                    {"not_waited", result.not_waited}});
    std::cerr << rows.size() << " of " << cases << '\n';
    windows += result.windows;
    called += result.called_feasible;
    judged += result.judged_feasible;
    agreed += result.agreed_feasible;
    wrong += result.wrongly_feasible;
    arrived += result.arrived ? 1 : 0;
    stopped += result.stopped_safely ? 1 : 0;
    if (result.arrived) times.push_back(result.times_planned);
  }
  std::ranges::sort(times);
  const nlohmann::ordered_json json = {
      {"crossings", cases},
      {"windows", windows},
      {"called_feasible", called},
      {"judged_feasible", judged},
      {"wrongly_feasible", wrong},
      {"accepted_called_feasible", judged > 0 ? 1.0 * agreed / judged : 1.0},
      {"arrived", arrived},
      {"stopped_safely", stopped},
      {"times_planned",
       {{"median", times.empty() ? 0.0 : times[times.size() / 2]},
        {"most", times.empty() ? 0.0 : times.back()}}},
      {"rows", rows}};
  std::cout << json.dump(2) << '\n';
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  int cases = 24;
  locograph::CrossingOptions options;
  locograph::OptionParser app("A person crosses the way of a drive", "crossing_campaign");
  app.add_option("CASES", cases, "How many crossings").positive();
  app.add_option("--every", options.every, "Judge the window of every n-th cycle").positive();
  app.add_option("--rate", options.rate_hz, "Cycles in a second of the plan; 0: one a step")
      .not_negative();
  app.add_option("--iterations", options.cycle_iterations, "Of a cycle at most; 0: any number")
      .not_negative();
  return locograph::run_benchmark(app, argc, argv, [&] { locograph::run(cases, options); });
}
