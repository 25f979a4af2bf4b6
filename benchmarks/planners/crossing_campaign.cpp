// A person walks across the way of the CENTAURO drive at 0.5 m/s, again and again: of the windows
// that the local planner calls feasible, how many does the judge refuse; of those that the judge
// accepts, how many does the planner call feasible.
//
//     crossing_campaign [CASES] [EVERY] [DEADLINE_MS]
//
// Every EVERY-th window is judged. Prints one JSON object: a row for each crossing, then the
// totals.
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
  int windows = 0, called = 0, judged = 0, agreed = 0, wrong = 0, arrived = 0;
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
                    {"steps", result.steps},
                    {"arrived", result.arrived}});
    std::cerr << rows.size() << " of " << cases << '\n';
    windows += result.windows;
    called += result.called_feasible;
    judged += result.judged_feasible;
    agreed += result.agreed_feasible;
    wrong += result.wrongly_feasible;
    arrived += result.arrived ? 1 : 0;
  }
  const nlohmann::ordered_json json = {
      {"crossings", cases},
      {"windows", windows},
      {"called_feasible", called},
      {"judged_feasible", judged},
      {"wrongly_feasible", wrong},
      {"accepted_called_feasible", judged > 0 ? 1.0 * agreed / judged : 1.0},
      {"arrived", arrived},
      {"rows", rows}};
  std::cout << json.dump(2) << '\n';
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  int cases = 24;
  double deadline_ms = 0.0;
  locograph::CrossingOptions options;
  locograph::OptionParser app("A person crosses the way of a drive", "crossing_campaign");
  app.add_option("CASES", cases, "How many crossings").positive();
  app.add_option("EVERY", options.every, "Judge every n-th window").positive();
  app.add_option("DEADLINE_MS", deadline_ms, "Of a cycle; 0: none").not_negative();
  return locograph::run_benchmark(app, argc, argv, [&] {
    options.cycle_deadline_s = 1e-3 * deadline_ms;
    locograph::run(cases, options);
  });
}
