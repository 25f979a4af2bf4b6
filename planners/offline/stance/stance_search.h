#pragma once
/// A search for ways through stances that hands out one candidate after the other: each leads to
/// the next goal, is shortened, and the judge takes it. Whoever asks takes it, or says which of its
/// changes will not do.
///
///     const std::unique_ptr<StanceSearch> search = planner->begin(task, options);
///     while (search->next()) {
///       const std::size_t bad = change_without_motion(search->space(), search->candidate());
///       if (bad == 0) {
///         search->take();
///       } else {
///         search->refuse(bad, "no motion for one of its stances");
///       }
///     }
///     const StancePlan plan = search->result();
///
/// Between two candidates the search stands still, but for transitions that other threads work out
/// ahead. The sequence of candidates depends on the task, the options and the answers alone.

#include <locograph/check/judge.h>
#include <locograph/common/deadline.h>
#include <locograph/planners/offline/stance/stance_path.h>
#include <locograph/planners/task/task.h>

#include <string>
#include <vector>

namespace locograph {

class StanceSearch {
 public:
  StanceSearch(const StanceSearch&) = delete;
  StanceSearch& operator=(const StanceSearch&) = delete;
  virtual ~StanceSearch() = default;

  /// Goes on to the next candidate; false: all goals are reached, or one is not.
  bool next();
  /// From the start on, the ways to the goals before included.
  const StancePath& candidate() const { return candidate_; }
  /// The candidate will do: the next one leads to the goal after its own.
  void take();
  /// Change number `change` of the candidate, 1 or more, will not do: no later candidate has it.
  /// The reason is told if none is taken.
  void refuse(std::size_t change, const std::string& reason);
  /// Other configurations for the candidate's changes, as good as its own; those of changes that
  /// are taken stay.
  void replace(std::vector<Eigen::VectorXd> configurations);

  /// What is taken so far: the start, and the way to the goals that are reached.
  const StancePath& taken() const { return taken_; }
  StanceSpace& space() { return space_; }
  /// The plan as far as candidates were taken, once next() has no other; else why it has not.
  StancePlan result();

 protected:
  StanceSearch(const Task& task, const StancePlannerOptions& options);
  /// Keeps in the result the footing that has most of the goal's contacts: to be called for each
  /// one that the search comes to.
  void note_best(const Footing& footing, const Footing& goal);

 private:
  /// Appends a way from the path's last footing to the goal; false: not found.
  virtual bool reach(const Footing& goal, StancePath& path) = 0;
  void begin_goal();
  void count_refused(const std::string& reason);
  /// Why the goal after those that are reached is not.
  void explain(StancePlan& plan);

  const Task& task_;
  const StancePlannerOptions options_;
  const Stopwatch watch_;

 protected:
  StanceSpace space_;
  StancePlan result_;  ///< the search keeps its counts in it

 private:
  Judge judge_;
  StancePath taken_, candidate_;
  Footing next_goal_;           ///< that candidates lead to
  std::size_t first_node_ = 0;  ///< of the result's tree, for this goal
  int refused_ = 0;             ///< candidates for this goal, the judge's refusals included
  std::string last_refusal_;
  bool over_ = false;
};

}  // namespace locograph
