#include <locograph/common/check_option.h>
#include <locograph/planners/online/walk_ahead.h>

#include <algorithm>
#include <utility>

namespace locograph {
namespace {

bool is_same(const Motion& a, const Motion& b) {
  return a.time_s == b.time_s && a.configurations == b.configurations && a.slopes == b.slopes &&
         a.wrenches == b.wrenches;
}

}  // namespace

WalkAhead::WalkAhead(Graph& graph, WorldAt world_at, const WalkOptions& options, double lead_s)
    : walk_(graph, std::move(world_at), options), lead_s_(lead_s) {
  check_option(lead_s > 0.0, "lead_s", "above 0");
  motion_ = walk_.motion();
}

std::optional<Motion> WalkAhead::at(double plan_time_s) {
  const auto& times_s = motion_.time_s;
  const auto carried_out = static_cast<int>(std::min<std::ptrdiff_t>(
      std::ranges::lower_bound(times_s, plan_time_s) - times_s.begin(), std::ssize(times_s) - 1));
  bool stepped = false;
  const auto is_far_ahead = [&](int executed) {
    return executed >= carried_out + kLeadSteps && walk_.time_s(executed) >= plan_time_s + lead_s_;
  };
  while (!over_ && !is_far_ahead(walk_.executed())) {
    over_ = !walk_.step(carried_out);
    stepped = true;
  }
  if (!stepped) return std::nullopt;
  Motion now = walk_.motion();
  if (is_same(now, motion_)) return std::nullopt;
  motion_ = std::move(now);
  return motion_;
}

}  // namespace locograph
