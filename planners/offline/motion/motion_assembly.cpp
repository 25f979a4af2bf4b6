#include <locograph/planners/balance/least_wrenches.h>
#include <locograph/planners/offline/motion/motion_assembly.h>

#include <algorithm>
#include <utility>

namespace locograph {
namespace {

/// Whether the stance after segment j has one contact more than its own.
bool gains(const StancePath& path, std::size_t j) {
  return contacts_of(path.footings[j + 1]) > contacts_of(path.footings[j]);
}

/// The wrenches of one footing at the contacts of another: none where it has no contact.
StanceWrenches carried(const StanceWrenches& wrenches, const Footing& of, const Footing& to) {
  StanceWrenches result;
  std::size_t at = 0;
  for (std::size_t e = 0; e < of.size(); ++e) {
    if (to[e] != kFree) result.push_back(StanceWrenches::value_type::Zero());
    if (to[e] != kFree && of[e] != kFree) result.back() = wrenches[at];
    if (of[e] != kFree) ++at;
  }
  return result;
}

SegmentRecord record_of(const SegmentMotion& way) {
  SegmentRecord record;
  record.duration_s = way.duration_s;
  record.planner = way.planner;
  record.path_s = way.statistics.path_s;
  record.timing_s = way.statistics.timing_s;
  record.length = way.length;
  record.straight = way.straight;
  record.clear_m = way.clear_m;
  return record;
}

}  // namespace

MotionAssembly::MotionAssembly(StanceSpace& space)
    : space_(space),
      task_(space.task()),
      state_(*task_.robot->robot),
      loads_(*task_.robot->robot) {}

double MotionAssembly::effort_scale(const ExecutionMargin& margin) const {
  return task_.check.enforce_torque_limits ? task_.check.effort_scale * margin.torque : 0.0;
}

void MotionAssembly::assemble(const StancePath& path,
                              std::span<const LoadedSegment* const> segments, Motion& motion,
                              std::vector<SegmentRecord>& records) {
  motion = {};
  motion_ = &motion;
  records.clear();
  time_s_ = 0.0;
  std::size_t done = 0;
  while (done < segments.size() && segments[done]->motion.success() &&
         !(bears_on() && segments[done]->wrenches.empty())) {
    ++done;
  }
  StanceWrenches at_end;
  if (bears_on()) at_end = at_rest(path.footings[done], path.configurations[done]);
  const auto begin_record = [&](std::size_t stance, SegmentRecord record) {
    record.stance = static_cast<int>(stance);
    record.first = static_cast<int>(motion.configurations.size());
    return record;
  };
  const auto end_record = [&](SegmentRecord& record) {
    record.last = static_cast<int>(motion.configurations.size());
    records.push_back(std::move(record));
  };
  // What is borne when the segment before ends, at the contacts of the one that begins.
  const auto borne_before = [&](std::size_t j) {
    return carried(segments[j - 1]->wrenches.back(), path.footings[j - 1], path.footings[j]);
  };
  for (std::size_t j = 0; j < done; ++j) {
    const SegmentMotion& way = segments[j]->motion;
    const std::vector<StanceWrenches>& wrenches = segments[j]->wrenches;
    SegmentRecord record = begin_record(j, record_of(way));
    if (bears_on() && j > 0 && gains(path, j - 1)) {
      dwell(way.configurations.front(), borne_before(j), wrenches.front(), record);
    }
    const std::size_t steps = way.configurations.size() - 1;
    for (std::size_t i = 0; i < steps; ++i) {
      append(record.stance, way.configurations[i], way.slopes[i]);
      if (bears_on()) motion.wrenches.push_back(wrenches[i]);
      motion.time_s.push_back(time_s_ +
                              way.duration_s * static_cast<double>(i) / static_cast<double>(steps));
    }
    time_s_ += way.duration_s;
    if (bears_on() && !gains(path, j)) {
      const StanceWrenches& next = j + 1 < done ? segments[j + 1]->wrenches.front() : at_end;
      dwell(way.configurations.back(), wrenches.back(),
            carried(next, path.footings[j + 1], path.footings[j]), record);
    }
    end_record(record);
  }
  for (std::size_t j = 0; j <= done; ++j) {
    motion.stances.push_back(space_.stance(path.footings[j]));
  }
  if (bears_on() && done > 0) {
    SegmentRecord record = begin_record(done, {});
    record.planner = kDwell;
    dwell(path.configurations[done], gains(path, done - 1) ? borne_before(done) : at_end, at_end,
          record);
    end_record(record);
  }
  append(static_cast<int>(done), path.configurations[done],
         Eigen::VectorXd::Zero(task_.robot->robot->tangent_size()));
  motion.time_s.push_back(time_s_);
  if (bears_on()) motion.wrenches.push_back(std::move(at_end));
}

void MotionAssembly::append(int stance, const Eigen::VectorXd& q, Eigen::VectorXd slope) {
  motion_->configurations.push_back(q);
  motion_->slopes.push_back(std::move(slope));
  motion_->stance_from.push_back(stance);
}

/// Stands while forces go over, for as long as the margin says, or longer where they need it.
void MotionAssembly::dwell(const Eigen::VectorXd& q, const StanceWrenches& from,
                           const StanceWrenches& to, SegmentRecord& record) {
  const double duration_s = loads_.append({.configuration = q,
                                           .stance = record.stance,
                                           .from = from,
                                           .to = to,
                                           .begin_s = time_s_,
                                           .least_s = task_.margin.dwell_s},
                                          *motion_);
  time_s_ += duration_s;
  record.duration_s += duration_s;
}

StanceWrenches MotionAssembly::at_rest(const Footing& footing, const Eigen::VectorXd& q) {
  const std::vector<BearingContact> bearing = space_.bearing_contacts(footing);
  state_.update(q.data());
  return wrenches_at_rest(state_, bearing, task_.margin, effort_scale({.torque = 1.0}))
      .value_or(StanceWrenches(bearing.size(), StanceWrenches::value_type::Zero()));
}

}  // namespace locograph
