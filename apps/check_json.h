#pragma once
/// What the judge says, as JSON and as text: once for all commands.
///
///     Json json = check_json(report, [&](int vertex) { return id_of(file, vertex); });
///     std::string lines = check_text(report, ids);

#include <locograph/apps/output.h>
#include <locograph/check/check_report.h>

#include <functional>
#include <string>

namespace locograph {

/// The id in the file of a vertex of the motion.
using VertexIds = std::function<int(int vertex)>;

/// One constraint; `worst` is null, and `why` says why, where it was not judged.
Json violation_json(const Violation& violation);
/// Every constraint, with the vertex, the time and the place where it is worst.
Json violations_json(const CheckReport& report, const VertexIds& ids);
/// All of a report: `feasible`, `violations`, the extreme values, whether it begins at the `start`
/// and how many `goals` are reached, `trusted`.
Json check_json(const CheckReport& report, const VertexIds& ids);

/// What matters first: a line for each constraint that is violated, the worst first, then what was
/// not judged and why, then the number of those that hold, then the extreme values, and what was
/// taken on trust. all: a line for each that holds.
std::string check_text(const CheckReport& report, const VertexIds& ids, bool all = false);

/// The number, null where there is none or it is not finite.
Json number_json(double value);
Json number_json(const std::optional<double>& value);

}  // namespace locograph
