#pragma once
/// Whether an edge fits the robot of its vertices: as many rows, and the same robot throughout. And
/// whether its margin is one.
///
///     const auto rows_of = [](const RobotParameter& p) { return p.robot->active_joint_count(); };
///     require_fitting_robot(parameters, kTag, dimension, rows_of);     // in bind(parameters)
///     require_rows(kTag, e.size(), q.model().active_joint_count());    // in error(q, e)
///
/// bind() sees the parameters but no vertices: it refuses an edge that fits none of the graph's
/// robots. What several robots leave open is settled where the edge is evaluated, before anything
/// is read or written out of bounds. All throw Error.

#include <locograph/common/ranges.h>
#include <locograph/core/parameters.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

#include <string_view>

namespace locograph {

namespace detail {
[[noreturn]] void refuse_rows(std::string_view tag, long rows, const std::string& expected);
[[noreturn]] void refuse_robot(std::string_view tag);
}  // namespace detail

inline void require_rows(std::string_view tag, long rows, long expected) {
  if (rows != expected) detail::refuse_rows(tag, rows, std::to_string(expected));
}

inline void require_same_robot(std::string_view tag, const std::shared_ptr<const RobotParameter>& a,
                               const std::shared_ptr<const RobotParameter>& b) {
  if (a != b) detail::refuse_robot(tag);
}

/// Metres or radians, from `least` to ranges::kCoordinate_m.
void require_margin(std::string_view tag, double margin, double least = 0.0);

/// rows_of(const RobotParameter&): the rows that an edge on this robot has. A graph without a
/// PARAMS_ROBOT says nothing.
template <class RowsOf>
void require_fitting_robot(const Parameters& parameters, std::string_view tag, long rows,
                           RowsOf rows_of) {
  std::string expected;
  for (const int number : parameters.numbers_of<RobotParameter>()) {
    const long wanted = rows_of(*parameters.get<RobotParameter>(number));
    if (wanted == rows) return;
    expected += (expected.empty() ? "" : " or ") + std::to_string(wanted);
  }
  if (!expected.empty()) detail::refuse_rows(tag, rows, expected);
}

}  // namespace locograph
