#include <locograph/common/check_option.h>
#include <locograph/planners/offline/stance/stance_plan.h>

namespace locograph {

void StancePlannerOptions::validate() const {
  check_option(grid_m >= 1e-3 && grid_m <= 10.0, "grid_m", "0.001 to 10 m");
  check_option(reach > 0.0 && reach <= 2.0, "reach", "above 0, up to 2");
  check_option(threads >= 1, "threads", "1 or more");
  termination.validate();
  check_option(max_transitions >= 0, "max_transitions", "0 or more");
}

Motion stances_motion(std::vector<Stance> stances, std::vector<Eigen::VectorXd> configurations) {
  Motion motion;
  motion.stances_only = true;
  motion.stances = std::move(stances);
  motion.configurations = std::move(configurations);
  for (std::size_t i = 0; i < motion.configurations.size(); ++i) {
    motion.time_s.push_back(static_cast<double>(i));
    motion.stance_from.push_back(static_cast<int>(i));
  }
  return motion;
}

Motion stances_motion(const StancePlan& plan) {
  return stances_motion(plan.stances, plan.configurations);
}

}  // namespace locograph
