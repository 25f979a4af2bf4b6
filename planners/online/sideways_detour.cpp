#include <locograph/planners/offline/drive/wheel_motion.h>
#include <locograph/planners/online/heading.h>
#include <locograph/planners/online/sideways_detour.h>

#include <algorithm>

namespace locograph {
namespace {

class SidewaysDetour final : public Proposal {
 public:
  SidewaysDetour(const OnlinePlan& plan, const DetourOptions& options)
      : search_(plan.plan().robot, options) {}

  Answer search(const OnlinePlan& plan, const Window& window, const Termination& termination,
                std::vector<Eigen::VectorXd>& candidate) override {
    const std::vector<double> offsets = find_offsets(plan, window, termination);
    if (offsets.empty()) return Answer::kUnfinished;
    move_sideways(plan, window, offsets, candidate);
    roll_wheels(plan, window, candidate);
    return Answer::kFound;
  }

  void world_changed() override { search_.forget(); }

 private:
  std::vector<double> find_offsets(const OnlinePlan& plan, const Window& window,
                                   const Termination& termination) {
    std::vector<const double*> planned;
    std::vector<double> times;
    for (int i = window.first(); i < window.end(); ++i) {
      planned.push_back(plan.planned()[static_cast<std::size_t>(i)].data());
      times.push_back(plan.time_s(i));
    }
    const auto offset_of = [&](int i) {
      const Eigen::VectorXd& q = plan.planned()[static_cast<std::size_t>(i)];
      return (plan.configuration(i).head<3>() - q.head<3>()).dot(left_of(q.data()));
    };
    const int executed = window.executed();
    const double start = offset_of(executed);
    const double slope = executed > 0 ? start - offset_of(executed - 1) : 0.0;
    return search_.find(window.first(), planned, times, plan.world().distance(), start, slope,
                        termination);
  }

  static void move_sideways(const OnlinePlan& plan, const Window& window,
                            const std::vector<double>& offsets,
                            std::vector<Eigen::VectorXd>& candidate) {
    candidate.resize(offsets.size());
    for (std::size_t k = 0; k < candidate.size(); ++k) {
      const int i = window.first() + static_cast<int>(k);
      if (plan.is_fixed(i)) {
        candidate[k] = plan.configuration(i);
        continue;
      }
      const Eigen::VectorXd& planned = plan.planned()[static_cast<std::size_t>(i)];
      candidate[k] = planned;
      candidate[k].head<3>() += offsets[k] * left_of(planned.data());
    }
  }

  static void roll_wheels(const OnlinePlan& plan, const Window& window,
                          std::vector<Eigen::VectorXd>& candidate) {
    const auto executed = static_cast<std::size_t>(window.executed());
    WheelMotion wheels(plan.robot(), plan.plan().stance_from[executed]->stance);
    Eigen::VectorXd before = plan.configuration(window.executed());
    for (std::size_t k = 0; k < candidate.size(); ++k) {
      Eigen::VectorXd q = candidate[k];
      const Eigen::VectorXd& after = candidate[std::min(k + 1, candidate.size() - 1)];
      const Eigen::Vector3d way = (after - before).head<3>();
      if (way.norm() > 1e-3) {
        for (int w = 0; w < wheels.wheels(); ++w) wheels.steer(q, w, way);
      }
      wheels.roll(before, q);
      if (!plan.is_fixed(window.first() + static_cast<int>(k))) candidate[k] = q;
      before = candidate[k];
    }
  }

  DetourSearch search_;
};

}  // namespace

ProposalFactory sideways_detour(const DetourOptions& options) {
  return
      [options](const OnlinePlan& plan) { return std::make_unique<SidewaysDetour>(plan, options); };
}

}  // namespace locograph
