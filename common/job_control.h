#pragma once
/// When a long job has to end, and whom it tells how far it is.
///
///     JobControl job{.termination = {.deadline = Deadline::after(5.0)}};
///     job.report = [](std::string_view part, double fraction) { std::cerr << part << fraction; };
///     for (std::size_t i = 0; i < sums.size(); ++i) {
///       job.report_progress("adding up", i, sums.size());
///       if (job.termination.ended()) break;
///       sums[i] = sum(static_cast<int>(i));
///     }
///
/// The default never ends a job and tells nobody.

#include <locograph/common/termination.h>

#include <functional>
#include <string_view>

namespace locograph {

struct JobControl {
  Termination termination = {};
  /// part: of the job; fraction: of it that is done. May be empty.
  std::function<void(std::string_view part, double fraction)> report = {};

  void report_progress(std::string_view part, std::size_t done, std::size_t all) const {
    if (report) report(part, static_cast<double>(done) / static_cast<double>(all));
  }
};

}  // namespace locograph
