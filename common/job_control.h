#pragma once
/// What a long job asks at every step: whether to go on. It also tells how far it is.
///
///     JobControl job{.deadline = Deadline::after(5.0)};
///     job.report = [](std::string_view what, double fraction) { std::cerr << what << fraction; };
///     for (std::size_t i = 0; i < sums.size(); ++i) {
///       if (!job.go_on("adding up", i, sums.size())) break;   // out of time
///       sums[i] = sum(static_cast<int>(i));
///     }
///
/// The default never ends a job and tells nobody.

#include <locograph/common/deadline.h>

#include <functional>
#include <string_view>

namespace locograph {

struct JobControl {
  Deadline deadline = {};
  /// what: the part of the job; fraction: of it that is done.
  std::function<void(std::string_view what, double fraction)> report = {};

  /// False: the job should end now.
  bool go_on(std::string_view what, std::size_t done, std::size_t all) const {
    if (report) report(what, static_cast<double>(done) / static_cast<double>(all));
    return !deadline.passed();
  }
};

}  // namespace locograph
