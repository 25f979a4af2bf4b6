#include <locograph/planners/online/heading.h>
#include <locograph/planners/online/plan_wheels.h>
#include <locograph/planners/online/sideways_detour.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

class SidewaysDetour final : public Proposal {
 public:
  SidewaysDetour(const OnlinePlan& plan, const DetourOptions& options)
      : search_(plan.plan().robot, options), turns_(options.most_yaw > 0) {}

  Answer search(const OnlinePlan& plan, const Window& window, const Termination& termination,
                std::vector<Eigen::VectorXd>& candidate) override {
    for (int i = window.executed(); i < window.last(); ++i) {
      if (!plan.rolls(i)) return Answer::kNone;
    }
    Detour start = detour_of(plan, window.executed());
    if (!turns_) start.yaw_rad = 0.0;
    const std::vector<Detour>& detours = find_detours(plan, window, start, termination);
    if (detours.empty()) return Answer::kUnfinished;
    move(plan, window, detours, candidate);
    roll_wheels(plan, window, start, detours, candidate);
    return Answer::kFound;
  }

  void world_changed() override { search_.forget(); }

 private:
  /// Where a configuration is, beside its place in the plan.
  static Detour detour_of(const OnlinePlan& plan, int i) {
    const Eigen::VectorXd& planned = plan.planned()[static_cast<std::size_t>(i)];
    const Eigen::Map<const Eigen::VectorXd> now = plan.configuration(i);
    return {(now.head<3>() - planned.head<3>()).dot(left_of(planned.data())),
            turn_between(planned.data(), now.data())};
  }

  const std::vector<Detour>& find_detours(const OnlinePlan& plan, const Window& window,
                                          const Detour& start, const Termination& termination) {
    planned_.clear();
    times_.clear();
    for (int i = window.first(); i < window.end(); ++i) {
      planned_.push_back(plan.planned()[static_cast<std::size_t>(i)].data());
      times_.push_back(plan.time_s(i));
    }
    const int executed = window.executed();
    const double slope =
        executed > 0 ? start.offset_m - detour_of(plan, executed - 1).offset_m : 0.0;
    return search_.find(window.first(), planned_, times_, plan.world().distance(), start, slope,
                        termination);
  }

  static void move(const OnlinePlan& plan, const Window& window, const std::vector<Detour>& detours,
                   std::vector<Eigen::VectorXd>& candidate) {
    candidate.resize(detours.size());
    for (std::size_t k = 0; k < candidate.size(); ++k) {
      const int i = window.first() + static_cast<int>(k);
      if (plan.is_fixed(i)) {
        candidate[k] = plan.configuration(i);
        continue;
      }
      const Eigen::VectorXd& planned = plan.planned()[static_cast<std::size_t>(i)];
      candidate[k] = planned;
      turn_base(detours[k].yaw_rad, candidate[k].data());
      candidate[k].head<3>() += detours[k].offset_m * left_of(planned.data());
    }
  }

  void roll_wheels(const OnlinePlan& plan, const Window& window, const Detour& start,
                   const std::vector<Detour>& detours, std::vector<Eigen::VectorXd>& candidate) {
    WheelMotion& wheels = wheels_.at(plan, window.executed());
    before_ = plan.configuration(window.executed());
    double yaw_before = start.yaw_rad;
    for (std::size_t k = 0; k < candidate.size(); ++k) {
      here_ = candidate[k];
      const std::size_t next = std::min(k + 1, candidate.size() - 1);
      const Eigen::Vector3d way = (candidate[next] - before_).head<3>();
      const double turn = detours[next].yaw_rad - yaw_before;
      wheels.drive(before_, way, turn, here_);
      if (!plan.is_fixed(window.first() + static_cast<int>(k))) candidate[k] = here_;
      before_ = candidate[k];
      yaw_before = detours[k].yaw_rad;
    }
  }

  DetourSearch search_;
  bool turns_;
  PlanWheels wheels_;
  std::vector<const double*> planned_;
  std::vector<double> times_;
  Eigen::VectorXd before_, here_;
};

}  // namespace

ProposalFactory sideways_detour(const DetourOptions& options) {
  return
      [options](const OnlinePlan& plan) { return std::make_unique<SidewaysDetour>(plan, options); };
}

}  // namespace locograph
