#pragma once
/// Options that several commands have, said once. Variables must outlive the parsing.
///
///     add_scenario_argument(parser, o.scenario);
///     add_torque_limits_option(parser, o.torques, "report: only tell them");
///     add_execution_margin_option(parser, o.margin_factor, "0: none");
///     add_threads_option(parser, o.threads);

#include <locograph/apps/option_parser.h>

#include <string>

namespace locograph {

/// The positional argument SCENARIO.
inline void add_scenario_argument(OptionParser& parser, std::string& scenario) {
  parser.add_option("SCENARIO", scenario, "File, or a name that `locograph list scenarios` gives")
      .required();
}

/// `--torque-limits enforce|report`.
inline ParserOption add_torque_limits_option(OptionParser& parser, std::string& torques,
                                             const std::string& help) {
  return parser.add_option("--torque-limits", torques, help).one_of({"enforce", "report"});
}

/// `--execution-margin FACTOR`.
inline ParserOption add_execution_margin_option(OptionParser& parser, double& factor,
                                                const std::string& help) {
  return parser.add_option("--execution-margin", factor, help)
      .between(0.0, 1.0)
      .value_name("FACTOR")
      .show_default();
}

/// `--threads N`.
inline void add_threads_option(
    OptionParser& parser, int& threads,
    const std::string& what = "Most threads to use (this version uses one)") {
  parser.add_option("--threads", threads, what).positive().show_default();
}

}  // namespace locograph
